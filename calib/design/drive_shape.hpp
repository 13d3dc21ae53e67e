#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "datasets/campaign/design/design_settings.hpp"

namespace rigcal::calib {

/// Sample times of a test, and the frequency band of its drive.
struct DriveGrid {
  std::size_t samples = 0;
  double rate_hz = 0.0;
  double lowest_hz = 0.0;
  double highest_hz = 0.0;

  double duration_s() const { return static_cast<double>(samples - 1) / rate_hz; }
};

/// Returns the grid for the settings. By default, the band extends from the frequency with two
/// periods in the test to the frequency with ten samples per period.
DriveGrid drive_grid(const datasets::DesignSettings& settings);

/// One of the numbers that describe a drive, as named in results.
struct DrivePart {
  std::string name;  ///< such as "frequency 1" or "bit time"
  std::string unit;  ///< SI unit of `value`
  double value = 0.0;
  RIGCAL_DESCRIBE(name, unit, value)
};

/// A drive, relative to the largest distance from its first value that is allowed.
struct DriveShape {
  std::vector<double> values;  ///< shape (samples), in [-1, 1]; begins and ends at 0
  std::vector<DrivePart> parts;
  /// Additional factor on the amplitude. The search chooses it, because more amplitude does not
  /// always give more information.
  double share = 1.0;
};

/// Returns the number of coordinates that describe a drive of this family.
Eigen::Index drive_coordinates(datasets::DriveFamily family);

/// Returns the drive at a point in the unit box:
///   multisine  five sines, each with frequency, amplitude and phase;
///   chirp      frequency and amplitude at each end, logarithmic between them;
///   steps      eight levels, each with its duration, and the rise time;
///   prbs       bit time, rise time, and the start of the sequence of x^11 + x^9 + 1.
/// Two further coordinates are the fraction of the allowed amplitude and the offset of the drive.
/// The drive departs from its first value during the first twentieth of the test, and returns to it
/// during the last.
///
/// @param point  shape (coordinates), in [0, 1]
DriveShape drive_shape(datasets::DriveFamily family, const Eigen::VectorXd& point,
                       const DriveGrid& grid);

}  // namespace rigcal::calib
