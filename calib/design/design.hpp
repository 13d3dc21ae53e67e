#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "calib/design/design_limits.hpp"
#include "calib/design/drive_shape.hpp"
#include "calib/trust/information.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// One unknown in the designed test. Standard deviations are Cramer-Rao bounds, SI; absent if the
/// test does not determine the unknown.
struct DesignedParameter : TestedParameter {
  bool named = false;  ///< true if the drive was designed for this parameter
  std::optional<double> sd;
  /// Standard deviation that the campaign's own signals would give with the same total time, noise
  /// and number of repeats.
  std::optional<double> sd_own_signals;
  RIGCAL_DESCRIBE(name, unit, scope, level, named, value, sd, sd_own_signals)
};

/// Result of the search within one family of drives.
struct FamilyTrial {
  datasets::DriveFamily family = datasets::DriveFamily::multisine;
  int evaluations = 0;
  bool found = false;  ///< true if any of the drives keeps the limits
  /// Standard deviation of each unknown with the best drive. Its accuracy is only that of the
  /// search.
  std::vector<std::optional<double>> sd;
  RIGCAL_DESCRIBE(family, evaluations, found, sd)
};

/// A designed test as result files describe it, SI.
struct DesignedTest {
  datasets::DriveFamily family = datasets::DriveFamily::multisine;
  double amplitude = 0.0;  ///< largest distance of the drive from its first value
  std::vector<DesignedParameter> parameters;
  std::vector<DrivePart> drive;  ///< what the drive is made of
  std::vector<FamilyTrial> families;
  std::vector<std::string> own_signals;  ///< conditions with the campaign's own signals
  double own_signals_duration_s = 0.0;   ///< total duration of these conditions
  std::vector<std::string> messages;
};

/// A test that keeps the limits in [design], checked with a fine simulation.
struct Design : DesignedTest {
  std::vector<double> time_s;
  std::vector<double> samples;  ///< the drive as written to the CSV file, SI
  Eigen::MatrixXd response;     ///< values of limited_outputs() at time_s
  std::vector<LimitUse> limits;
  std::map<datasets::Channel, double> noise_sd;  ///< noise in one sample of one repeat, SI
  bool stopped = false;  ///< true if the search was cancelled; the drive is the best so far
};

struct DesignOptions {
  int threads = 1;
  const std::atomic<bool>* cancel = nullptr;
  /// Called after each generation with the family, the number of its drives that have been tried,
  /// and the number that may be tried.
  std::function<void(datasets::DriveFamily, int, int)> progress = {};
};

/// Searches for the drive that is most informative about the named parameters
/// (datasets::DesignSettings) when all other unknowns are estimated at the same time. The result is
/// the same for any number of threads.
///
/// @param records  records of the campaign's own conditions, if there are any
/// @param names    keys of fitted parameters, such as "bulk_modulus"
/// @param values   values from an earlier fit, or null to use those of the campaign
/// @throws InputError, UsageError  if there is no [design], a name is unknown or not fitted, no
///                                 record determines the noise, or the rig exceeds a limit at rest
/// @throws NoResultError           if the rig cannot be simulated, or none of the tried drives
///                                 keeps the limits
/// @throws Error                   if the search was stopped before it had found any drive
Design design(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
              const std::vector<std::string>& names,
              const std::vector<datasets::FittedValue>* values, const DesignOptions& options);

}  // namespace rigcal::calib
