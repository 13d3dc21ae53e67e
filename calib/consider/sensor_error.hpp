#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "model/plant/parameter.hpp"
#include "model/plant/rig.hpp"

namespace rigcal::calib {

/// Largest root mean square error of a lag's effect that sensor_error() allows, as a fraction of
/// that effect. A lag that is simulated has as much (kFartherFromSample in model/solver/sensors).
inline constexpr double kLagError = 4e-3;

/// Returns whether a parameter is the gain or offset of a sensor from whose reading the run starts.
/// Such a parameter changes the state at the first sample, and thus all outputs.
///
/// @param index  row of the parameter table
bool changes_start(const model::Rig& rig, const model::ParameterValues& values,
                   model::Output output, int index);

/// Returns the change of a sensor's readings when its gain, offset or lag grows by `size`. It
/// follows from the readings, since no loop uses them; if changes_start(), it must be simulated
/// instead. A lag follows the cubic through the four readings around each interval.
///
/// @param index    row of the parameter table; a lag is zero so far
/// @param values   without the change
/// @param times_s  increasing, shape (samples)
/// @param reading  without the change, shape (samples)
/// @return         std::nullopt if the row is another parameter, if the sensor saturates, or if
///                 the readings lie too far apart for a lag
std::optional<Eigen::VectorXd> sensor_error(model::Output output,
                                            const model::ParameterValues& values, int index,
                                            double size, std::span<const double> times_s,
                                            const Eigen::VectorXd& reading);

}  // namespace rigcal::calib
