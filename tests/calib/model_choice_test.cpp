#include "calib/model_choice.hpp"

#include <catch2/catch.hpp>

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

}  // namespace rigcal::calib
