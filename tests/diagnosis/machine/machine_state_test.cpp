#include "diagnosis/machine/machine_state.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace rigcal;
using Catch::WithinAbs;
using Catch::WithinRel;
using diagnosis::LeakEstimate;
using diagnosis::StateMember;

namespace {

const Eigen::MatrixXd kExactRig = Eigen::MatrixXd::Zero(0, 0);

StateMember member(double coefficient, double own_se, double freedom = 1e6, double move = 0.0) {
  StateMember result;
  result.coefficient = coefficient;
  result.own_se = own_se;
  result.freedom = freedom;
  result.rig_moves = Eigen::VectorXd::Constant(1, move);
  return result;
}

LeakEstimate estimate_of(double share, double low, double high) {
  LeakEstimate estimate;
  estimate.share = share;
  estimate.share_ci95 = {low, high};
  return estimate;
}

}  // namespace

TEST_CASE("pooled_leak: weights are the inverse variances", "[diagnosis]") {
  // The weights are 1 / 0.1^2 = 100 and 1 / 0.2^2 = 25, which gives (100 * 1 + 25 * 1.1) / 125 with
  // an error of 1 / sqrt(125).
  const auto pooled =
      diagnosis::pooled_leak({member(1.0, 0.1, 8.0), member(1.1, 0.2, 4.0)}, kExactRig);
  CHECK_THAT(pooled.coefficient, WithinRel(1.02, 1e-12));
  CHECK_THAT(pooled.error.own_se, WithinRel(1.0 / std::sqrt(125.0), 1e-12));
  CHECK(pooled.error.rig_se == 0.0);
  CHECK(pooled.widened == 1.0);
  // Chi-square is 0.1^2 / (0.1^2 + 0.2^2), with one degree of freedom.
  CHECK_THAT(pooled.chi_squared, WithinRel(0.2, 1e-9));
  CHECK(pooled.freedom == 1.0);
  CHECK_THAT(pooled.p, WithinAbs(std::erfc(std::sqrt(0.1)), 1e-9));
  // Welch and Satterthwaite: the contributions are 0.8 and 0.2 of the variance.
  CHECK_THAT(pooled.error.freedom, WithinRel(1.0 / (0.64 / 8.0 + 0.04 / 4.0), 1e-9));
}

TEST_CASE("pooled_leak: an error that all members share does not average out", "[diagnosis]") {
  const Eigen::MatrixXd rig = Eigen::MatrixXd::Constant(1, 1, 0.09);
  std::vector<StateMember> members(4, member(0.5, 0.2, 1e6, 1.0));
  const auto same = diagnosis::pooled_leak(members, rig);
  CHECK_THAT(same.error.own_se, WithinRel(0.1, 1e-12));
  CHECK_THAT(same.error.rig_se, WithinRel(0.3, 1e-12));
  CHECK_THAT(same.rig_moves(0), WithinRel(1.0, 1e-12));
  // If the rig shifts two members in opposite directions, their mean does not depend on it.
  const auto opposite =
      diagnosis::pooled_leak({member(0.4, 0.01, 1e6, 1.0), member(0.6, 0.01, 1e6, -1.0)}, rig);
  CHECK_THAT(opposite.coefficient, WithinRel(0.5, 1e-12));
  CHECK_THAT(opposite.error.rig_se, WithinAbs(0.0, 1e-12));
  CHECK(opposite.p > 0.5);  // the error of the rig explains their difference
}

