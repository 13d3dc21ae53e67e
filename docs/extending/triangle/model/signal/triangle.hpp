#pragma once

#include "model/signal/signal.hpp"

namespace rigcal::model {

/// A triangle: up from zero to the amplitude in a quarter of a period, down to its negative, and up
/// again.
inline Signal triangle(double amplitude, double frequency_hz) {
  static constexpr PeriodicShape kTriangle{4,
                                           [](int piece, double phase) -> SignalSample {
                                             if (piece == 0) return {4.0 * phase, 4.0};
                                             if (piece == 3) return {4.0 * (phase - 1.0), 4.0};
                                             return {2.0 - 4.0 * phase, -4.0};
                                           },
                                           true};
  return Signal::shaped(kTriangle, amplitude, frequency_hz);
}

}  // namespace rigcal::model
