#pragma once

#include <span>
#include <vector>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// Finds runs of exactly equal samples in which a sensor, its line or its recording froze while the
/// rig moved. A run must be sixteen times as long as values of the signal typically last. In
/// addition, one of two conditions must be met:
/// - The signal shows noise elsewhere, and the drive moves by 10 % of its range. (With noise of two
///   steps of the converter a run of this length occurs by chance once in 1e12 samples.)
/// - The drive passes through its range and back, and the run interrupts a motion: within three
///   samples the signal arrives at it and leaves it by its typical step plus four steps of the
///   resolution.
/// Slow signals of coarse converters are therefore excluded, as are sweeps that decay below a step
/// of the converter, and a piston that sticks by friction under a slow drive.
///
/// @param x      shape (n), evenly sampled, finite
/// @param drive  shape (n): reference or command
/// @return       in order; empty for a constant signal
std::vector<EqualRun> frozen_runs(std::span<const double> x, std::span<const double> drive);

}  // namespace rigcal::datasets
