#pragma once

#include <span>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// How far the drive moves while a signal is constant, as a fraction of the drive's range over the
/// whole record. The run is divided into four parts, and the range of their medians is used, so
/// that an edge at the end of the run, which the rig answers later, does not count. In a short run
/// it is the range of the samples.
///
/// @param drive  shape (n), from the same record as the run
double drive_motion(std::span<const double> drive, const EqualRun& run);

/// Counts how often the drive goes from the lowest to the highest tenth of its range, or back,
/// during a run.
int drive_passages(std::span<const double> drive, const EqualRun& run);

}  // namespace rigcal::datasets
