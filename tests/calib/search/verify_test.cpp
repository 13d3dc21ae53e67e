#include "calib/search/verify.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinRel;
using datasets::Waveform;

Twin two_signals() {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("square", Waveform::square, 2.0, 0.01);
  twin.add("sine", Waveform::sine, 5.0, 0.01);
  return twin;
}

/// Returns the result of a search that claims to have ended at z.
MultiStart claimed_at(const Problem& problem, const std::vector<double>& z) {
  MultiStart found;
  found.best = 1;
  found.starts.resize(1);
  found.optimum = evaluate_at(problem, z, 1);
  found.result.status = FitStatus::converged;
  return found;
}

}  // namespace

TEST_CASE("verify: a claimed end that is no minimum is solved on from", "[calib]") {
  const Twin twin = two_signals();
  const auto records = twin.records(1000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  MultiStart found = claimed_at(problem, problem.start());
  Budget budget;
  Evaluator evaluator(problem, budget);
  const auto rows = verify_optimum(problem, evaluator, {}, found);
  CHECK(found.result.status == FitStatus::converged);
  CHECK(found.result.iterations > 0);
  CHECK(found.result.check.stationary());
  Budget of_other;
  Evaluator other(problem, of_other);
  const FitOptions options;
  REQUIRE(Search(problem, other, options).run(problem.start()).status == FitStatus::converged);
  CHECK_THAT(found.optimum.cost, WithinRel(other.best().cost, 1e-5));
  REQUIRE(rows.size() == 2);
  double squares = 0.0;
  for (const ConditionRows& each : rows) squares += 0.5 * each.residual.squaredNorm();
  CHECK_THAT(squares, WithinRel(found.optimum.cost, 1e-12));
  CHECK(found.starts[0].final_cost == found.optimum.cost);
  CHECK(found.starts[0].status == FitStatus::converged);
}

TEST_CASE("verify: an end that a checkpoint brings back is judged, too", "[calib]") {
  const Twin twin = two_signals();
  const auto records = twin.records(1000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  Budget budget;
  Evaluator evaluator(problem, budget);
  MultiStart found = multi_start(problem, evaluator, {});
  std::vector<double> off = found.optimum.z;
  off[0] += 1e-3;
  found.optimum = evaluate_at(problem, off, 1);
  REQUIRE(check_optimum(problem, found.optimum).relative_offset > 0.1);
  verify_optimum(problem, evaluator, {}, found);
  CHECK(found.result.status == FitStatus::converged);
  CHECK(found.result.check.is_minimum());
}

TEST_CASE("verify: where there is no time left to make it good, it is not called converged",
          "[calib]") {
  const Twin twin = two_signals();
  const auto records = twin.records(1000, 1000.0, 1);
  const Problem problem = problem_of(twin, records);
  MultiStart found = claimed_at(problem, problem.start());
  Budget options(nullptr, {}, {}, 1);
  Evaluator evaluator(problem, options);
  verify_optimum(problem, evaluator, {}, found);
  CHECK(found.result.status == FitStatus::stopped);
  CHECK_THAT(found.result.message, Contains("evaluations"));
}

TEST_CASE(
    "fit: stopped after any number of evaluations it gives intervals that it calls unreliable",
    "[calib]") {
  const Twin twin = two_signals();
  const auto records = twin.records(1000, 1000.0, 1);
  FitOptions options;
  long& most = options.max_evaluations.emplace(1);
  const Problem problem = problem_of(twin, records);
  const double at_start = evaluate_at(problem, problem.start(), 1).cost;
  Fit found = fit(twin.campaign, records, options);
  for (; found.status != FitStatus::converged && most < 100;
       found = fit(twin.campaign, records, options)) {
    CAPTURE(most);
    CHECK(found.status == FitStatus::stopped);
    CHECK(found.cost <= at_start);
    CHECK_THAT(found.interval_advice, Contains("no interval is reliable"));
    REQUIRE(found.parameters.size() >= 2);
    for (const FittedParameter& each : {found.parameters[0], found.parameters[1]}) {
      REQUIRE(each.ci95);
      CHECK(std::isfinite(each.ci95->low));
      CHECK(std::isfinite(each.ci95->high));
    }
    ++most;
  }
  CHECK(most > 5);
  CHECK_THAT(found.interval_advice, !Contains("no interval is reliable"));
}

TEST_CASE("fit: its cost is that of simulations at the values it gives", "[calib]") {
  const Twin twin = two_signals();
  const auto records = twin.records(1000, 1000.0, 1);
  const Fit found = fit(twin.campaign, records, {});
  REQUIRE(found.status == FitStatus::converged);
  const Problem problem = problem_of(twin, records);
  std::vector<double> z;
  for (const FittedParameter& each : found.parameters) {
    if (each.fitted) z.push_back(problem.map.to_unit(static_cast<int>(z.size()), each.value));
  }
  const Evaluation there = evaluate_at(problem, z, 1);
  CHECK_THAT(there.cost, WithinRel(found.cost, 1e-9));
  CHECK(check_optimum(problem, there).is_minimum());
}

}  // namespace rigcal::calib
