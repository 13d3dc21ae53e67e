#include "datasets/checks/stuck_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "datasets/checks/median.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kParts = 4;
constexpr double kTenth = 0.1;

double range(std::span<const double> x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

// Thresholds for the row "a clipped sensor" in docs/campaign-records.md. The test has records on
// both sides of them.
constexpr std::size_t kShortestClip = 3;
constexpr std::size_t kFewestClipped = 8;
constexpr double kClipDriveMotion = 0.005;
constexpr int kClipPassages = 2;
constexpr std::size_t kBesideDip = 3;
constexpr double kDepth = 3.0;
constexpr std::size_t kFewestDips = 10;
constexpr double kShareOfStep = 0.5;
constexpr double kFallSteps = 2.0;  // a single step may be converter rounding

/// Returns the mean length of the runs between the extremes, in samples. It is above 1 if a
/// converter repeats its samples.
double typical_length(const std::vector<EqualRun>& runs, double low, double high) {
  std::size_t count = 0;
  std::size_t samples = 0;
  for (const EqualRun& run : runs) {
    if (run.value <= low || run.value >= high) continue;
    ++count;
    samples += run.length;
  }
  return count == 0 ? 1.0 : static_cast<double>(samples) / static_cast<double>(count);
}

/// Whether the signal leaves its extreme value by at least three steps of the resolution and
/// returns within three samples, at least ten times. This is how noise behaves that is cut off on
/// one side.
bool noise_is_cut(const std::vector<EqualRun>& runs, double extreme, double smallest) {
  std::size_t dips = 0;
  std::size_t last = runs.size();  // index of the last run at the extreme
  double depth = 0.0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (runs[k].value != extreme) {
      depth = std::max(depth, std::abs(runs[k].value - extreme));
      continue;
    }
    if (last < runs.size() && runs[k].begin - runs[last].end() <= kBesideDip &&
        depth > 0.97 * kDepth * smallest)  // allows for rounding of the resolution
      ++dips;
    last = k;
    depth = 0.0;
  }
  return dips >= kFewestDips;
}

/// Returns how far a parabola falls next to its flat top, in steps of the resolution. If n samples
/// at the top look equal, the parabola falls by one step within n/2 samples of the top, and by
/// another (12/n + 36/n^2) steps within the next three samples.
double flat_top_fall(std::size_t length) {
  const auto n = static_cast<double>(length);
  return 12.0 / n + 36.0 / (n * n);
}

// Thresholds for the row "an interrupted sensor" in docs/campaign-records.md. The test has records
// on both sides of them.
constexpr std::size_t kShortestFreeze = 16;
constexpr double kFreezeDriveMotion = 0.1;
constexpr int kFreezePassages = 2;
constexpr double kStandSteps = 4.0;

/// Returns the mean length of the runs in samples, without the run in question.
double length_of_others(std::size_t samples, std::size_t runs, const EqualRun& left_out) {
  return static_cast<double>(samples - left_out.length) / static_cast<double>(runs - 1);
}

}  // namespace

double drive_motion(std::span<const double> drive, const EqualRun& run) {
  const double whole = range(drive);
  if (!(whole > 0.0)) return 0.0;
  const auto part = drive.subspan(run.begin, run.length);
  if (part.size() < 2 * kParts) return range(part) / whole;
  std::vector<double> medians;
  for (std::size_t k = 0; k < kParts; ++k) {
    const std::size_t begin = k * part.size() / kParts;
    const std::size_t end = (k + 1) * part.size() / kParts;
    const auto own = part.subspan(begin, end - begin);
    medians.push_back(median({own.begin(), own.end()}));
  }
  return range(medians) / whole;
}

int drive_passages(std::span<const double> drive, const EqualRun& run) {
  const auto [low, high] = std::minmax_element(drive.begin(), drive.end());
  const double near = kTenth * (*high - *low);
  if (!(near > 0.0)) return 0;
  int passages = 0;
  int side = 0;
  for (const double value : drive.subspan(run.begin, run.length)) {
    const int now = value <= *low + near ? -1 : value >= *high - near ? 1 : 0;
    if (now == 0) continue;
    if (side != 0 && now != side) ++passages;
    side = now;
  }
  return passages;
}

std::vector<EqualRun> clipped_runs(std::span<const double> x, std::span<const double> drive,
                                   RangeEnd end) {
  std::vector<EqualRun> found;
  const std::vector<EqualRun> runs = equal_runs(x);
  if (runs.size() < 2 || drive.size() != x.size()) return found;
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double extreme = end == RangeEnd::lowest ? *low : *high;
  const double shortest = static_cast<double>(kShortestClip) * typical_length(runs, *low, *high);
  std::vector<EqualRun> long_enough;
  for (const EqualRun& run : runs)
    if (run.value == extreme && !(static_cast<double>(run.length) < shortest))
      long_enough.push_back(run);
  // Most signals return here. The checks below cost more than everything above.
  if (long_enough.empty()) return found;
  const bool noisy = shows_noise(runs, *low, *high);
  const double step = typical_step(runs);
  const double smallest = resolution(runs);
  const bool cut = noise_is_cut(runs, extreme, smallest);
  for (const EqualRun& run : long_enough) {
    if (cut) {
      found.push_back(run);
      continue;
    }
    const double least =
        std::max(kShareOfStep * step, (kFallSteps + flat_top_fall(run.length)) * smallest);
    if (!noisy && !cuts_a_motion(x, run, least)) continue;
    if (drive_motion(drive, run) >= kClipDriveMotion && drive_passages(drive, run) < kClipPassages)
      found.push_back(run);
  }
  const std::size_t samples =
      std::accumulate(found.begin(), found.end(), std::size_t{0},
                      [](std::size_t sum, const EqualRun& run) { return sum + run.length; });
  if (samples < kFewestClipped) found.clear();
  return found;
}

std::vector<EqualRun> frozen_runs(std::span<const double> x, std::span<const double> drive) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<EqualRun> found;
  const std::vector<EqualRun> runs = equal_runs(x);
  if (runs.size() < 2 || drive.size() != x.size()) return found;
  std::vector<EqualRun> long_enough;
  for (const EqualRun& run : runs)
    if (!(static_cast<double>(run.length) <
          static_cast<double>(kShortestFreeze) * length_of_others(x.size(), runs.size(), run)))
      long_enough.push_back(run);
  // Most signals return here. The checks below cost more than everything above.
  if (long_enough.empty()) return found;
  const bool noisy = shows_noise(runs, -kInfinity, kInfinity);
  const double least = std::max(typical_step(runs), kStandSteps * resolution(runs));
  for (const EqualRun& run : long_enough) {
    if ((noisy && drive_motion(drive, run) >= kFreezeDriveMotion) ||
        (drive_passages(drive, run) >= kFreezePassages && cuts_a_motion(x, run, least)))
      found.push_back(run);
  }
  return found;
}

}  // namespace rigcal::datasets
