#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "model/simulate.hpp"

namespace rigcal::model {

/// After how long the inputs of a rig and the instants of its samples repeat themselves.
struct SampledPeriod {
  double duration_s = 0.0;
  std::size_t samples = 0;
  bool reversed = false;  ///< the inputs with the other sign: an odd number of half periods

  /// What repeats itself changes by this factor from one period to the next.
  double sign() const { return reversed ? -1.0 : 1.0; }
};

/// The shortest whole number of periods of the drive after which a sample follows each sample (and
/// a tick each tick of a controller with `tick_s`), as long as it is less than the record. Of half
/// periods, where the drive is then what it was with the other sign and the rig is `reversible`.
///
/// @param reversible  whether with reversed inputs the rig does all that it did, reversed
/// @param tick_s      sample time of the controller; empty if it has none
/// @return            none if an input does not repeat itself, or the samples do not
std::optional<SampledPeriod> sampled_period(const SimulationInputs& inputs,
                                            std::span<const double> times_s, bool reversible,
                                            std::optional<double> tick_s);

}  // namespace rigcal::model
