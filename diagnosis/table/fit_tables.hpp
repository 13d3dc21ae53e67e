#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/result/fit_result.hpp"
#include "calib/search/fit_options.hpp"
#include "common/describe.hpp"
#include "diagnosis/table/leak_table.hpp"

namespace rigcal::diagnosis {

/// Comparison of a published number with the computed one at the end of the fit.
struct TableResidual {
  std::string of;          ///< the published number: "share, sine_0.1Hz, 10 %", "mean, Slight"
  double weight = 1.0;     ///< factor on `log_ratio` in the residual
  double log_ratio = 0.0;  ///< ln(computed / published)
  RIGCAL_DESCRIBE(of, weight, log_ratio)
};

/// Least-squares estimates of the values that best reproduce the published tables.
struct TablesFit {
  calib::FitStatus status = calib::FitStatus::failed;
  std::string message;
  std::optional<double> cost;  ///< half the sum of (weight ln(computed / published))^2
  long residual_count = 0;
  std::optional<double> rms;  ///< root mean square of the weighted residuals
  int evaluations = 0;
  int iterations = 0;
  double wall_seconds = 0.0;
  std::vector<calib::FittedParameter> parameters;  ///< `index` may be datasets::kResidualScale
  calib::Correlation correlation;  ///< correlation of the estimates, in the order of `parameters`
  std::vector<TableResidual> residuals;
  std::vector<std::string> left_out;     ///< published numbers that were not used, and why
  datasets::LeakTableSettings settings;  ///< the settings with the estimated values; not stored
  RIGCAL_DESCRIBE(status, message, cost, residual_count, rms, evaluations, iterations, wall_seconds,
                  parameters, correlation, residuals, left_out)
};

/// Weight of the logarithm of a leak share at its published coefficient. Flows and features have
/// weight 1.
inline constexpr double kShareWeight = 0.5;

/// Estimates the assumptions marked `fit` from the published numbers with Ceres. Derivatives come
/// from sensitivities. Each residual is the weighted logarithm of a computed value divided by the
/// published one. The values are the leak share at each published coefficient, and the flows and
/// features that are not left out.
///
/// If the lower bound of a value is positive, its logarithm is estimated. Any other value is
/// estimated directly, so that a gain may start at zero. The errors behind the intervals are
/// computed from the size of the residuals.
///
/// @throws InputError  if nothing is marked `fit`, or there are fewer published numbers than values
/// @return  the result; if the fit fails, `status` says so, and nothing is thrown
TablesFit fit_tables(const datasets::Campaign& campaign,
                     const datasets::LeakTableSettings& settings, const LeakTableOptions& options);

}  // namespace rigcal::diagnosis
