#pragma once

#include "calib/fit.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

inline constexpr const char* kResidualTestsSchema = "rigcal.residual_tests/1";

/// Statistics and verdicts in words of one residual, as in fit.json.
///
/// @param unit  SI unit of the channel
Json residual_tests_json(const metrics::ResidualTests& tests, std::string_view unit);

/// residual_tests.json: the curves behind the verdicts, at most about 200 points each, and `of`:
/// the schema of the result whose residuals/ lie beside it.
std::string residual_curves_text(const Result& result);

}  // namespace rigcal::report
