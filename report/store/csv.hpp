#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "datasets/prepare/repeatability.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"
#include "report/store/result.hpp"
#include "report/store/table.hpp"

// Result tables as CSV (RFC 4180, LF): SI units, units at the end of column names, numbers that
// read back to the same bits, empty fields where there is no number. The result of a fit that
// failed or was stopped says so in its first line: "# status: failed: why".

namespace rigcal::report {

/// scorecard.csv: one row per condition and channel; `unit` is that of rmse and maximum_error.
std::string scorecard_csv(const Result& result);

/// residuals/<condition>.csv: time_s, per output channel measured, simulated, residual (measured
/// minus simulated) and sd (of one repeat about the mean, where there are repeats), whether the
/// sample counts, the drive (reference_m or command_v) and the simulated flows.
std::string residuals_csv(const Result& result, const calib::ConditionScore& score);

/// The same as a table, as it would be read back.
Table residual_table(const Result& result, const calib::ConditionScore& score);

/// averaged/<condition>.csv: time_s, and mean, sd and count of every channel.
std::string averaged_csv(const datasets::Record& record);

/// repeatability.csv: one row per condition and channel; offsets of the repeats in their order.
std::string repeatability_csv(const std::vector<datasets::Record>& records);

/// <condition>.csv of `simulate`: time_s, the reference (closed loop), every output. If the
/// simulation failed there are no rows, and the first line gives the reason.
///
/// @param reference  shape (samples), or empty in open loop
/// @param outputs    those to write; simulation.outputs has a column for each of kAllOutputs
std::string simulation_csv(std::span<const double> time_s, std::string_view reference_name,
                           std::span<const double> reference,
                           std::span<const model::Output> outputs,
                           const model::Simulation& simulation);

}  // namespace rigcal::report
