#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "metrics/agreement.hpp"

namespace rigcal::metrics {

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// Everything that the program knows about one metric. Scorecards, limits in campaign files,
/// reports and documentation are generated from these rows.
struct MetricSpec {
  std::string_view name;     ///< name in the results
  std::string_view title;    ///< title of its column on the page
  std::string_view formula;  ///< one line; y measured, s simulated, e = y - s
  std::string_view unit;     ///< "1", "%", or "channel" for the unit of the compared channel
  double Agreement::*value = nullptr;
  double (*compute)(std::span<const double> measured, std::span<const double> simulated) = nullptr;
  bool higher_is_better = true;
  double lowest = 0.0;  ///< lowest possible value
  double highest = kUnbounded;
};

inline constexpr std::array kMetrics{
    MetricSpec{"rho2", "rho2", "1 - var(e) / var(y)", "1", &Agreement::rho2, &rho2, true,
               -kUnbounded, 1.0},
    MetricSpec{"r", "R", "cov(y, s) / (std(y) std(s))", "1", &Agreement::r, &correlation, true,
               -1.0, 1.0},
    MetricSpec{"ccc", "ccc", "2 cov(y, s) / (var(y) + var(s) + (mean y - mean s)^2)", "1",
               &Agreement::ccc, &concordance, true, -1.0, 1.0},
    MetricSpec{"absolute_error_percent", "Error %", "100 mean |e| / (max y - min y)", "%",
               &Agreement::absolute_error_percent, &absolute_error_percent, false},
    MetricSpec{"rmse", "RMSE", "sqrt(mean(e^2))", "channel", &Agreement::rmse, &rmse, false},
    MetricSpec{"nrmse_fit_percent", "Fit %", "100 (1 - ||e|| / ||y - mean y||)", "%",
               &Agreement::nrmse_fit_percent, &nrmse_fit_percent, true, -kUnbounded, 100.0},
    MetricSpec{"maximum_error", "Largest", "max |e|", "channel", &Agreement::maximum_error,
               &maximum_error, false},
};

template <typename Self, typename Visit>
void Agreement::describe(Self& self, const Visit& visit) {
  for (const MetricSpec& metric : kMetrics) visit(metric.name.data(), self.*metric.value);
}

/// Returns null if there is no metric of this name.
constexpr const MetricSpec* find_metric(std::string_view name) {
  for (const MetricSpec& metric : kMetrics)
    if (metric.name == name) return &metric;
  return nullptr;
}

/// Value of a metric if simulation and measurement are identical.
constexpr double ideal(const MetricSpec& metric) {
  if (!metric.higher_is_better) return 0.0;
  return metric.unit == "%" ? 100.0 : 1.0;
}

/// Returns true if a score is at least as good as a bound.
constexpr bool keeps(const MetricSpec& metric, double score, double bound) {
  return metric.higher_is_better ? score >= bound : score <= bound;
}

/// Writes a score with enough digits to show its distance from the best value 1 and on which side
/// of its limit it is: "0.99987", "0.98996" beside a limit of 0.99. Other scores have four
/// significant digits.
std::string score_text(const MetricSpec& metric, double score,
                       const std::optional<double>& limit = {});

}  // namespace rigcal::metrics
