#include <benchmark/benchmark.h>

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <numbers>

#include "datasets/prepare/average.hpp"

namespace rigcal::bench {
namespace {

/// Averages five repeats of a 1 Hz sine sampled at 1 kHz, each with its own noise and start time.
void average_five_repeats(benchmark::State& state) {
  boost::random::mt19937_64 engine(1);
  boost::random::normal_distribution<double> normal;
  std::vector<datasets::Repeat> repeats;
  for (int r = 0; r < 5; ++r) {
    datasets::Repeat repeat;
    repeat.source = "repeat " + std::to_string(r);
    const double offset_s = 1e-3 * normal(engine);
    std::vector<double> position;
    for (long k = 0; k < state.range(0); ++k) {
      const double t = static_cast<double>(k) * 1e-3;
      repeat.time_s.push_back(t);
      position.push_back(0.02 * std::sin(2.0 * std::numbers::pi * (t - offset_s)) +
                         5e-5 * normal(engine));
    }
    repeat.values[datasets::Channel::position] = position;
    repeats.push_back(repeat);
  }
  for (auto _ : state) {
    const datasets::Record record = datasets::average("bench", repeats, {});
    benchmark::DoNotOptimize(record.channels.size());
  }
}
BENCHMARK(average_five_repeats)->Arg(10'000)->Arg(100'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rigcal::bench
