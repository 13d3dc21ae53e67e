#pragma once

#include <string>

#include "calib/result/posterior.hpp"

namespace rigcal::report {

inline constexpr const char* kDrawsFile = "posterior.csv";

/// posterior.csv: a row for each draw, with its chain and its number there, both from 1, and a
/// column for each unknown in SI, by its name.
std::string draws_csv(const calib::Posterior& posterior);

}  // namespace rigcal::report
