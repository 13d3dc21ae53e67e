#include "diagnosis/record/stated_leak.hpp"

#include <catch2/catch.hpp>

using namespace rigcal;
using namespace rigcal::diagnosis;
using Catch::WithinRel;

namespace {

LeakEstimate medium_leak() {
  LeakEstimate estimate;
  estimate.coefficient = 0.5;
  estimate.ci95 = {0.45, 0.55};
  estimate.standard_error = 0.025;
  estimate.share = 0.15;
  estimate.share_ci95 = {0.14, 0.16};
  estimate.leak_flow_m3_per_s = 1e-3 / 60.0;
  estimate.leak_detected = true;
  estimate.probability = {0.0, 0.02, 0.98, 0.0, 0.0};
  estimate.most_probable = LeakClass::medium;
  estimate.budget = {{{"sine", "records", 0.025}}, 0.025, 10.0, 2.2, 0.055};
  return estimate;
}

}  // namespace

TEST_CASE("stated: a leak in percent and L/min, with its class", "[diagnosis]") {
  LeakEstimate estimate = medium_leak();
  const StatedLeak leak = stated(estimate, 0.98);
  CHECK(leak.leakage_coefficient == 0.5);
  CHECK(leak.ci95 == Range{0.45, 0.55});
  CHECK(leak.leak_share_percent == 15.0);
  CHECK_THAT(leak.leak_share_ci95_percent->high, WithinRel(16.0, 1e-12));
  CHECK_THAT(leak.leak_flow_l_per_min.value(), WithinRel(1.0, 1e-12));
  CHECK(leak.leak_detected == true);
  CHECK(leak.compatible_with_model == true);
  CHECK(leak.class_ == LeakClass::medium);
  REQUIRE(leak.class_probabilities.size() == kClassCount);
  CHECK(leak.class_probabilities[2] == std::pair(std::string("medium"), std::optional(0.98)));
  CHECK(leak.budget->combined == leak.standard_error);
  CHECK_FALSE(leak.share_budget);  // nothing is known about it
  CHECK_FALSE(leak.leak_share_upper_limit_percent);
  CHECK_FALSE(stated(estimate, 0.99).class_);
  estimate.share_budget = {{{"sine", "records", 0.5}}, 0.5, 10.0, 2.2, 1.1};
  estimate.share_upper_limit = 0.16;
  const StatedLeak more = stated(estimate, 0.5);
  CHECK(more.share_budget->lines[0].uncertainty == 0.5);
  CHECK(more.leak_share_upper_limit_percent == 16.0);
  // A negative estimate that its error explains is a leak of zero.
  estimate.coefficient = -0.01;
  CHECK(stated(estimate, 0.5).leakage_coefficient == 0.0);
}

TEST_CASE("stated: only the error of a leak that the model cannot have", "[diagnosis]") {
  LeakEstimate estimate = medium_leak();
  estimate.incompatible = true;
  const StatedLeak leak = stated(estimate, 0.5);
  CHECK(leak.compatible_with_model == false);
  CHECK(leak.standard_error == 0.025);
  CHECK(leak.budget);
  CHECK_FALSE(leak.leakage_coefficient);
  CHECK_FALSE(leak.ci95);
  CHECK_FALSE(leak.leak_share_percent);
  CHECK_FALSE(leak.leak_detected);
  CHECK_FALSE(leak.class_);
  CHECK_FALSE(leak.class_probabilities[2].second);
}

TEST_CASE("stated: neither share nor class of more than the servo flow", "[diagnosis]") {
  LeakEstimate estimate = medium_leak();
  estimate.share = 4.99;
  const StatedLeak leak = stated(estimate, 0.5);
  CHECK(leak.leakage_coefficient == 0.5);
  CHECK_FALSE(leak.leak_share_percent);
  CHECK_FALSE(leak.leak_share_ci95_percent);
  CHECK_FALSE(leak.class_);
  CHECK_FALSE(leak.class_probabilities[2].second);
}

TEST_CASE("stated: no interval of a coefficient that is exact by construction", "[diagnosis]") {
  LeakEstimate estimate = medium_leak();
  estimate.standard_error = 0.0;
  const StatedLeak leak = stated(estimate, 0.5);
  CHECK(leak.leakage_coefficient == 0.5);
  CHECK_FALSE(leak.ci95);
  CHECK_FALSE(leak.budget);
}
