#include "calib/design/drive_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace rigcal::calib {
namespace {

using datasets::DriveFamily;

constexpr Eigen::Index kCommon = 2;  // fraction of the amplitude, and offset
constexpr Eigen::Index kSines = 5;
constexpr Eigen::Index kLevels = 8;
constexpr double kLeastAmplitude = 0.1;
constexpr double kLeastComponent = 0.01;  // relative to the largest sine amplitude
constexpr double kTaper = 0.05;           // fraction of the test at each end
constexpr double kShortestLevel = 0.2;    // relative to the longest level
constexpr unsigned kRegisterBits = 11;
constexpr std::size_t kSequence = (1U << kRegisterBits) - 1U;

/// Interpolates between two positive numbers on a logarithmic scale.
double between(double low, double high, double coordinate) {
  return low * std::pow(high / low, coordinate);
}

/// Hands out the coordinates of a drive one after the other.
class DriveNumbers {
 public:
  explicit DriveNumbers(const Eigen::VectorXd& values) : values_(values) {}
  double next() { return values_(at_++); }

 private:
  const Eigen::VectorXd& values_;
  Eigen::Index at_ = 0;
};

double time_at(const DriveGrid& grid, std::size_t sample) {
  return static_cast<double>(sample) / grid.rate_hz;
}

std::vector<double> multisine(DriveNumbers& point, const DriveGrid& grid,
                              std::vector<DrivePart>& parts) {
  std::vector<double> values(grid.samples, 0.0);
  for (Eigen::Index k = 1; k <= kSines; ++k) {
    const double frequency_hz = between(grid.lowest_hz, grid.highest_hz, point.next());
    const double amplitude = between(kLeastComponent, 1.0, point.next());
    const double phase = 2.0 * std::numbers::pi * point.next();
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] +=
          amplitude * std::sin(2.0 * std::numbers::pi * frequency_hz * time_at(grid, i) + phase);
    parts.push_back({fmt::format("frequency {}", k), "Hz", frequency_hz});
    parts.push_back({fmt::format("relative amplitude {}", k), "1", amplitude});
    parts.push_back({fmt::format("phase {}", k), "rad", phase});
  }
  return values;
}

std::vector<double> swept(DriveNumbers& point, const DriveGrid& grid,
                          std::vector<DrivePart>& parts) {
  const double first_hz = between(grid.lowest_hz, grid.highest_hz, point.next());
  const double last_hz = between(grid.lowest_hz, grid.highest_hz, point.next());
  const double first = between(kLeastComponent, 1.0, point.next());
  const double last = between(kLeastComponent, 1.0, point.next());
  const double end_s = grid.duration_s();
  const double octaves = std::log(last_hz / first_hz);
  std::vector<double> values(grid.samples);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double share = time_at(grid, i) / end_s;
    // Integral of f0 exp(octaves t / T). For equal frequencies it is the phase of a sine.
    const double grown = std::abs(octaves) < 1e-9 ? share : std::expm1(octaves * share) / octaves;
    values[i] =
        between(first, last, share) * std::sin(2.0 * std::numbers::pi * first_hz * end_s * grown);
  }
  parts.push_back({"first frequency", "Hz", first_hz});
  parts.push_back({"last frequency", "Hz", last_hz});
  parts.push_back({"first amplitude over the last", "1", first / last});
  return values;
}

/// Generates a sequence of levels. Each is reached from the previous one along a straight line that
/// begins at its edge.
std::vector<double> ramped(const std::vector<double>& edges_s, const std::vector<double>& levels,
                           double rise_s, const DriveGrid& grid) {
  std::vector<double> values(grid.samples);
  std::size_t now = 0;
  double from = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = time_at(grid, i);
    while (now + 1 < levels.size() && t >= edges_s[now + 1]) from = levels[now++];
    const double share = std::min(1.0, (t - edges_s[now]) / rise_s);
    values[i] = from + (levels[now] - from) * share;
  }
  return values;
}

std::vector<double> stepped(DriveNumbers& point, const DriveGrid& grid,
                            std::vector<DrivePart>& parts) {
  std::vector<double> levels(kLevels);
  std::vector<double> lengths(kLevels);
  double total = 0.0;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    levels[k] = 2.0 * point.next() - 1.0;
    lengths[k] = kShortestLevel + (1.0 - kShortestLevel) * point.next();
    total += lengths[k];
  }
  std::vector<double> edges_s(kLevels);
  double at_s = 0.0;
  double shortest_s = grid.duration_s();
  for (std::size_t k = 0; k < edges_s.size(); ++k) {
    edges_s[k] = at_s;
    const double length_s = grid.duration_s() * lengths[k] / total;
    shortest_s = std::min(shortest_s, length_s);
    at_s += length_s;
    parts.push_back({fmt::format("level {}", k + 1), "1", levels[k]});
    parts.push_back({fmt::format("length {}", k + 1), "s", length_s});
  }
  const double rise_s = between(1.0 / grid.rate_hz, shortest_s, point.next());
  parts.push_back({"rise time", "s", rise_s});
  return ramped(edges_s, levels, rise_s, grid);
}

