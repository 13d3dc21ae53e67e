#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/error.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// What `plan --design` makes small.
enum class DesignCriterion {
  determinant,  ///< volume of the confidence ellipsoid of the named parameters (Ds-optimal)
  worst,        ///< the largest relative interval among them
};
std::string_view to_string(DesignCriterion criterion);

/// Kinds of drives that are tried.
enum class DriveFamily { multisine, chirp, steps, prbs };
inline constexpr std::array kDriveFamilies{DriveFamily::multisine, DriveFamily::chirp,
                                           DriveFamily::steps, DriveFamily::prbs};
std::string_view to_string(DriveFamily family);

/// A limit of the rig during the test, SI, with its place in the campaign file.
struct StatedLimit {
  double value = 0.0;
  Location where;
};

/// [design]: the test that `plan --design` looks for. A limit that is not stated is not checked.
struct DesignSettings {
  StatedLimit lowest_m, highest_m;  ///< `stroke`: where the piston may be
  std::optional<StatedLimit> speed_m_per_s;
  std::optional<StatedLimit> acceleration_m_per_s2;
  std::optional<StatedLimit> command_v;
  std::optional<StatedLimit> flow_m3_per_s;
  /// Largest distance of the drive from where it begins, in the SI unit of its channel. None: up to
  /// the end of the stroke, or to the limit of the command.
  std::optional<StatedLimit> amplitude;
  double duration_s = 0.0;
  double sample_rate_hz = 0.0;
  std::optional<std::pair<double, double>> band_hz;  ///< frequencies of the drive
  DesignCriterion criterion = DesignCriterion::determinant;
  std::optional<DriveFamily> family;  ///< none: the best of all
  int repeats = 5;                    ///< planned ones
  int evaluations = 200;              ///< drives tried in each family
  std::uint64_t seed = 1;
  std::map<Channel, double> noise_sd;  ///< noise of a sample of one repeat, SI
  /// Condition whose leak level, known values and machine the test has; none: those of the rig.
  std::optional<std::string> like;
  Location where;

  /// Samples of the drive.
  std::size_t samples() const;
};

}  // namespace rigcal::datasets
