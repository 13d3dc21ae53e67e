#pragma once

#include <string>
#include <vector>

#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {

/// Writes parameters.csv, which belongs to a fit.json or validation.json: one row per parameter, in
/// `unit`. The format is that of the tables in csv.hpp.
std::string parameters_csv(calib::FitStatus status, const std::string& message,
                           const std::vector<calib::FittedParameter>& parameters);

}  // namespace rigcal::report
