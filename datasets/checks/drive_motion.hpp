#pragma once

#include <span>

#include "datasets/prepare/equal_runs.hpp"

namespace rigcal::datasets {

/// How far what drives the rig moves while a signal stands still, as a share of its own range over
/// the whole record: the range of the medians of four parts of the run, so that an edge at its end,
/// which the rig answers later, does not count; of single samples where the run is short.
///
/// @param drive  shape (n), of the record that the run is of
double drive_motion(std::span<const double> drive, const EqualRun& run);

/// How often the drive passes from the lowest to the highest tenth of its range, or back, in a run.
int drive_passages(std::span<const double> drive, const EqualRun& run);

}  // namespace rigcal::datasets
