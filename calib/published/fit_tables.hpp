#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/published/leak_table.hpp"
#include "calib/result/fit_result.hpp"
#include "calib/search/fit_options.hpp"
#include "common/range.hpp"

namespace rigcal::calib {

/// One assumption that was estimated.
struct FittedAssumption {
  int index = 0;  ///< row of the parameter table, or datasets::kResidualScale
  double value = 0.0;
  double start = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  std::optional<double> standard_error;  ///< absent where the tables do not determine it
  std::optional<Range> ci95;
  std::optional<double> degrees_of_freedom;  ///< for the standard error
  bool at_bound = false;
  Identifiability identifiability = Identifiability::not_identifiable;
};

/// One published number against the computed one, at the end of the fit.
struct TableResidual {
  std::string of;          ///< "share, sine_0.1Hz, 10 %", "mean, Slight"
  double weight = 1.0;     ///< weight of its square root in the cost
  double log_ratio = 0.0;  ///< ln(computed / published)
  RIGCAL_DESCRIBE(of, weight, log_ratio)
};

/// Values that make the published tables come out, estimated by least squares.
struct TablesFit {
  FitStatus status = FitStatus::failed;
  std::string message;
  double cost = 0.0;  ///< half the sum of (weight ln(computed / published))^2
  int iterations = 0;
  int evaluations = 0;
  double wall_seconds = 0.0;
  double rms = 0.0;  ///< root mean square of the weighted residuals
  std::vector<FittedAssumption> parameters;
  Correlation correlation;  ///< correlation of all parameters
  std::vector<TableResidual> residuals;
  std::vector<std::string> left_out;     ///< published numbers that do not count, and why
  datasets::LeakTableSettings settings;  ///< with the estimated values filled in
};

/// Weight of the logarithm of a share at its published coefficient; of a flow or feature it is 1.
inline constexpr double kShareWeight = 0.5;

/// Estimates the assumptions marked `fit` from the published numbers by Ceres, with derivatives by
/// sensitivities. Residuals are weighted logarithms of computed over published: of the share at
/// each published coefficient, and of the flows and features that are not left out.
///
/// A value whose lower bound is positive is estimated by its logarithm, any other by itself, so
/// that a gain may start at zero. Intervals take the scatter of the residuals for their error.
///
/// @throws InputError  nothing is marked `fit`, or fewer published numbers than values
/// @return             never throws for a fit that fails: see status
TablesFit fit_tables(const datasets::Campaign& campaign,
                     const datasets::LeakTableSettings& settings, const LeakTableOptions& options);

}  // namespace rigcal::calib
