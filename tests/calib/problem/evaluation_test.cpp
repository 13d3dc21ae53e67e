#include "calib/problem/evaluation.hpp"

#include <catch2/catch.hpp>

#include "calib/problem/loss.hpp"
#include "calib/problem/r_factor.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Scope;
using datasets::Waveform;

Twin twin_of_every_scope() {
  Twin twin;
  twin.add_channel(datasets::Channel::load_pressure);
  twin.free("mass", 60.0, 10.0, 500.0);                                // logarithmic
  twin.free("kp", 300.0, 200.0, 500.0);                                // controller, linear
  twin.free("leakage_coefficient", 0.3, 0.0, 5.0, Scope::leak_level);  // one for each level
  twin.free("position_offset", 1e-3, -5e-3, 5e-3, Scope::condition);   // sensor
  twin.campaign.initial = datasets::InitialMode::fit;                  // initial state
  twin.campaign.simulation.tolerance = 1e-9;
  twin.add("a", Waveform::sine, 2.0, 0.01, "low");
  twin.add("b", Waveform::square, 2.0, 0.01, "high").windows = {{0.1, 0.2}, {0.3, 0.35}};
  return twin;
}

}  // namespace

TEST_CASE("problem: derivatives of an uncertainty are coarser, unless the campaign says how exact",
          "[calib]") {
  Twin twin = twin_of_every_scope();
  const auto records = twin.records(400, 1000.0, 3);
  CHECK(problem_of(twin, records).derivative_options(0).tolerance == 1e-9);
  twin.campaign.simulation.tolerance.reset();
  Problem problem = problem_of(twin, records);
  CHECK(problem.derivative_options(0).tolerance == 1e-5);
  problem.tolerance = 2e-5;  // as for less accurate records
  CHECK(problem.derivative_options(0).tolerance == 2e-5);
}

TEST_CASE("evaluation: Jacobian equals finite differences for every scope", "[calib]") {
  Twin twin = twin_of_every_scope();
  twin.campaign.fit.loss = GENERATE(datasets::Loss::squared, datasets::Loss::soft_l1);
  const auto records = twin.records(400, 1000.0, 3);
  const Problem problem = problem_of(twin, records);
  std::vector<double> z = problem.start();
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    ConditionRows rows;
    REQUIRE(evaluate_condition(problem, i, z, nullptr, &rows).ok());
    const auto& acting = problem.map.acting(i);
    REQUIRE(rows.jacobian.cols() == static_cast<Eigen::Index>(acting.size()));
    for (std::size_t j = 0; j < acting.size(); ++j) {
      constexpr double h = 1e-4;
      ConditionRows up;
      ConditionRows down;
      auto moved = z;
      moved[static_cast<std::size_t>(acting[j])] += h;
      REQUIRE(evaluate_condition(problem, i, moved, nullptr, &up).ok());
      moved[static_cast<std::size_t>(acting[j])] -= 2.0 * h;
      REQUIRE(evaluate_condition(problem, i, moved, nullptr, &down).ok());
      const Eigen::VectorXd difference = (up.residual - down.residual) / (2.0 * h);
      const Eigen::VectorXd column = rows.jacobian.col(static_cast<Eigen::Index>(j));
      CAPTURE(i, problem.name(static_cast<std::size_t>(acting[j])));
      // The error from h^2 and the curvature is about 1e-4 of the column in the steepest case
      // (soft_l1), and the solver noise is smaller.
      CHECK((difference - column).norm() < 2e-3 * difference.norm());
    }
  }
}

