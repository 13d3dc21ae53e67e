#pragma once

#include <limits>
#include <string>
#include <vector>

#include "datasets/record.hpp"
#include "report/store/result.hpp"
#include "report/text/style.hpp"

namespace rigcal::report {

/// Rows of a table that is not cut.
inline constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

/// Verdict with its four aspects, the three worst conditions, and the paths of the files: the part
/// to read first. If the fit was stopped or failed, this and the reason come before it.
///
/// @param files  paths
std::string summary_text(const Result& result, const std::vector<std::string>& files,
                         const Style& style);

/// Agreement per condition, then grouped by use, frequency, waveform and leak level. Only the worst
/// of several channels is shown, by name: one that breaks a limit, else the one with the lowest
/// rho2. The others are in scorecard.csv.
///
/// @param most  rows of each table, the worst ones; the rest is counted
std::string scorecard_text(const Result& result, const Style& style, std::size_t most = kAll);

/// Fitted parameters in readable units with errors, bounds and grades.
///
/// @param most  rows, the least certain parameters first; the rest is counted
std::string parameters_text(const Result& result, const Style& style, std::size_t most = kAll);

/// Status, the reasons of each aspect, and the warnings.
///
/// @param most  reasons of each kind; the rest is counted
std::string reasons_text(const Result& result, const Style& style, std::size_t most = kAll);

/// All of these, as `fit` and `validate` print them. If a terminal limits the lines, the tables
/// have as many rows as fit.
///
/// @param files  paths
std::string result_text(const Result& result, const std::vector<std::string>& files,
                        const Style& style);

/// One line on a record and one on each of its warnings.
std::string record_text(const datasets::Condition& condition, const datasets::Record& record);

/// The parameter table of a plant.
std::string parameter_table_text(model::PlantKind plant, const Style& style);

}  // namespace rigcal::report
