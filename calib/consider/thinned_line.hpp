#pragma once

#include <span>

#include "model/signal/signal.hpp"

namespace rigcal::calib {

/// Largest error of thinned_line(), as a fraction of the range of its values.
inline constexpr double kThinnedError = 1e-4;

/// Returns a signal of straight lines through as few of the samples as keep it within kThinnedError
/// of all others. A simulation ends a step at each sample of such a signal, and an input that
/// follows from a simulation is smooth or constant over most of a slow record.
///
/// @param time_s  increasing, shape (samples), at least one
/// @param value   shape (samples)
model::Signal thinned_line(std::span<const double> time_s, std::span<const double> value);

}  // namespace rigcal::calib
