#include "calib/problem/measured_tolerance.hpp"

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <catch2/catch.hpp>
#include <cmath>

#include "calib/consider/catalogue.hpp"
#include "calib/problem/evaluation.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using datasets::Channel;
using datasets::Waveform;

/// A sine, and the same sine with a noisy recorded reference.
struct RecordedTwin {
  Twin twin;
  std::vector<datasets::Record> records;

  RecordedTwin() {
    twin.free("mass", 60.0, 10.0, 500.0);
    twin.free("leakage_coefficient", 0.3, 0.0, 5.0);
    twin.add("generated", Waveform::sine, 2.0, 0.01);
    twin.add("recorded", Waveform::sine, 2.0, 0.01);
    records = twin.records(800, 1000.0, 3);
    twin.campaign.conditions[1].waveform = Waveform::recorded;
    twin.add_channel(Channel::reference, datasets::ChannelRole::input);
    boost::random::mt19937_64 random(5);
    boost::random::normal_distribution<double> noise(0.0, 5e-5);
    const model::Signal sine = model::Signal::sine(0.01, 2.0);
    datasets::Series& reference = records[1].channels[Channel::reference];
    for (const double t : records[1].time_s)
      reference.mean.push_back(sine.value(t) + noise(random));
  }
};

/// Factor on the noise of a record, which makes it require a smaller tolerance.
constexpr double kQuiet = 0.01;

/// Norm of the simulation errors in a condition's residuals, compared with a tolerance of 1e-10.
double error_at(const Problem& problem, std::size_t condition, std::span<const double> z) {
  Problem exact = problem;
  exact.tolerance = 1e-10;
  exact.tolerance_fixed = true;
  ConditionRows there;
  ConditionRows here;
  REQUIRE(evaluate_condition(exact, condition, z, nullptr, &there).ok());
  REQUIRE(evaluate_condition(problem, condition, z, nullptr, &here).ok());
  return (here.residual - there.residual).norm();
}

}  // namespace

TEST_CASE("measured tolerance: a recorded drive is simulated as exactly as its residuals ask for",
          "[calib]") {
  RecordedTwin rig;
  Problem problem = problem_of(rig.twin, rig.records);
  const std::vector<double> z = problem.start();
  const double before[] = {problem.tolerance_of(0), problem.tolerance_of(1)};
  measure_tolerances(problem, z, 1, nullptr);
  CHECK(problem.conditions[0].measured_tolerance == 0.0);
  CHECK(problem.tolerance_of(0) == before[0]);
  CHECK(problem.tolerance_of(1) > 3.0 * before[1]);
  CHECK(problem.tolerance_of(1) <= 1e-5);
  CHECK(problem.tolerance_of(1, Fidelity::coarse) == problem.coarse_tolerance());
  // Derivatives for an uncertainty may be less exact.
  CHECK(problem.derivative_options(0).tolerance > problem.tolerance_of(0));
  // Even if the whole error went into one estimate, it would be a hundredth of a standard error.
  const double error = error_at(problem, 1, z);
  CHECK(error > 0.0);
  CHECK(error < 0.01);

  // Errors of the residuals alone do not allow derivatives that are too inaccurate.
  Problem noisy = problem;
  noisy.conditions[1].measured_tolerance = 1e-3;
  CHECK(noisy.tolerance_of(1) == 1e-5);

  // Less noise requires a smaller tolerance.
  Problem quiet = problem_of(rig.twin, rig.records);
  quiet.conditions[1].channels[0].sd *= kQuiet;
  quiet.tolerance = 1e-8;
  measure_tolerances(quiet, z, 1, nullptr);
  CHECK(quiet.tolerance_of(1) < 0.5 * problem.tolerance_of(1));
  CHECK(error_at(quiet, 1, z) < 0.01);
}

