#include "datasets/checks/frozen_sensor.hpp"

#include <algorithm>
#include <limits>

#include "datasets/checks/drive_motion.hpp"

namespace rigcal::datasets {
namespace {

// Thresholds for the row "an interrupted sensor" in docs/campaign-records.md. The test has records
// on both sides of them.
constexpr std::size_t kShortestFreeze = 16;
constexpr double kFreezeDriveMotion = 0.1;
constexpr int kFreezePassages = 2;
constexpr double kStandSteps = 4.0;

/// Returns the mean length of the runs in samples, without the run in question.
double typical_length(std::size_t samples, std::size_t runs, const EqualRun& left_out) {
  return static_cast<double>(samples - left_out.length) / static_cast<double>(runs - 1);
}

}  // namespace

std::vector<EqualRun> frozen_runs(std::span<const double> x, std::span<const double> drive) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<EqualRun> found;
  const std::vector<EqualRun> runs = equal_runs(x);
  if (runs.size() < 2 || drive.size() != x.size()) return found;
  std::vector<EqualRun> long_enough;
  for (const EqualRun& run : runs)
    if (!(static_cast<double>(run.length) <
          static_cast<double>(kShortestFreeze) * typical_length(x.size(), runs.size(), run)))
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