TEST_CASE("pooled_leak: members that disagree have a variance between them", "[diagnosis]") {
  // The scores around the mean are -3, 0 and 3, so chi-square is 18 with 2 degrees of freedom.
  const auto pooled =
      diagnosis::pooled_leak({member(0.7, 0.1), member(1.0, 0.1), member(1.3, 0.1)}, kExactRig);
  CHECK_THAT(pooled.coefficient, WithinRel(1.0, 1e-12));
  CHECK_THAT(pooled.chi_squared, WithinRel(18.0, 1e-9));
  CHECK_THAT(pooled.p, WithinRel(std::exp(-9.0), 1e-9));
  CHECK_THAT(pooled.widened, WithinRel(3.0, 1e-9));
  CHECK_THAT(pooled.error.own_se, WithinRel(0.3 / std::sqrt(3.0), 1e-9));
  CHECK_THAT(pooled.error.freedom, WithinRel(2.0 * 81.0 / 64.0, 1e-4));  // 8/9 of the variance
  // An error of the rig that moves all members alike explains none of it, and is not widened.
  const auto unsure = diagnosis::pooled_leak(
      {member(0.7, 0.1, 1e6, 1.0), member(1.0, 0.1, 1e6, 1.0), member(1.3, 0.1, 1e6, 1.0)},
      Eigen::MatrixXd::Constant(1, 1, 0.01));
  CHECK_THAT(unsure.widened, WithinRel(3.0, 1e-9));
  CHECK_THAT(unsure.error.rig_se, WithinRel(0.1, 1e-9));
  CHECK(diagnosis::pooled_leak({member(0.7, 0.1)}, kExactRig).p == 1.0);
  CHECK_THROWS_AS(diagnosis::pooled_leak({}, kExactRig), std::invalid_argument);
  CHECK_THROWS_AS(diagnosis::pooled_leak({member(0.7, 0.0)}, kExactRig), std::invalid_argument);
}

TEST_CASE("pooled_leak: members that disagree are pooled to a value among them", "[diagnosis]") {
  // The error of the rig moves the second member three times as far as the first. Without a
  // variance between them, their difference of 1 would be read as an error of the rig, and the
  // first member, corrected for it, would be 0.5 smaller: less than both.
  const auto pooled =
      diagnosis::pooled_leak({member(1.0, 0.01, 1e6, 1.0), member(2.0, 0.01, 1e6, 3.0)},
                             Eigen::MatrixXd::Constant(1, 1, 0.01));
  CHECK_FALSE(pooled.agree);
  CHECK(pooled.coefficient > 1.2);
  CHECK(pooled.coefficient < 1.5);
  CHECK(pooled.error.half_width() > 1.0);
}

TEST_CASE("nearest_limit: how far a share is from the next class", "[diagnosis]") {
  const datasets::DiagnosisSettings settings;  // limits are 1, 10, 20 and 30 %
  const auto below = diagnosis::nearest_limit(estimate_of(0.17, 0.165, 0.175), settings);
  CHECK(below.class_ == datasets::LeakClass::critical);
  CHECK_THAT(below.distance_percentage_points, WithinAbs(-3.0, 1e-10));
  CHECK_FALSE(below.on_limit);
  const auto above = diagnosis::nearest_limit(estimate_of(0.12, 0.11, 0.13), settings);
  CHECK(above.class_ == datasets::LeakClass::medium);
  CHECK_THAT(above.distance_percentage_points, WithinAbs(2.0, 1e-10));
  CHECK(diagnosis::nearest_limit(estimate_of(0.12, 0.095, 0.145), settings).on_limit);
  // A share within 5 % of the limit counts as on it, however certain it is, because a table may
  // list rounded shares.
  CHECK(diagnosis::nearest_limit(estimate_of(0.2099, 0.2098, 0.21), settings).on_limit);
  CHECK_FALSE(diagnosis::nearest_limit(estimate_of(0.2101, 0.2100, 0.2102), settings).on_limit);
}

TEST_CASE("state_of: leak level, specimen and date; else the condition itself", "[diagnosis]") {
  datasets::Condition condition;
  condition.id = "sine";
  CHECK(diagnosis::state_of(condition).name() == "sine");
  condition.leak_level = "33 %";
  condition.specimen = "B";
  condition.date = "2026-03-01";
  CHECK(diagnosis::state_of(condition).name() == "33 %, specimen B, 2026-03-01");
  condition.leak_level.reset();
  CHECK(diagnosis::state_of(condition).name() == "specimen B, 2026-03-01");
}
