#include <catch2/catch.hpp>
#include <cmath>

#include "calib/search/evaluator.hpp"
#include "calib/search/search.hpp"
#include "calib/search/stage.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinRel;
using datasets::Waveform;

const FitOptions kOptions = [] {
  FitOptions options;
  options.max_iterations = 100;
  return options;
}();

/// Three signals, 2 s each at 1 kHz, with mass and valve gain free.
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

TEST_CASE("fidelity: the first period of a sine or square, all of another signal", "[calib]") {
  Twin twin = three_signals();
  twin.campaign.conditions[1].windows = {{0.25, 0.275}, {0.3, 2.0}};
  const auto records = twin.records(2000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  CHECK(problem.repeats_itself());
  const Fidelity longest = Fidelity::first(horizons_s(problem).back());
  CHECK(problem.conditions[0].rows_at(longest) == 501);
  // From 0.25 s to 0.35 s, without the samples between the windows.
  CHECK(problem.conditions[1].rows_at(longest) == 26 + 51);
  CHECK_THAT(problem.conditions[1].fit_times(longest).back(), WithinRel(0.35, 1e-12));
  CHECK(problem.conditions[2].rows_at(longest) == 2000);
  CHECK(problem.conditions[1].rows_at(Fidelity::first(0.02)) == 21);
  CHECK(problem.conditions[2].rows_at(Fidelity::first(0.02)) == 21);
  CHECK(problem.conditions[0].rows_at(Fidelity::coarse) == 2000);
  CHECK(problem.conditions[0].fit_times().size() == 2000);
}

TEST_CASE("fidelity: horizons grow from four samples to the longest first period", "[calib]") {
  Twin twin = three_signals();
  twin.campaign.conditions.pop_back();  // the sweep, which is not periodic
  const auto records = twin.records(2000, 1000.0, 1);
  const std::vector<double> lengths_s = horizons_s(problem_of(twin, records));
  REQUIRE(lengths_s.size() == 5);  // four steps of at most a factor of 4, from 4 ms to 0.5 s
  CHECK_THAT(lengths_s.front(), WithinRel(4e-3, 1e-12));
  CHECK_THAT(lengths_s.back(), WithinRel(0.5, 1e-12));
  for (std::size_t k = 1; k < lengths_s.size(); ++k)
    CHECK_THAT(lengths_s[k] / lengths_s[k - 1], WithinRel(std::pow(125.0, 0.25), 1e-9));
  // An unknown that only one record determines needs four more samples.
  twin.free("position_offset", 0.0, -5e-3, 5e-3, datasets::Scope::condition);
  CHECK_THAT(horizons_s(problem_of(twin, records)).front(), WithinRel(8e-3, 1e-12));
}

TEST_CASE("fidelity: less than a period is everything", "[calib]") {
  Twin twin = three_signals();
  twin.campaign.conditions.resize(1);
  const auto records = twin.records(400, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  CHECK_FALSE(problem.repeats_itself());
  CHECK(problem.of_starts() == Fidelity::coarse);
}

TEST_CASE("fidelity: each record is simulated as exactly as its own noise asks", "[calib]") {
  Twin twin = three_signals();
  twin.noise_sd_m = 2e-6;
  SECTION("known noise") {
    const auto records = twin.records(2000, 1000.0, 1);
    const Problem problem = problem_of(twin, records);
    const auto share = [&](std::size_t i) {
      const ProblemChannel& channel = problem.conditions[i].channels.front();
      return channel.sd / channel.peak_to_peak;
    };
    // The second record has the same noise but a smaller motion.
    REQUIRE(share(1) > 3.0 * share(0));
    CHECK_THAT(problem.tolerance_of(1) / problem.tolerance_of(0),
               WithinRel(share(1) / share(0), 1e-9));
    CHECK(problem.tolerance_of(1, Fidelity::first(0.1)) == problem.coarse_tolerance());
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

TEST_CASE("fidelity: the cost of a start needs no derivatives", "[calib]") {
  const Twin twin = three_signals();
  const auto records = twin.records(2000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  EvaluationOptions cost_alone;
  cost_alone.fidelity = Fidelity::cost;
  const Evaluation alone = evaluate_at(problem, problem.start(), 1, cost_alone);
  const Evaluation whole = evaluate_at(problem, problem.start(), 1);
  REQUIRE(alone.ok);
  CHECK(alone.conditions.front().r_factor.cols() == 1);
  CHECK_THAT(alone.cost, WithinRel(whole.cost, 1e-2));
}

TEST_CASE("search: first periods that mislead are not believed", "[calib]") {
  const Twin twin = three_signals();
  auto records = twin.records(2000, 1000.0, 1);
  // Somebody leaned on the rig during the whole first period, which is a quarter of the record.
  for (std::size_t i = 0; i < 500; ++i) {
    double& x = records[0].channels.at(datasets::Channel::position).mean[i];
    x = 0.3 * x + 0.01;
  }
  const Problem problem = problem_of(twin, records);
  const auto end_from = [&](std::vector<double> z, bool all_at_once) {
    Budget budget;
    Evaluator evaluator(problem, budget);
    Search search(problem, evaluator, kOptions);
    const SolveResult found = all_at_once ? search.polish(std::move(z)) : search.run(std::move(z));
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

TEST_CASE("search: horizons that mislead are not believed", "[calib]") {
  const Twin twin = three_signals();
  auto records = twin.records(2000, 1000.0, 1);
  for (std::size_t i = 0; i < 12; ++i)  // a plug that was not yet connected
    records[1].channels.at(datasets::Channel::position).mean[i] += 0.01 * (i % 2 == 0 ? 1.0 : -1.0);
  const Problem problem = problem_of(twin, records);
  Budget budget;
  Evaluator evaluator(problem, budget);
  const SolveResult found = Search(problem, evaluator, kOptions).run(problem.start());
  CHECK(found.status == FitStatus::converged);
  const std::vector<double> values = problem.to_physical(evaluator.best().z);
  CHECK_THAT(values[0], WithinRel(85.0, 0.05));
  CHECK_THAT(values[1], WithinRel(0.0406e-3, 0.02));
  // Wherever the search is stopped, it never ends at a worse point than its start.
  const double at_start = evaluate_at(problem, problem.start(), 1).cost;
  for (long most = 1; most <= 20; ++most) {
    Budget limited(nullptr, {}, {}, most);
    Evaluator stopped(problem, limited);
    Search(problem, stopped, kOptions).run(problem.start());
    REQUIRE(stopped.best().ok);
    CHECK(stopped.best().cost <= at_start);
  }
}

TEST_CASE("search: more records of the same take no more evaluations", "[calib]") {
  // The paper's rig from a distant start. In its first samples the leak falls to its bound.
  const auto evaluations = [](int copies) {
    Twin twin;
    twin.free("mass", 50.0, 17.0, 425.0);
    twin.free("bulk_modulus", 1033e6, 138e6, 3445e6);
    twin.free("valve_gain", 0.0284e-3, 0.0081e-3, 0.203e-3);
    twin.free("leakage_coefficient", 0.7, 0.0, 1.75);
    for (int copy = 0; copy < copies; ++copy) {
      twin.add("sine" + std::to_string(copy), Waveform::sine, 1.0, 0.02);
      twin.add("square" + std::to_string(copy), Waveform::square, 2.0, 0.01);
    }
    twin.truth.conditions = twin.campaign.conditions;
    auto records = twin.records(2000, 1000.0, 1);
    for (std::size_t i = 2; i < records.size(); ++i) records[i].channels = records[i % 2].channels;
    const Problem problem = problem_of(twin, records);
    Budget budget;
    Evaluator evaluator(problem, budget);
    CHECK(Search(problem, evaluator, kOptions).run(problem.start()).status == FitStatus::converged);
    return evaluator.counters().evaluations;
  };
  CHECK(evaluations(8) <= evaluations(1) + 3);
}

TEST_CASE("search: what rings is found from a start that is out of step", "[calib]") {
  // The frequency is three times the true one, so that the phase is off by a full cycle within 6
  // ms.
  Twin twin;
  twin.add_channel(datasets::Channel::load_pressure);
  twin.free("mass", 40.0, 10.0, 500.0);
  twin.free("bulk_modulus", 2900e6, 70e6, 7000e6);
  twin.free("valve_gain", 0.025e-3, 0.01e-3, 0.2e-3);
  twin.add("square", Waveform::square, 5.0, 0.002);
  twin.truth.conditions = twin.campaign.conditions;
  const auto records = twin.records(600, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  const auto fitted_from = [&](const auto& method) {
    Budget budget;
    Evaluator evaluator(problem, budget);
    evaluator.set_fidelity(Fidelity::coarse);
    method(evaluator);
    return problem.to_physical(evaluator.best().z);
  };
  const auto by_growing_horizon = fitted_from(
      [&](Evaluator& evaluator) { Search(problem, evaluator, kOptions).run(problem.start()); });
  const auto all_at_once = fitted_from([&](Evaluator& evaluator) {
    Iterations iterations(kOptions);
    minimise(problem, evaluator, problem.start(), {Fidelity::full, kFirstTrustRadius}, iterations);
  });
  const std::vector<double> truth{85.0, 689e6, 0.0406e-3};
  for (std::size_t j = 0; j < truth.size(); ++j)
    CHECK_THAT(by_growing_horizon[j], WithinRel(truth[j], 0.05));
  // This is why horizons are used: otherwise the start ends in a valley with a different frequency.
  CHECK(std::abs(all_at_once[1] / truth[1] - 1.0) > 0.5);
}

TEST_CASE("search: a fit stopped among horizons is judged by whole records", "[calib]") {
  const Twin twin = three_signals();
  const auto records = twin.records(2000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  Budget options(nullptr, {}, {}, 4);
  Evaluator evaluator(problem, options);
  const SolveResult found = Search(problem, evaluator, kOptions).run(problem.start());
  CHECK(found.status == FitStatus::stopped);
  CHECK(found.message == "stopped by the limit of evaluations");
  const Evaluation again = evaluate_at(problem, evaluator.best().z, 1);
  CHECK_THAT(evaluator.best().cost, WithinRel(again.cost, 1e-12));
}

}  // namespace rigcal::calib
