#include "report/document/quantity.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace doc = rigcal::report::doc;

namespace {
const std::optional<double> kMissing;
const std::optional<rigcal::Range> kNoInterval;
}  // namespace

TEST_CASE("quantity: what is missing is a dash without a value", "[report]") {
  for (const doc::Quantity& quantity :
       {doc::in_unit(kMissing, 1.0), doc::in_unit(std::nan(""), 1.0), doc::agreement(kMissing),
        doc::readable(std::nan(""), "m"), doc::decimals(kMissing, 2),
        doc::score("rho2", kMissing)}) {
    CHECK(quantity.text == "–");
    CHECK_FALSE(quantity.exact);
  }
  CHECK_FALSE(doc::estimate(kMissing, kNoInterval, 1.0).has_interval);
}

TEST_CASE("quantity: the digits are those that the number deserves", "[report]") {
  CHECK(doc::in_unit(6.2e6, 1e6).text == "6.2");
  CHECK(doc::in_unit(6.2e6, 1e6).exact == 6.2e6);
  const doc::Quantity length = doc::readable(0.0508, "m", 4);
  CHECK((length.text == "50.8" && length.unit == "mm"));
  CHECK(doc::agreement(0.99999999).text == "> 0.9999");
  CHECK(doc::score("rho2", 0.99987).text == "0.99987");
  CHECK(doc::score("absolute_error_percent", 1.23456).text == "1.235");
  CHECK(doc::decimals(-0.001, 2).text == "0.00");
}

TEST_CASE("quantity: an estimate is shown in the digits of its interval", "[report]") {
  const doc::Estimate mass = doc::estimate(85.0114, rigcal::Range{84.96, 85.06}, 1.0);
  CHECK(mass.value.text == "85.011");
  CHECK(mass.has_interval);
  CHECK(mass.interval().size() == 3);
  const doc::Estimate lonely = doc::estimate(85.0114, kNoInterval, 1.0);
  CHECK_FALSE(lonely.has_interval);
  CHECK(lonely.interval().size() == 1);
}
