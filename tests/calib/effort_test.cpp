#include <catch2/catch.hpp>

#include "calib/evaluator.hpp"
#include "calib/solve.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinRel;
using datasets::Waveform;

/// 2 s at 1 kHz of three signals, mass and valve gain free.
Twin three_signals() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("slow", Waveform::sine, 2.0, 0.02);
  twin.add("fast", Waveform::square, 10.0, 0.002);
  twin.add("sweep", Waveform::chirp, 1.0, 0.01);
  twin.campaign.conditions.back().end_frequency_hz = 5.0;
  twin.campaign.conditions.back().sweep_s = 2.0;
  twin.truth.conditions = twin.campaign.conditions;
  return twin;
}

}  // namespace

TEST_CASE("effort: the first period of a sine or square, all of another signal", "[calib]") {
  Twin twin = three_signals();
  twin.campaign.conditions[1].windows = {{0.25, 0.275}, {0.3, 2.0}};
  const auto records = twin.records(2000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  CHECK(problem.repeats_itself());
  CHECK(problem.conditions[0].rows_at(Effort::first_periods) == 501);
  // From 0.25 s to 0.35 s, but for what lies between the windows.
  CHECK(problem.conditions[1].rows_at(Effort::first_periods) == 26 + 51);
  CHECK_THAT(problem.conditions[1].fit_times(Effort::first_periods).back(), WithinRel(0.35, 1e-12));
  CHECK(problem.conditions[2].rows_at(Effort::first_periods) == 2000);
  CHECK(problem.conditions[0].rows_at(Effort::coarse) == 2000);
  CHECK(problem.conditions[0].fit_times().size() == 2000);
}

TEST_CASE("effort: less than a period is everything", "[calib]") {
  Twin twin = three_signals();
  twin.campaign.conditions.resize(1);
  const auto records = twin.records(400, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  CHECK_FALSE(problem.repeats_itself());
  CHECK(problem.of_starts() == Effort::coarse);
}

TEST_CASE("effort: each record is simulated as exactly as its own noise asks", "[calib]") {
  Twin twin = three_signals();
  twin.noise_sd_m = 2e-6;
  SECTION("known noise") {
    const auto records = twin.records(2000, 1000.0, 1);
    const Problem problem = problem_of(twin, records);
    const auto share = [&](std::size_t i) {
      const ProblemChannel& channel = problem.conditions[i].channels.front();
      return channel.sd / channel.peak_to_peak;
    };
    // The same noise, a smaller motion.
    REQUIRE(share(1) > 3.0 * share(0));
    CHECK_THAT(problem.tolerance_of(1) / problem.tolerance_of(0),
               WithinRel(share(1) / share(0), 1e-9));
    CHECK(problem.tolerance_of(1, Effort::first_periods) == problem.coarse_tolerance());
  }
  SECTION("noise that is not known tells nothing") {
    const auto records = twin.records(2000, 1000.0, 1, model::InitialState::rest, false);
    const Problem problem = problem_of(twin, records);
    CHECK(problem.tolerance_of(1) == problem.tolerance);
  }
  SECTION("the campaign's word holds") {
    twin.campaign.simulation.tolerance = 3e-7;
    const auto records = twin.records(2000, 1000.0, 1);
    CHECK(problem_of(twin, records).tolerance_of(1) == 3e-7);
  }
}

TEST_CASE("effort: the cost of a start needs no derivatives", "[calib]") {
  const Twin twin = three_signals();
  const auto records = twin.records(2000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  EvaluationOptions cost_alone;
  cost_alone.effort = Effort::cost;
  const Evaluation alone = evaluate_at(problem, problem.start(), 1, cost_alone);
  const Evaluation whole = evaluate_at(problem, problem.start(), 1);
  REQUIRE(alone.ok);
  CHECK(alone.conditions.front().triangle.cols() == 1);
  CHECK_THAT(alone.cost, WithinRel(whole.cost, 1e-2));
}

TEST_CASE("solve: first periods that mislead are not believed", "[calib]") {
  const Twin twin = three_signals();
  auto records = twin.records(2000, 1000.0, 1);
  // Someone leant on the rig: all of the first period, a quarter of the record.
  for (std::size_t i = 0; i < 500; ++i) {
    double& x = records[0].channels.at(datasets::Channel::position).mean[i];
    x = 0.3 * x + 0.01;
  }
  const Problem problem = problem_of(twin, records);
  const auto end_from = [&](std::vector<double> z, bool all_at_once) {
    Evaluator evaluator(problem, {});
    const SolveResult found = all_at_once ? refine(problem, evaluator, std::move(z), 100, 1, {})
                                          : solve(problem, evaluator, std::move(z), 100, 1, {});
    CHECK(found.status == FitStatus::converged);
    return evaluator.best();
  };
  const Evaluation by_periods = end_from(problem.start(), false);
  const Evaluation reference = end_from(by_periods.z, true);
  const Evaluation from_truth =
      end_from({problem.map.to_unit(0, 85.0), problem.map.to_unit(1, 0.0406e-3)}, true);
  CHECK_THAT(by_periods.cost, WithinRel(from_truth.cost, 1e-5));
  CHECK_THAT(reference.cost, WithinRel(from_truth.cost, 1e-5));
}

TEST_CASE("solve: a fit stopped among first periods is judged by whole records", "[calib]") {
  const Twin twin = three_signals();
  const auto records = twin.records(2000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  Evaluator::Options options;
  options.max_evaluations = 4;
  Evaluator evaluator(problem, options);
  const SolveResult found = solve(problem, evaluator, problem.start(), 100, 1, {});
  CHECK(found.status == FitStatus::stopped);
  CHECK(found.message == "stopped after 4 evaluations, the most allowed");
  const Evaluation again = evaluate_at(problem, evaluator.best().z, 1);
  CHECK_THAT(evaluator.best().cost, WithinRel(again.cost, 1e-12));
}

}  // namespace rigcal::calib
