#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/describe.hpp"
#include "common/error.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Quantity that `plan --design` minimizes.
enum class DesignCriterion {
  determinant,  ///< volume of the confidence ellipsoid of the named parameters (Ds-optimal)
  worst,        ///< largest relative interval of these parameters
};
RIGCAL_NAMES(DesignCriterion, determinant, worst)

/// Kinds of drives to try.
enum class DriveFamily { multisine, chirp, steps, prbs };
RIGCAL_NAMES(DriveFamily, multisine, chirp, steps, prbs)

/// A limit for the rig during the test, SI, with its place in the campaign file.
struct StatedLimit {
  double value = 0.0;
  Location where;
};

/// [design]: requirements for the test that `plan --design` searches for. Limits that are not
/// stated are not checked.
struct DesignSettings {
  StatedLimit lowest_m, highest_m;  ///< `stroke`: range of the piston
  std::optional<StatedLimit> speed_m_per_s;
  std::optional<StatedLimit> acceleration_m_per_s2;
  std::optional<StatedLimit> command_v;
  std::optional<StatedLimit> flow_m3_per_s;
  /// Largest distance of the drive from its first value, in the SI unit of its channel. Absent: up
  /// to the end of the stroke, or to the limit of the command.
  std::optional<StatedLimit> amplitude;
  double duration_s = 0.0;
  double sample_rate_hz = 0.0;
  std::optional<std::pair<double, double>> band_hz;  ///< frequencies of the drive
  DesignCriterion criterion = DesignCriterion::determinant;
  std::optional<DriveFamily> family;  ///< absent: the best of all families
  int repeats = 5;                    ///< number of planned repeats
  int evaluations = 200;              ///< drives tried in each family
  std::uint64_t seed = 1;
  std::map<Channel, double> noise_sd;  ///< noise per sample in one repeat, SI
  /// Condition from which the test takes leak level, known values and machine; absent: the rig's.
  std::optional<std::string> like;
  Location where;

  std::size_t samples() const;
};

}  // namespace rigcal::datasets
