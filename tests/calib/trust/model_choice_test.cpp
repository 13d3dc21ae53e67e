#include "calib/trust/model_choice.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinAbs;

Candidate candidate(const std::string& name, double cost, int parameters, double effective) {
  return {name, cost, parameters, 1000.0, effective};
}

}  // namespace

TEST_CASE("model choice: a term that explains more than noise is taken", "[calib]") {
  const auto choice =
      choose(candidate("plain", 520.0, 3, 1000.0), candidate("friction", 498.0, 4, 1000.0));
  // 2 (520 - 498) / (996 / 996) = 44
  CHECK_THAT(choice.likelihood_ratio, WithinAbs(44.0, 1e-9));
  CHECK(choice.larger);
  CHECK(choice.p < 1e-6);
  CHECK_THAT(choice.delta_aic, WithinAbs(2.0 - 44.0, 1e-9));
  CHECK_THAT(choice.message, Contains("friction is preferred"));
}

TEST_CASE("model choice: two terms that explain little", "[calib]") {
  const auto choice =
      choose(candidate("plain", 500.0, 3, 1000.0), candidate("both", 498.0, 5, 1000.0));
  const double ratio = 4.0 * 995.0 / 996.0;
  CHECK(choice.freedom == 2);
  CHECK_THAT(choice.likelihood_ratio, WithinAbs(ratio, 1e-9));
  CHECK_THAT(choice.p, WithinAbs(std::exp(-0.5 * ratio), 1e-9));  // chi-square, two degrees
  CHECK_FALSE(choice.larger);
  CHECK_THAT(choice.delta_aic, WithinAbs(4.0 - ratio, 1e-9));
  CHECK_THAT(choice.delta_bic, WithinAbs(2.0 * std::log(1000.0) - ratio, 1e-9));
}

TEST_CASE("model choice: correlated residuals are worth fewer", "[calib]") {
  const auto choice =
      choose(candidate("plain", 520.0, 3, 1000.0), candidate("friction", 498.0, 4, 50.0));
  CHECK_THAT(choice.likelihood_ratio, WithinAbs(44.0 * 0.05, 1e-9));
  CHECK_FALSE(choice.larger);
  CHECK_THAT(choice.message, Contains("plain is good enough"));
}

TEST_CASE("model choice: fits without noise and fits of other records", "[calib]") {
  const auto exact = choose(candidate("plain", 1.0, 3, 1000.0), candidate("more", 0.0, 4, 1000.0));
  CHECK(exact.larger);
  const auto same = choose(candidate("plain", 0.0, 3, 1000.0), candidate("more", 0.0, 4, 1000.0));
  CHECK_FALSE(same.larger);
  CHECK_THROWS_AS(choose(candidate("a", 1.0, 4, 10.0), candidate("b", 1.0, 4, 10.0)),
                  std::invalid_argument);
}

TEST_CASE("model choice: neither contains the other", "[calib]") {
  const Candidate first = candidate("stribeck", 520.0, 5, 1000.0);
  const auto better = compare_information(first, candidate("friction", 498.0, 4, 1000.0));
  // 2 (498 - 520) / (996 / 996), with one parameter fewer
  CHECK_THAT(better.aic, WithinAbs(-44.0 - 2.0, 1e-9));
  CHECK_THAT(better.bic, WithinAbs(-44.0 - std::log(1000.0), 1e-9));
  CHECK_THAT(better.message, Contains("friction is preferred"));
  const auto turned = compare_information(candidate("friction", 498.0, 4, 1000.0), first);
  CHECK_THAT(turned.aic, WithinAbs(-better.aic, 1e-9));
  CHECK_THAT(turned.message, Contains("friction is preferred"));
  const auto even = compare_information(first, candidate("other", 519.9, 5, 1000.0));
  CHECK_THAT(even.message, Contains("no relevant difference"));
  // Each parameter gains 3: AIC prefers them, but BIC requires ln(1000) each.
  const auto unclear =
      compare_information(candidate("few", 503.0, 4, 1000.0), candidate("many", 497.0, 8, 1000.0));
  CHECK(unclear.aic < -2.0);
  CHECK(unclear.bic > 2.0);
  CHECK_THAT(unclear.message, Contains("contradict"));
  CHECK_THROWS_AS(compare_information(first, {"short", 1.0, 4, 10.0, 10.0}), std::invalid_argument);
}

}  // namespace rigcal::calib