TEST_CASE("evaluation: the R factor keeps cost and normal equations", "[calib]") {
  const Twin twin = twin_of_every_scope();
  const auto records = twin.records(1300, 1000.0, 3);  // more than two blocks of rows
  const Problem problem = problem_of(twin, records);
  const auto z = problem.start();
  ConditionRows rows;
  const ConditionEvaluation found = evaluate_condition(problem, 0, z, nullptr, &rows);
  REQUIRE(found.ok());
  Eigen::MatrixXd full(rows.jacobian.rows(), rows.jacobian.cols() + 1);
  full << rows.jacobian, rows.residual;
  const Eigen::MatrixXd expected = full.transpose() * full;
  const Eigen::MatrixXd actual = found.r_factor.transpose() * found.r_factor;
  // 1e-12 is the rounding error of 2600 products, relative to the largest element.
  CHECK((actual - expected).cwiseAbs().maxCoeff() < 1e-12 * expected.cwiseAbs().maxCoeff());
  CHECK_THAT(found.cost(), WithinRel(0.5 * rows.residual.squaredNorm(), 1e-12));
}

TEST_CASE("R factor: a column of almost nothing leaves the others alone", "[calib]") {
  // The sensitivity to an initial state that decays: its squares are subnormal numbers.
  const double size = GENERATE(0.0, 1e-162, 1e-157, 1e-155);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Random(700, 3);
  rows.col(1) *= size;
  RFactor r_factor(3);
  r_factor.add(rows);
  REQUIRE(r_factor.get().allFinite());
  Eigen::MatrixXd others(700, 2);
  others << rows.col(0), rows.col(2);
  RFactor alone(2);
  alone.add(others);
  CHECK_THAT(r_factor.get().col(2).norm(), WithinRel(alone.get().col(1).norm(), 1e-12));
  CHECK_THAT(std::abs(r_factor.get()(0, 0)), WithinRel(others.col(0).norm(), 1e-12));
}

TEST_CASE("evaluation: residuals only inside the windows", "[calib]") {
  const Twin twin = twin_of_every_scope();
  const auto records = twin.records(400, 1000.0, 3);
  const Problem problem = problem_of(twin, records);
  CHECK(problem.conditions[0].rows.size() == 400);
  CHECK(problem.conditions[1].rows.size() == 101 + 51);
  CHECK(problem.conditions[1].fit_times().back() == records[1].time_s[350]);
  CHECK(problem.residual_count() == 2 * (400 + 152));
}

TEST_CASE("loss: a least-squares residual whose slope is its derivative", "[calib]") {
  const auto loss = GENERATE(datasets::Loss::squared, datasets::Loss::huber,
                             datasets::Loss::soft_l1, datasets::Loss::cauchy);
  for (const double r : {-20.0, -1.0, 0.5, 2.9, 3.1, 50.0}) {
    constexpr double h = 1e-6;
    const double difference =
        (apply_loss(loss, 3.0, r + h).residual - apply_loss(loss, 3.0, r - h).residual) / (2.0 * h);
    CAPTURE(r);
    // 1e-8 is the rounding error of a difference over 2e-6 between values of up to 50.
    CHECK_THAT(apply_loss(loss, 3.0, r).slope, WithinAbs(difference, 1e-7));
  }
  CHECK(apply_loss(loss, 3.0, 0.0).residual == 0.0);
  CHECK(apply_loss(loss, 3.0, 0.0).slope == 1.0);
}

TEST_CASE("loss: the costs are those of their formulas", "[calib]") {
  const double r = 12.0;
  const double a = 3.0;
  const auto rho = [&](datasets::Loss loss) {
    return std::pow(apply_loss(loss, a, r).residual, 2);
  };
  CHECK_THAT(rho(datasets::Loss::squared), WithinRel(144.0, 1e-14));
  CHECK_THAT(rho(datasets::Loss::huber), WithinRel(2.0 * a * r - a * a, 1e-14));
  CHECK_THAT(rho(datasets::Loss::soft_l1),
             WithinRel(2.0 * a * a * (std::sqrt(1.0 + 16.0) - 1.0), 1e-14));
  CHECK_THAT(rho(datasets::Loss::cauchy), WithinRel(a * a * std::log(17.0), 1e-14));
}

}  // namespace rigcal::calib
