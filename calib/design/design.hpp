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

/// One unknown of the designed test. Standard deviations are those of Cramer and Rao, SI; nothing
/// where the test does not determine it.
struct DesignedParameter : TestedParameter {
  bool named = false;  ///< the drive was designed for it
  std::optional<double> sd;
  /// From the campaign's own signals in the same time, noise and number of repeats.
  std::optional<double> sd_own_signals;
  RIGCAL_DESCRIBE(name, unit, scope, level, named, value, sd, sd_own_signals)
};

/// What a family of drives came to.
struct FamilyTrial {
  datasets::DriveFamily family = datasets::DriveFamily::multisine;
  int evaluations = 0;
  bool found = false;  ///< one of them keeps the limits
  /// Standard deviation of each unknown by the best of them, at the accuracy of the search.
  std::vector<std::optional<double>> sd;
  RIGCAL_DESCRIBE(family, evaluations, found, sd)
};

/// A test that keeps the limits of [design], checked by a fine simulation.
struct Design {
  datasets::DriveFamily family = datasets::DriveFamily::multisine;
  std::vector<double> time_s;
  std::vector<double> drive;  ///< SI, as the CSV file has it
  Eigen::MatrixXd response;   ///< limited_outputs() at time_s
  double amplitude = 0.0;     ///< largest distance of the drive from its beginning, SI
  std::vector<DrivePart> parts;
  std::vector<LimitUse> limits;
  std::vector<DesignedParameter> parameters;
  std::vector<FamilyTrial> trials;
  std::map<datasets::Channel, double> noise_sd;  ///< per sample of one repeat, SI
  std::vector<std::string> own_conditions;       ///< the campaign's own signals
  double own_duration_s = 0.0;                   ///< all of them together
  bool stopped = false;                          ///< by the flag: the best drive until then
  std::vector<std::string> messages;
};

struct DesignOptions {
  int threads = 1;
  const std::atomic<bool>* cancel = nullptr;
  /// Called after each generation of drives: family, drives tried in it, drives that it may try.
  std::function<void(datasets::DriveFamily, int, int)> progress = {};
};

/// Looks for the drive that tells most about the named parameters (datasets::DesignSettings); all
/// other unknowns are estimated beside them. The same numbers for any number of threads.
///
/// @param records  of the campaign's own conditions that have one
/// @param names    keys of parameters that are fitted: "bulk_modulus"
/// @param values   of an earlier fit, or null: the campaign's own
/// @throws InputError, UsageError  no [design]; an unknown name, or one that is not fitted; noise
///                     that nothing tells; a limit that the rig breaks at rest
/// @throws NoResultError  the rig cannot be simulated, or no drive that was tried keeps the limits
/// @throws Error  stopped before there was any drive
Design design(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
              const std::vector<std::string>& names,
              const std::vector<datasets::FittedValue>* values, const DesignOptions& options);

}  // namespace rigcal::calib
