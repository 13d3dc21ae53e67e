#include "calib/design/trial_rig.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>

#include "calib/design/criterion.hpp"
#include "calib/design/design_limits.hpp"
#include "calib/design/drive_shape.hpp"
#include "tests/calib/design/designed.hpp"

namespace rigcal::calib {
namespace {

std::vector<double> some_drive(const TrialRig& rig) {
  const DriveShape shape = drive_shape(
      datasets::DriveFamily::multisine,
      Eigen::VectorXd::LinSpaced(drive_coordinates(datasets::DriveFamily::multisine), 0.1, 0.9),
      drive_grid(rig.settings()));
  std::vector<double> drive(shape.values);
  for (double& value : drive) value = rig.neutral() + 0.3 * rig.reach() * value;
  return drive;
}

}  // namespace

TEST_CASE("trial rig: the information is that of finite differences", "[calib]") {
  const Twin twin = designed_twin();
  const TrialRig rig(twin.campaign, {{datasets::Channel::position, 5e-5}}, nullptr, nullptr);
  const std::vector<double> drive = some_drive(rig);
  const Eigen::MatrixXd rows = rig.sensitivities(drive, 1e-10);
  REQUIRE(rows.rows() == static_cast<Eigen::Index>(drive.size()));
  const Problem& problem = rig.problem();
  Eigen::MatrixXd differences(rows.rows(), rows.cols());
  const auto position_at = [&](const std::vector<double>& z) {
    model::SimulationInputs inputs;
    inputs.drive = model::Signal::held(rig.time_s(), drive);
    model::SimulationOptions options;
    options.tolerance = 1e-11;
    const auto run = model::simulate(twin.campaign.rig, problem.values_at(0, z), {}, inputs,
                                     rig.time_s(), std::vector{model::Output::position}, options);
    REQUIRE(run.ok());
    return Eigen::VectorXd(run.outputs.col(0));
  };
  constexpr double kStep = 1e-4;
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    std::vector<double> above = rig.z();
    std::vector<double> below = rig.z();
    above[static_cast<std::size_t>(j)] += kStep;
    below[static_cast<std::size_t>(j)] -= kStep;
    differences.col(j) = (position_at(above) - position_at(below)) / (2.0 * kStep * 5e-5);
  }
  const Eigen::MatrixXd information = rows.transpose() * rows;
  const Eigen::MatrixXd expected = differences.transpose() * differences;
  for (Eigen::Index j = 0; j < rows.cols(); ++j)
    for (Eigen::Index k = 0; k < rows.cols(); ++k)
      CHECK(std::abs(information(j, k) - expected(j, k)) <
            1e-3 * std::sqrt(expected(j, j) * expected(k, k)));
}

TEST_CASE("trial rig: limits are those of the response and of the reference", "[calib]") {
  const Twin twin = designed_twin();
  const TrialRig rig(twin.campaign, {{datasets::Channel::position, 5e-5}}, nullptr, nullptr);
  std::vector<double> drive(rig.time_s().size(), 0.0);
  const auto at_rest = rig.uses_under(drive, 1e-8).value();
  CHECK(largest_share(at_rest) == 0.0);
  // A peak in the reference that the rig is too slow to follow.
  drive[100] = 0.03;
  const auto uses = rig.uses_under(drive, 1e-8).value();
  CHECK(uses[1].words == "highest position");
  CHECK(uses[1].share == Approx(2.0));
  CHECK(uses[1].reached == Approx(0.03));
}

TEST_CASE("trial rig: four repeats tell twice as much as one", "[calib]") {
  Twin twin = designed_twin();
  const TrialRig one(twin.campaign, {{datasets::Channel::position, 5e-5}}, nullptr, nullptr);
  const Eigen::MatrixXd rows = one.sensitivities(some_drive(one), 1e-8);
  twin.campaign.design->repeats = 4;
  const TrialRig four(twin.campaign, {{datasets::Channel::position, 5e-5}}, nullptr, nullptr);
  const Eigen::MatrixXd more = four.sensitivities(some_drive(four), 1e-8);
  REQUIRE(more.rows() == rows.rows());
  CHECK((more - 2.0 * rows).norm() < 1e-6 * more.norm());
}

TEST_CASE("limit uses: motion counts in both directions, of the rig and of its reference",
          "[calib]") {
  const datasets::DesignSettings settings = designed_twin().campaign.design.value();
  Eigen::MatrixXd run = Eigen::MatrixXd::Zero(3, 5);
  run.row(1) << -0.003, -0.06, -6.0, -4.0, -5e-4;
  run.row(2) << 0.003, 0.03, 3.0, 1.0, 1e-4;
  std::vector<double> shares;
  for (const LimitUse& use : limit_uses(settings, run, std::vector<double>{0.0, -0.006, 0.005}))
    shares.push_back(use.share);
  const std::vector<double> expected{0.006 / 0.012, 0.005 / 0.015, 0.06 / 0.15,
                                     6.0 / 12.0,    4.0 / 5.0,     5e-4 / 1e-3};
  REQUIRE(shares.size() == expected.size());
  for (std::size_t i = 0; i < shares.size(); ++i) CHECK(shares[i] == Approx(expected[i]));
}

TEST_CASE("design score: the covariance of the named, the others estimated too", "[calib]") {
  const Twin twin = designed_twin();
  const TrialRig rig(twin.campaign, {{datasets::Channel::position, 5e-5}}, nullptr, nullptr);
  Eigen::MatrixXd rows(3, 2);
  rows << 40.0, 10.0, 5.0, 60.0, 20.0, 30.0;
  const Eigen::Matrix2d information = rows.transpose() * rows + 12.0 * Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d covariance = information.inverse();
  const auto score = [&](const std::vector<std::size_t>& named, datasets::DesignCriterion by) {
    return design_score(rig.problem(), rig.z(), rows, named, by);
  };
  using datasets::DesignCriterion;
  CHECK(score({0}, DesignCriterion::determinant) == Approx(-0.5 * std::log(covariance(0, 0))));
  CHECK(score({1}, DesignCriterion::determinant) == Approx(-0.5 * std::log(covariance(1, 1))));
  CHECK(score({0, 1}, DesignCriterion::determinant) ==
        Approx(-0.5 * std::log(covariance.determinant())));
  double worst = 0.0;
  for (int j : {0, 1}) {
    const auto u = static_cast<std::size_t>(j);
    const double slope = rig.problem().map.slope(j, rig.z()[u]);
    const double value = rig.problem().map.to_physical(j, rig.z()[u]);
    worst = std::max(worst, std::sqrt(covariance(j, j)) * slope / value);
  }
  CHECK(score({0, 1}, DesignCriterion::worst) == Approx(-std::log(worst)));
}

TEST_CASE("design score: without any information it is that of the bounds", "[calib]") {
  const Twin twin = designed_twin();
  const TrialRig rig(twin.campaign, {{datasets::Channel::position, 5e-5}}, nullptr, nullptr);
  CHECK(design_score(rig.problem(), rig.z(), Eigen::MatrixXd::Zero(1, 2), {0},
                     datasets::DesignCriterion::determinant) == Approx(0.5 * std::log(12.0)));
}

}  // namespace rigcal::calib
