#include <benchmark/benchmark.h>

#include "bench/problems.hpp"

namespace rigcal::bench {
namespace {

/// Simulates the six signals once, with a tolerance of 1e-6.
void sweep(benchmark::State& state, const std::vector<const char*>& free_keys,
           model::Method method) {
  const model::ParameterValues values = six_signal_truth();
  std::vector<int> free;
  for (const char* key : free_keys) free.push_back(model::parameter_index(values.plant, key));
  std::vector<std::vector<double>> times;
  for (const Reference& signal : kSixSignals) times.push_back(sample_times(signal));
  model::SimulationOptions options;
  options.method = method;
  const std::vector<model::Output> outputs{model::Output::position};
  long steps = 0;
  for (auto _ : state) {
    steps = 0;
    for (std::size_t i = 0; i < kSixSignals.size(); ++i) {
      const auto run =
          model::simulate({}, values, free, inputs(kSixSignals[i]), times[i], outputs, options);
      if (!run.ok()) {
        state.SkipWithError(run.reason.c_str());
        return;
      }
      steps += run.steps + run.rejected_steps;
      benchmark::DoNotOptimize(run.outputs.data());
    }
  }
  state.counters["steps"] = static_cast<double>(steps);
}

const std::vector<const char*> kFour{"mass", "bulk_modulus", "valve_gain", "leakage_coefficient"};

BENCHMARK_CAPTURE(sweep, rosenbrock, {}, model::Method::rosenbrock)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sweep, rosenbrock_four_sensitivities, kFour, model::Method::rosenbrock)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sweep, dopri5, {}, model::Method::dopri5)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(sweep, dopri5_four_sensitivities, kFour, model::Method::dopri5)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rigcal::bench
