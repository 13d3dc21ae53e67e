#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "datasets/read/csv/load_csv.hpp"

namespace rigcal::bench {
namespace {

void load_csv_4_columns(benchmark::State& state) {
  const auto path = std::filesystem::temp_directory_path() / "rigcal_bench.csv";
  {
    std::ofstream file(path);
    file << "t_s,ref_mm,x_mm,p_bar\n";
    for (long k = 0; k < state.range(0); ++k) {
      const double t = static_cast<double>(k) * 1e-3;
      file << fmt::format("{:.3f},{:.4f},{:.4f},{:.2f}\n", t, std::sin(t), std::cos(t), 60.0 * t);
    }
  }
  const datasets::RecordRequest request{{"t_s", "ref_mm", "x_mm", "p_bar"}, "t_s"};
  for (auto _ : state) {
    const datasets::RecordTable table = datasets::load_csv_record(path, request);
    benchmark::DoNotOptimize(table.columns.data());
  }
  state.counters["rows_per_s"] = benchmark::Counter(static_cast<double>(state.range(0)),
                                                    benchmark::Counter::kIsIterationInvariantRate);
  std::filesystem::remove(path);
}
BENCHMARK(load_csv_4_columns)->Arg(100'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rigcal::bench
