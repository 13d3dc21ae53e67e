#include "diagnosis/table/period_grid.hpp"

#include "metrics/mean_absolute.hpp"

namespace rigcal::diagnosis {
namespace {

/// Distance between the last sample of a piece and the next jump, as a fraction of a piece. The
/// simulation treats times closer than 1e-9 s as equal.
constexpr double kBeforeJump = 1e-7;
/// Weight of the equidistant component in the spacing of samples for a square.
constexpr double kUniform = 0.01;

std::vector<double> every(std::span<const double> all, std::size_t first, std::size_t count,
                          std::size_t stride) {
  std::vector<double> chosen;
  chosen.reserve(count / stride + 1);
  for (std::size_t i = 0; i < count; i += stride) chosen.push_back(all[first + i]);
  return chosen;
}

}  // namespace

PeriodGrid period_grid(datasets::Waveform waveform, double period_s, int intervals) {
  PeriodGrid grid;
  grid.pieces = static_cast<std::size_t>(datasets::info(waveform).pieces);
  const bool jumps = grid.pieces > 1;
  const double piece_s = period_s / static_cast<double>(grid.pieces);
  for (std::size_t p = 0; p < grid.pieces; ++p) {
    for (int i = 0; i <= intervals; ++i) {
      // Samples are dense just after a jump, but not so dense that times become equal.
      const double s = static_cast<double>(i) / intervals;
      const double place = jumps ? (s * s * s + kUniform * s) / (1.0 + kUniform) : s;
      grid.offset_s.push_back(piece_s * (static_cast<double>(p) + place * (1.0 - kBeforeJump)));
    }
  }
  return grid;
}

double mean_absolute(const PeriodGrid& grid, std::span<const double> signal, std::size_t stride) {
  const std::size_t count = grid.offset_s.size() / grid.pieces;
  double sum = 0.0;
  for (std::size_t p = 0; p < grid.pieces; ++p) {
    sum += metrics::mean_absolute(every(grid.offset_s, p * count, count, stride),
                                  every(signal, p * count, count, stride));
  }
  return sum / static_cast<double>(grid.pieces);
}

double mean_absolute_slope(const PeriodGrid& grid, std::span<const double> signal,
                           std::span<const double> signal_slope) {
  const std::size_t count = grid.offset_s.size() / grid.pieces;
  double sum = 0.0;
  for (std::size_t p = 0; p < grid.pieces; ++p) {
    sum += metrics::mean_absolute_slope(std::span(grid.offset_s).subspan(p * count, count),
                                        signal.subspan(p * count, count),
                                        signal_slope.subspan(p * count, count));
  }
  return sum / static_cast<double>(grid.pieces);
}

}  // namespace rigcal::diagnosis
