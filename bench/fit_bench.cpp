#include <benchmark/benchmark.h>

#include "bench/problems.hpp"
#include "calib/fit.hpp"

namespace rigcal::bench {
namespace {

void fit_six_signals(benchmark::State& state) {
  const Problem problem = six_signal_problem();
  calib::FitOptions options;
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) {
    const calib::Fit fit = calib::fit(problem.campaign, problem.records, options);
    if (fit.status != calib::FitStatus::converged) {
      state.SkipWithError(fit.message.c_str());
      return;
    }
    state.counters["evaluations"] = static_cast<double>(fit.evaluations);
    benchmark::DoNotOptimize(fit.cost);
  }
}
BENCHMARK(fit_six_signals)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace
}  // namespace rigcal::bench
