// Measures the cost of one evaluation of a campaign's fitted conditions at their start values:
//
//   rigcal_evaluations CAMPAIGN DATA TOLERANCE ROUNDS
//
// Prints a line without derivatives and one with them: steps of the solver (rejected ones count),
// the least CPU time of the simulations and of the whole evaluation, and the sum of all outputs,
// which shows whether two programs compute the same bits. It uses only what commit 17fc680 has,
// too, so that it can be compiled there (docs/quality.md, "Beside an older version").
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "bench/clock.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "common/memory.hpp"
#include "datasets/prepare/load_record.hpp"

namespace rigcal::bench {
namespace {

void print_cost(const calib::Problem& problem, bool derivatives, int rounds) {
  const calib::Fidelity fidelity{derivatives, true};
  const std::vector<double> z = problem.start();
  double simulation_ms = std::numeric_limits<double>::infinity();
  double evaluation_ms = std::numeric_limits<double>::infinity();
  long steps = 0;
  double sum = 0.0;
  for (int round = 0; round < rounds; ++round) {
    steps = 0;
    sum = 0.0;
    double began = cpu_ms();
    for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
      const auto run = calib::simulate_condition(problem, i, z, nullptr, fidelity);
      steps += run.steps + run.rejected_steps;
      if (run.outputs.size() > 0) sum += run.outputs.sum();
    }
    simulation_ms = std::min(simulation_ms, cpu_ms() - began);
    began = cpu_ms();
    for (std::size_t i = 0; i < problem.conditions.size(); ++i)
      calib::evaluate_condition(problem, i, z, nullptr, nullptr, fidelity);
    evaluation_ms = std::min(evaluation_ms, cpu_ms() - began);
  }
  std::printf("%s derivatives: %ld steps, simulations %.3f ms, evaluation %.3f ms, sum %.17g\n",
              derivatives ? "with" : "without", steps, simulation_ms, evaluation_ms, sum);
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() != 4) {
    std::fprintf(stderr, "usage: rigcal_evaluations CAMPAIGN DATA TOLERANCE ROUNDS\n");
    return EXIT_FAILURE;
  }
  rigcal::keep_freed_memory();
  auto campaign = rigcal::datasets::load_campaign(words[0], words[1]);
  campaign.simulation.tolerance = std::stod(words[2]);
  const auto records =
      rigcal::datasets::load_records(campaign, {rigcal::datasets::Use::fit}, 1, true);
  std::vector<const rigcal::datasets::Condition*> fitted;
  for (const auto& each : campaign.conditions)
    if (each.use == rigcal::datasets::Use::fit) fitted.push_back(&each);
  const auto problem = rigcal::calib::make_problem(campaign, records, fitted, false, nullptr);
  for (const bool derivatives : {false, true})
    rigcal::bench::print_cost(problem, derivatives, std::stoi(words[3]));
  return EXIT_SUCCESS;
}
