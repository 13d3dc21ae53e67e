#pragma once

#include <span>
#include <vector>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// Runs of exactly equal samples in which a sensor, its line or its recording stood still while the
/// rig moved: sixteen times as long as the signal's values typically last, and either
/// - the signal shows noise elsewhere (of two steps of the converter, a run of this length comes by
///   chance once in 1e12 samples), and the drive moves by 10 % of its range; or
/// - the drive passes through its range and back, and the run cuts a motion: the signal arrives at
///   it and leaves it, within three samples, by its typical step and four steps of the resolution.
/// So slow signals of coarse converters are none, nor sweeps that die away below a converter's
/// step, nor a piston that friction holds under a slow drive.
///
/// @param x      shape (n), evenly sampled, finite
/// @param drive  shape (n): reference or command
/// @return       in order; empty for a constant signal
std::vector<EqualRun> frozen_runs(std::span<const double> x, std::span<const double> drive);

}  // namespace rigcal::datasets
