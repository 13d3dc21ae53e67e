#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit.hpp"
#include "metrics/residual_tests.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/result.hpp"

// Results of the residual tests, in `residual_tests` of fit.json and in residual_tests.json.

namespace rigcal::report {

inline constexpr const char* kFitSchema = "rigcal.fit/2";
/// Earlier schema. Its `ci95` corresponds to the current `ci95_if_exact`.
inline constexpr const char* kEarlierFitSchema = "rigcal.fit/1";
/// Whether a schema belongs to a fit, written by this or an older version.
inline bool is_fit_schema(std::string_view schema) {
  return schema == kFitSchema || schema == kEarlierFitSchema;
}
inline constexpr const char* kValidationSchema = "rigcal.validation/1";

/// Content of residual_tests.json.
struct StoredCurves {
  calib::FitStatus status = calib::FitStatus::failed;
  std::string schema = "rigcal.residual_tests/1";
  std::string of;  ///< schema of the result
  Keyed<calib::ChannelCurves> conditions;
  RIGCAL_DESCRIBE(status, schema, of, conditions)
};

/// Adds the verdicts to residual tests, in words.
///
/// @param unit  SI unit of the residual
void add_verdicts(metrics::ResidualTests& tests, std::string_view unit);

StoredCurves stored_curves(const Result& result);

}  // namespace rigcal::report
