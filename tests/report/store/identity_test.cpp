#include "report/store/identity.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using report::identity_json;

namespace {

datasets::Campaign dated(const std::vector<std::string>& dates) {
  datasets::Campaign campaign;
  for (const std::string& date : dates) campaign.conditions.emplace_back().date = date;
  return campaign;
}

}  // namespace

TEST_CASE("identity: the first and the last day of the test, in whatever order", "[report]") {
  const datasets::Campaign campaign = dated({"2026-03-02", "2026-03-04", "2026-03-01"});
  CHECK(identity_json(campaign).at("test_dates") == report::Json{"2026-03-01", "2026-03-04"});
}

TEST_CASE("identity: a condition that is ignored was not tested", "[report]") {
  datasets::Campaign campaign = dated({"2026-03-02", "2025-01-01"});
  campaign.conditions[1].use = datasets::Use::ignore;
  CHECK(identity_json(campaign).at("test_dates") == report::Json{"2026-03-02", "2026-03-02"});
  campaign.conditions[0].date.reset();
  CHECK(identity_json(campaign).is_null());
  campaign.report.fields = {{"number", "1"}};
  CHECK(identity_json(campaign).at("test_dates").is_null());
}
