#include "datasets/prepare/spikes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "datasets/checks/equal_runs.hpp"
#include "datasets/checks/median.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kFewestForSpikes = 16;
constexpr std::size_t kLongestRun = 2;
constexpr double kDeviations = 10.0;
constexpr double kSteps = 4.0;              // median differences between neighbours
constexpr double kNeighbourFactor = 3.0;    // times the difference between the neighbours
constexpr double kMedianOfNormal = 0.6745;  // median of |N(0, 1)|

/// Signed distance of a run of samples from the line between its neighbours: the smallest and the
/// largest. Both are 0 if the samples are not all on one side of the line.
struct Excursion {
  double least = 0.0;
  double farthest = 0.0;
};

Excursion excursion(const std::vector<double>& x, std::size_t begin, std::size_t length) {
  const double left = x[begin - 1];
  const double right = x[begin + length];
  Excursion result{std::numeric_limits<double>::infinity(), 0.0};
  for (std::size_t k = 0; k < length; ++k) {
    const double share = static_cast<double>(k + 1) / static_cast<double>(length + 1);
    const double off = x[begin + k] - (left + share * (right - left));
    if (k > 0 && (off > 0.0) != (result.farthest > 0.0)) return {};
    if (std::abs(off) < std::abs(result.least)) result.least = off;
    if (std::abs(off) > std::abs(result.farthest)) result.farthest = off;
  }
  return result;
}

/// Returns the distance of a single sample from the line between its neighbours.
double off_line(const std::vector<double>& x, std::size_t i) {
  return std::abs(x[i] - (x[i - 1] + 0.5 * (x[i + 1] - x[i - 1])));
}

/// Returns the excursion above which a run counts as a spike, given the median excursion `off` of
/// single samples.
double limit_by(double off) { return kDeviations * off / kMedianOfNormal; }

/// If a converter is coarser than the noise, the typical step of the record is its step.
double limit_of(const std::vector<double>& x) {
  std::vector<double> off;
  off.reserve(x.size());
  for (std::size_t i = 1; i + 1 < x.size(); ++i) off.push_back(off_line(x, i));
  return std::max(limit_by(median(std::move(off))), kSteps * typical_step(equal_runs(x)));
}

/// Whether the two samples before a run and the two after it agree, compared with their distance
/// from the run. Otherwise the run is part of an edge or an oscillation.
bool stands_alone(const std::vector<double>& x, std::size_t begin, std::size_t length, double off) {
  const std::size_t after = begin + length;
  const auto [low, high] = std::minmax({x[begin - 2], x[begin - 1], x[after], x[after + 1]});
  return std::abs(off) > kNeighbourFactor * (high - low);
}

/// Returns the largest excursion of any isolated run; 0 if there is none.
double largest_alone(const std::vector<double>& x) {
  double largest = 0.0;
  for (std::size_t i = 2; i + 3 < x.size(); ++i) {
    for (std::size_t length = 1; length <= kLongestRun; ++length) {
      const double off = std::abs(excursion(x, i, length).least);
      if (off > largest && stands_alone(x, i, length, off)) largest = off;
    }
  }
  return largest;
}

/// Returns true if an excursion up to `largest` cannot be a spike, judging only by counts. If more
/// than half of the samples give a limit of at least `largest`, the median gives one as well. Most
/// records have no spike, and counting takes a tenth of the time of computing medians.
bool is_usual(const std::vector<double>& x, double largest) {
  std::size_t far = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) far += limit_by(off_line(x, i)) >= largest ? 1 : 0;
  return 2 * far > x.size();
}

}  // namespace

std::vector<Spike> find_spikes(const std::vector<double>& x) {
  std::vector<Spike> spikes;
  if (x.size() < kFewestForSpikes) return spikes;
  if (is_usual(x, largest_alone(x))) return spikes;
  const double limit = limit_of(x);
  if (!(limit > 0.0)) return spikes;
  for (std::size_t i = 2; i + 3 < x.size(); ++i) {
    for (std::size_t length = 1; length <= kLongestRun; ++length) {
      const Excursion off = excursion(x, i, length);
      if (std::abs(off.least) <= limit) continue;
      if (!stands_alone(x, i, length, off.least)) continue;
      spikes.push_back({i, length, off.farthest});
      i += length;
      break;
    }
  }
  return spikes;
}

std::vector<double> without_spikes(std::vector<double> x, const std::vector<Spike>& spikes) {
  for (const Spike& spike : spikes) {
    const double left = x[spike.sample - 1];
    const double right = x[spike.sample + spike.length];
    for (std::size_t k = 0; k < spike.length; ++k) {
      const double share = static_cast<double>(k + 1) / static_cast<double>(spike.length + 1);
      x[spike.sample + k] = left + share * (right - left);
    }
  }
  return x;
}

}  // namespace rigcal::datasets