/// Returns the maximum-length sequence of x^11 + x^9 + 1 as -1 and 1.
const std::array<double, kSequence>& sequence() {
  static const std::array<double, kSequence> bits = [] {
    std::array<double, kSequence> made{};
    std::uint32_t state = 1;
    for (double& bit : made) {
      bit = (state & 1U) != 0 ? 1.0 : -1.0;
      const std::uint32_t fed = (state ^ (state >> 2U)) & 1U;
      state = (state >> 1U) | (fed << (kRegisterBits - 1U));
    }
    return made;
  }();
  return bits;
}

std::vector<double> pseudo_random(DriveNumbers& point, const DriveGrid& grid,
                                  std::vector<DrivePart>& parts) {
  constexpr double kFewestBits = 8.0;
  const double shortest_s = 0.5 / grid.highest_hz;
  const double longest_s = std::max(grid.duration_s() / kFewestBits, 2.0 * shortest_s);
  const double bit_s = between(shortest_s, longest_s, point.next());
  const double rise_s = between(std::min(1.0 / grid.rate_hz, 0.5 * bit_s), bit_s, point.next());
  const auto first = std::min(static_cast<std::size_t>(point.next() * kSequence), kSequence - 1);
  std::vector<double> edges_s;
  std::vector<double> levels;
  for (double t = 0.0; t <= grid.duration_s(); t = bit_s * static_cast<double>(edges_s.size())) {
    levels.push_back(sequence()[(first + edges_s.size()) % kSequence]);
    edges_s.push_back(t);
  }
  parts.push_back({"bit time", "s", bit_s});
  parts.push_back({"rise time", "s", rise_s});
  parts.push_back({"first bit", "1", static_cast<double>(first)});
  return ramped(edges_s, levels, rise_s, grid);
}

/// A window that rises from 0 to 1 and falls back to 0 without corners.
double window(double share) {
  const double nearest = std::min({share, 1.0 - share, kTaper}) / kTaper;
  return 0.5 - 0.5 * std::cos(std::numbers::pi * std::max(nearest, 0.0));
}

std::vector<double> of_family(DriveFamily family, DriveNumbers& point, const DriveGrid& grid,
                              std::vector<DrivePart>& parts) {
  switch (family) {
    case DriveFamily::multisine:
      return multisine(point, grid, parts);
    case DriveFamily::chirp:
      return swept(point, grid, parts);
    case DriveFamily::steps:
      return stepped(point, grid, parts);
    case DriveFamily::prbs:
      return pseudo_random(point, grid, parts);
  }
  return {};
}

}  // namespace

DriveGrid drive_grid(const datasets::DesignSettings& settings) {
  DriveGrid grid{settings.samples(), settings.sample_rate_hz};
  constexpr double kFewestPeriods = 2.0;
  constexpr double kSamplesPerPeriod = 10.0;
  grid.lowest_hz = kFewestPeriods / grid.duration_s();
  grid.highest_hz = std::max(grid.rate_hz / kSamplesPerPeriod, 2.0 * grid.lowest_hz);
  if (settings.band_hz) std::tie(grid.lowest_hz, grid.highest_hz) = *settings.band_hz;
  return grid;
}

Eigen::Index drive_coordinates(DriveFamily family) {
  switch (family) {
    case DriveFamily::multisine:
      return kCommon + 3 * kSines;
    case DriveFamily::chirp:
      return kCommon + 4;
    case DriveFamily::steps:
      return kCommon + 2 * kLevels + 1;
    case DriveFamily::prbs:
      return kCommon + 3;
  }
  return 0;
}

DriveShape drive_shape(DriveFamily family, const Eigen::VectorXd& point, const DriveGrid& grid) {
  DriveNumbers coordinate(point);
  DriveShape shape;
  shape.share = between(kLeastAmplitude, 1.0, coordinate.next());
  const double offset = 2.0 * coordinate.next() - 1.0;
  shape.values = of_family(family, coordinate, grid, shape.parts);
  double peak = 0.0;
  for (const double value : shape.values) peak = std::max(peak, std::abs(value));
  for (std::size_t i = 0; i < shape.values.size(); ++i) {
    const double own = peak > 0.0 ? shape.values[i] / peak : 0.0;
    const double at = static_cast<double>(i) / static_cast<double>(grid.samples - 1);
    shape.values[i] = window(at) * (offset + (1.0 - std::abs(offset)) * own);
  }
  shape.parts.push_back({"offset over the largest amplitude", "1", offset});
  return shape;
}

}  // namespace rigcal::calib
