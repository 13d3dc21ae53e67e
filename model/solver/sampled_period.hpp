#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "model/plant/rig.hpp"

namespace rigcal::model {

/// Period after which both the inputs of a rig and its sampling instants repeat.
struct SampledPeriod {
  double duration_s = 0.0;
  std::size_t samples = 0;
  bool reversed =
      false;            ///< an odd number of half periods: the inputs repeat with the opposite sign
  double from_s = 0.0;  ///< time since the first sample from which the inputs repeat

  /// Factor by which a periodic quantity changes from one period to the next.
  double sign() const { return reversed ? -1.0 : 1.0; }
};

/// Finds the shortest whole number of drive periods after which every sample (and every tick of a
/// controller with `tick_s`) has a counterpart, if that is shorter than the record. Half periods
/// also qualify if the drive then has the opposite sign and the rig is `reversible`. Supply
/// pressure and spool error may begin to repeat later than the drive (Repetition).
///
/// @param reversible  whether reversing the inputs reverses the response of the rig
/// @param tick_s      sample time of the controller; std::nullopt if it has none
/// @return            std::nullopt if an input or the samples are not periodic
std::optional<SampledPeriod> sampled_period(const SimulationInputs& inputs,
                                            std::span<const double> times_s, bool reversible,
                                            std::optional<double> tick_s);

}  // namespace rigcal::model
