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

/// Verdict with its four aspects, the three worst conditions, and where the files are: what is to
/// be read first. Before these, where it was stopped or failed, that and why.
///
/// @param files  paths
std::string summary_text(const Result& result, const std::vector<std::string>& files,
                         const Style& style);

/// Agreement per condition, then gathered by use, frequency, waveform and leak level. Of several
/// channels the worst is shown by name: that which breaks a limit, else that with the lowest rho2;
/// every other is in scorecard.csv.
///
/// @param most  rows of each table: what is worst; the rest is counted
std::string scorecard_text(const Result& result, const Style& style, std::size_t most = kAll);

/// Fitted parameters in readable units with errors, bounds and what is to be thought of them.
///
/// @param most  rows, of which those come first that are known least; the rest is counted
std::string parameters_text(const Result& result, const Style& style, std::size_t most = kAll);

/// Status, the reasons of each aspect, and the warnings.
///
/// @param most  of each kind; the rest is counted
std::string reasons_text(const Result& result, const Style& style, std::size_t most = kAll);

/// All of these, as `fit` and `validate` print them: where a terminal limits the lines, with as
/// many rows as find room.
///
/// @param files  paths
std::string result_text(const Result& result, const std::vector<std::string>& files,
                        const Style& style);

/// One line on a record and one on each of its warnings.
std::string record_text(const datasets::Condition& condition, const datasets::Record& record);

/// The parameter table of a plant.
std::string parameter_table_text(model::PlantKind plant, const Style& style);

}  // namespace rigcal::report
