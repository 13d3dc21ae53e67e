#pragma once

#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/problem/simulation_task.hpp"
#include "datasets/prepare/repeatability.hpp"
#include "datasets/record.hpp"
#include "report/store/result.hpp"
#include "report/store/table.hpp"

// Writes result tables as CSV (RFC 4180, LF). Values are in SI units, and column names end in the
// unit. Numbers round-trip exactly; a field without a number is empty. If a fit failed or was
// stopped, the first line of its tables says so: "# status: failed: why".

namespace rigcal::report {

/// Writes scorecard.csv: one row per condition and channel. `unit` applies to rmse and
/// maximum_error.
std::string scorecard_csv(const Result& result);

/// Writes parameters.csv, which belongs to a fit.json or validation.json: one row per parameter, in
/// `unit`.
std::string parameters_csv(calib::FitStatus status, const std::string& message,
                           const std::vector<calib::FittedParameter>& parameters);

/// Writes residuals/<condition>.csv. Its columns are time_s; for each output channel measured,
/// simulated, residual (measured minus simulated) and, with repeats, sd (standard deviation of one
/// repeat about the mean); whether the sample counts; the drive (reference_m or command_v); and the
/// simulated flows.
std::string residuals_csv(const Result& result, const calib::ConditionScore& score);

/// Returns the table that residuals_csv() writes, equal to one read back from the file.
Table residual_table(const Result& result, const calib::ConditionScore& score);

/// Returns the table of averaged/<condition>.csv: time_s, then mean, sd and count for every
/// channel.
Table averaged_table(const datasets::Record& record);

/// Writes repeatability.csv: one row per condition and channel, with the time offset of each
/// repeat.
std::string repeatability_csv(const std::vector<datasets::Record>& records);

/// Writes <condition>.csv for `simulate`: time_s, the reference (closed loop), and every output of
/// the rig. If the simulation failed there are no rows, and the first line gives the reason.
std::string simulation_csv(const calib::SimulationTask& task, const model::Simulation& simulation);

}  // namespace rigcal::report
