#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/campaign/design/design_settings.hpp"

namespace rigcal::calib {

/// The samples of a test and what its drive may contain.
struct DriveGrid {
  std::size_t samples = 0;
  double rate_hz = 0.0;
  double lowest_hz = 0.0;
  double highest_hz = 0.0;

  double duration_s() const { return static_cast<double>(samples - 1) / rate_hz; }
};

/// Default band: from two periods in the test to ten samples per period.
DriveGrid drive_grid(const datasets::DesignSettings& settings);

/// One number of a drive, as results name it.
struct DrivePart {
  std::string name;  ///< "frequency 1", "bit time"
  std::string unit;  ///< SI
  double value = 0.0;
  RIGCAL_DESCRIBE(name, unit, value)
};

/// A drive as a share of its largest allowed distance from where it begins.
struct DriveShape {
  std::vector<double> values;  ///< shape (samples), in [-1, 1]; begins and ends at 0
  std::vector<DrivePart> parts;
  /// Factor that the search chose in addition: information need not grow with amplitude.
  double share = 1.0;
};

/// Coordinates that describe a drive of this family.
Eigen::Index drive_coordinates(datasets::DriveFamily family);

/// The drive at a point of the unit box:
///   multisine  five sines, each with frequency, amplitude and phase;
///   chirp      frequency and amplitude at either end, logarithmic between them;
///   steps      eight levels that each last as long as they choose, and the time of rise;
///   prbs       the time of a bit and of a rise, and where the sequence of x^11 + x^9 + 1 begins.
/// Two further coordinates are the share of the allowed amplitude and the offset of the drive. It
/// rises from its beginning within a twentieth of the test, and returns there at the end.
///
/// @param point  shape (coordinates), in [0, 1]
DriveShape drive_shape(datasets::DriveFamily family, const Eigen::VectorXd& point,
                       const DriveGrid& grid);

}  // namespace rigcal::calib
