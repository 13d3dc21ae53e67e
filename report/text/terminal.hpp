#pragma once

#include <string>
#include <vector>

#include "datasets/record.hpp"
#include "report/store/result.hpp"

namespace rigcal::report {

/// How text is shown.
struct Style {
  bool colour = false;
  std::size_t columns = 0;  ///< of the terminal; 0: tables as wide as they are
};

/// Verdict with its four aspects, the three worst conditions, and where the files are: what is to
/// be read first. Before these, where it was stopped or failed, that and why.
///
/// @param files  paths
std::string summary_text(const Result& result, const std::vector<std::string>& files,
                         const Style& style);

/// Agreement per condition, then gathered by use, frequency, waveform and leak level. Of several
/// channels the worst is shown by name: that which breaks a limit, else that with the lowest rho2;
/// every other is in scorecard.csv.
std::string scorecard_text(const Result& result, const Style& style);

/// Fitted parameters in readable units with errors, bounds and what is to be thought of them.
std::string parameters_text(const Result& result, const Style& style);

/// Status, the reasons of each aspect, and the warnings.
std::string reasons_text(const Result& result, const Style& style);

/// All of these, as `fit` and `validate` print them.
///
/// @param files  paths
std::string result_text(const Result& result, const std::vector<std::string>& files,
                        const Style& style);

/// One line on a record and one on each of its warnings.
std::string record_text(const datasets::Condition& condition, const datasets::Record& record);

/// The parameter table of a plant.
std::string parameter_table_text(model::PlantKind plant, const Style& style);

}  // namespace rigcal::report
