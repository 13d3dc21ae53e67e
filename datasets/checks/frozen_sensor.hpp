#pragma once

#include <span>
#include <vector>

#include "datasets/checks/equal_runs.hpp"

namespace rigcal::datasets {

/// Finds runs of exactly equal samples that show a frozen sensor, line or recording while the rig
/// moved. A run must be at least sixteen times as long as the signal's runs are on average. In
/// addition, one of two conditions must be met:
/// - The signal shows noise elsewhere, and the drive moves by at least 10 % of its range during the
///   run. (If the noise is two steps of the converter, a run of this length occurs by chance once
///   in 1e12 samples.)
/// - The drive passes through its range and back, and the run interrupts a motion: within three
///   samples, before the run and after it, the signal moves by at least its typical step and at
///   least four steps of its resolution. These conditions exclude slow signals from coarse
///   converters, sweeps that decay below a step of the converter, and a piston that sticks under a
///   slow drive because of friction.
/// @param x  shape (n), evenly sampled, finite
/// @param drive  shape (n), reference or command
/// @return  in order; empty for a constant signal
std::vector<EqualRun> frozen_runs(std::span<const double> x, std::span<const double> drive);

}  // namespace rigcal::datasets
