#pragma once

#include <span>

#include "model/signal/signal.hpp"
#include "model/solver/sampled_period.hpp"

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

/// Whether a signal that follows from a run reverses with the inputs of the run.
enum class Reverses { no, yes };

/// Returns thinned_line() of samples that repeat after some time, by the same error, as a signal
/// that is known to repeat from there. If they do not, it is known of no repetition.
///
/// @param periods  periods of the run that the samples come from; the first that fits is taken
model::Signal repeating_line(std::span<const double> time_s, std::span<const double> value,
                             std::span<const model::SampledPeriod> periods, Reverses reverses);

}  // namespace rigcal::calib