TEST_CASE("largest_simulation_error: the errors of all residuals stay below it", "[calib]") {
  RecordedTwin rig;
  Problem problem = problem_of(rig.twin, rig.records);
  const std::vector<double> z = problem.start();
  measure_tolerances(problem, z, 1, nullptr);
  const double error = std::hypot(error_at(problem, 0, z), error_at(problem, 1, z));
  CHECK(error <= largest_simulation_error(problem));
  CHECK(largest_simulation_error(problem) < 0.1);
  // A measured tolerance is that of a norm of 0.005, and may be too coarse by a factor of two.
  Problem measured = problem;
  for (ProblemCondition& each : measured.conditions)
    each.measured_tolerance = measured.tolerance = 1e-6;
  CHECK_THAT(largest_simulation_error(measured), Catch::WithinRel(0.01, 1e-9));
  // A tolerance that the campaign states is taken at its word.
  Problem stated = problem_of(rig.twin, rig.records);
  stated.tolerance_fixed = true;
  stated.tolerance = 1e-6;
  const double fine = largest_simulation_error(stated);
  stated.tolerance = 1e-4;
  CHECK_THAT(largest_simulation_error(stated), Catch::WithinRel(100.0 * fine, 1e-9));
}

TEST_CASE("measured tolerance: effects are simulated more coarsely, as their record allows",
          "[calib]") {
  RecordedTwin rig;
  Problem problem = problem_of(rig.twin, rig.records);
  const std::vector<double> z = problem.start();
  const auto outputs = [&] {
    return outputs_with(problem, 1, z, {}, Eigen::VectorXd(), Derivatives::none, nullptr).outputs;
  };
  const Eigen::VectorXd fine = outputs();  // at 1e-6
  measure_tolerances(problem, z, 1, nullptr);
  const double error = (outputs() - fine).norm();
  CHECK(error > error_at(problem, 1, z));
  CHECK(error < 0.3);
}

TEST_CASE("measured tolerance: it becomes finer where it must, and never coarser", "[calib]") {
  RecordedTwin rig;
  Problem problem = problem_of(rig.twin, rig.records);
  const std::vector<double> z = problem.start();
  measure_tolerances(problem, z, 1, nullptr);
  const double found = problem.tolerance_of(1);
  CHECK_FALSE(refine_tolerances(problem, z, 1, nullptr));
  problem.conditions[1].channels[0].sd *= kQuiet;
  CHECK(refine_tolerances(problem, z, 1, nullptr));
  const double finer = problem.tolerance_of(1);
  CHECK(finer < 0.5 * found);
  problem.conditions[1].channels[0].sd /= kQuiet * kQuiet;
  CHECK_FALSE(refine_tolerances(problem, z, 1, nullptr));
  CHECK(problem.tolerance_of(1) == finer);
}

TEST_CASE(
    "measured tolerance: none if the campaign fixes it, a simulation fails, or all is nuisance",
    "[calib]") {
  RecordedTwin rig;
  rig.twin.campaign.simulation.tolerance = 1e-7;
  Problem fixed = problem_of(rig.twin, rig.records);
  measure_tolerances(fixed, fixed.start(), 1, nullptr);
  CHECK(fixed.conditions[1].measured_tolerance == 0.0);
  CHECK(fixed.tolerance_of(1) == 1e-7);
  CHECK(fixed.derivative_options(1).tolerance == 1e-7);
  rig.twin.campaign.simulation.tolerance.reset();
  Problem scored = make_problem(rig.twin.campaign, rig.records, {&rig.twin.campaign.conditions[1]},
                                true, nullptr);
  REQUIRE(scored.map.unknowns().empty());
  measure_tolerances(scored, scored.start(), 1, nullptr);
  CHECK(scored.conditions[0].measured_tolerance > 0.0);
  rig.twin.free("position_offset", 0.0, -1e-3, 1e-3).nuisance = true;
  Problem nuisance = make_problem(rig.twin.campaign, rig.records,
                                  {&rig.twin.campaign.conditions[1]}, true, nullptr);
  measure_tolerances(nuisance, nuisance.start(), 1, nullptr);
  CHECK(nuisance.conditions[0].measured_tolerance == 0.0);
  Problem failing = problem_of(rig.twin, rig.records);
  failing.conditions[1].max_steps = 3;
  measure_tolerances(failing, failing.start(), 1, nullptr);
  CHECK(failing.conditions[1].measured_tolerance == 0.0);
}

}  // namespace rigcal::calib
