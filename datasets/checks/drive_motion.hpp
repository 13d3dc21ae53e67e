#pragma once

#include <span>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// Motion of the drive while a signal is constant, as a fraction of the drive's range over the
/// whole record. It is the range of the medians of four parts of the run, so that an edge at its
/// end, which the rig answers later, does not count; in a short run it is that of single samples.
///
/// @param drive  shape (n), of the same record as the run
double drive_motion(std::span<const double> drive, const EqualRun& run);

/// Number of times that the drive goes from the lowest to the highest tenth of its range, or back,
/// in a run.
int drive_passages(std::span<const double> drive, const EqualRun& run);

}  // namespace rigcal::datasets
