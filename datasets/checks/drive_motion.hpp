#pragma once

#include <span>

#include "datasets/checks/equal_runs.hpp"

namespace rigcal::datasets {

/// Returns how far the drive moves while a signal is constant, as a fraction of the drive's range
/// over the whole record. The run is divided into four parts, and the range of their medians is
/// used. A drive edge at the end of the run, to which the rig responds only later, therefore does
/// not count. For a short run, the range of its samples is used.
///
/// @param drive  shape (n), from the same record as the run
double drive_motion(std::span<const double> drive, const EqualRun& run);

/// Counts how often the drive goes from the lowest to the highest tenth of its range, or back,
/// during a run.
int drive_passages(std::span<const double> drive, const EqualRun& run);

}  // namespace rigcal::datasets
