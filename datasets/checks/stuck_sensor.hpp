#pragma once

#include <span>
#include <vector>

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

/// The end of the range at which a signal is clipped.
enum class RangeEnd { lowest, highest };

/// Finds runs of at least three exactly equal samples, at the lowest or highest value of a signal,
/// that only a clipped sensor, amplifier or converter explains. The runs must have at least eight
/// samples in total. One of two conditions must be met:
///
/// - The signal leaves that value by three steps of its resolution and returns within three
///   samples, at least ten times: its noise is cut off on one side.
/// - The drive moves by at least 0.5 % of its range during the run. (If the drive is constant, so
///   is the signal, and the noise of a recorded drive is smaller.) The drive must not go to its
///   other end and back, which would release a clipped sensor (frozen_runs()). This is enough
///   if the signal shows noise, because an extreme value then occurs only once or twice by chance.
///   Without noise, because the converter is coarse or the signal is simulated, the run must also
///   begin and end in the middle of a motion. Within three samples, the signal must then move by at
///   least half its typical step, and by two steps of its resolution more than a parabola whose
///   flat top the resolution hides.
///
/// @param x      shape (n), evenly sampled, finite
/// @param drive  shape (n), reference or command
/// @return       in order; empty for a constant signal
std::vector<EqualRun> clipped_runs(std::span<const double> x, std::span<const double> drive,
                                   RangeEnd end);

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
