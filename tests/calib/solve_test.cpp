#include "calib/solve.hpp"

#include <atomic>
#include <catch2/catch.hpp>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {

TEST_CASE("solve: errors that a signal cut short make no converged fit", "[calib]") {
  Twin twin;
  twin.free("mass", 60.0, 10.0, 500.0);
  twin.free("valve_gain", 0.03e-3, 0.01e-3, 0.2e-3);
  twin.add("sine", datasets::Waveform::sine, 2.0, 0.01);
  const auto records = twin.records(150, 500.0, 3);
  const auto solved = [&](bool late) {
    const std::atomic<bool> stop{false};
    const std::atomic<bool> raised{late};
    Problem problem = problem_of(twin, records);
    problem.cancel = &raised;
    Budget budget(&stop);  // the search itself is left alone
    Evaluator evaluator(problem, budget);
    evaluator.keep_rows();
    Fit fit;
    solve_problem(problem, evaluator, {}, fit);
    return fit;
  };
  const Fit whole = solved(false);
  CHECK(whole.status == FitStatus::converged);
  const Fit cut = solved(true);
  CHECK(cut.status == FitStatus::stopped);
  CHECK_THAT(cut.message, Catch::Contains("stopped on request before its uncertainty"));
  REQUIRE(cut.parameters.size() == 2);
  for (std::size_t j = 0; j < 2; ++j) {
    CHECK(cut.parameters[j].value == whole.parameters.at(j).value);
    CHECK(whole.parameters[j].identifiability == Identifiability::identified);
    CHECK(cut.parameters[j].identifiability == Identifiability::not_identifiable);
    CHECK_THAT(cut.parameters[j].reason, Catch::StartsWith("not judged: the search was stopped"));
  }
}

}  // namespace rigcal::calib
