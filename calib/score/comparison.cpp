#include "calib/score/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "metrics/trend.hpp"

namespace rigcal::calib {
namespace {

/// Returns true if a value is zero, or not significantly different from zero, so that a percentage
/// of it is meaningless.
bool may_be_zero(const ComparedEstimate& estimate) {
  if (estimate.value.value_or(0.0) == 0.0) return true;
  const auto& ci95 = estimate.ci95;
  if (!ci95 || !std::isfinite(ci95->low) || !std::isfinite(ci95->high)) return false;
  return ci95->low <= 0.0 && ci95->high >= 0.0;
}

/// Adds an independent variance that is known exactly to an error.
metrics::EstimateError with_variance(const metrics::EstimateError& own, double variance) {
  const std::array parts{metrics::ErrorPart{own.standard_error * own.standard_error, own.freedom},
                         metrics::ErrorPart{variance, metrics::kManyDegrees}};
  return {std::hypot(own.standard_error, std::sqrt(variance)), metrics::effective_freedom(parts)};
}

/// Tests whether one result is better in more conditions than chance would explain.
void sign_test(bool shared, ScoreDifference& result) {
  const int untied = result.better + result.worse;
  if (shared) {
    result.reason = "not tested: the results share records, so their scores are not independent";
  } else if (untied < metrics::kLeastSignPairs) {
    result.reason = fmt::format("not tested: {} condition{}, and a sign test needs {}", untied,
                                untied == 1 ? "" : "s", metrics::kLeastSignPairs);
  } else {
    result.p_value = metrics::sign_test_p_value(result.better, result.worse);
    result.significant = *result.p_value < kSignificantLevel;
  }
}

}  // namespace

EstimateDifference difference_of(const ComparedEstimate& first, const ComparedEstimate& other,
                                 const Dependence& dependence) {
  EstimateDifference result;
  const auto untested = [&](const char* reason) {
    result.reason = reason;
    return result;
  };
  if (!first.value || !other.value) return untested("one has no value");
  const double difference = *other.value - *first.value;
  result.difference = difference;
  if (!may_be_zero(first)) result.percent = 100.0 * (*other.value / *first.value - 1.0);
  if (!first.fitted && !other.fitted) return untested(kKnownInBoth);
  // A known value has no error.
  const auto error = [&](const ComparedEstimate& estimate) {
    const metrics::EstimateError own{estimate.standard_error.value_or(0.0),
                                     estimate.degrees_of_freedom.value_or(metrics::kManyDegrees)};
    return dependence.other_dates ? with_days(own, estimate.between_days_error) : own;
  };
  for (const ComparedEstimate* estimate : {&first, &other})
    if (estimate->fitted && !estimate->standard_error)
      return untested("an estimate has no standard error");
  if (first.fitted && other.fitted && dependence.same_records)
    return untested("estimated from the same data, so not independent of each other");
  metrics::EstimateError both = metrics::error_of_difference(error(first), error(other));
  if (dependence.by_effects > 0.0) {
    both = with_variance(both, dependence.by_effects);
    result.by_effects = std::sqrt(dependence.by_effects);
  }
  result.standard_error = both.standard_error;
  if (dependence.other_dates && (first.between_days_error || other.between_days_error))
    result.of_other_dates = true;
  result.degrees_of_freedom = std::optional(both.freedom);
  result.p_value = metrics::difference_p_value(difference, both);
  return result;
}

void judge_together(const std::vector<EstimateDifference*>& differences) {
  std::vector<double> p_values;
  std::vector<EstimateDifference*> tested;
  for (EstimateDifference* const difference : differences) {
    if (!difference->p_value) continue;
    p_values.push_back(*difference->p_value);
    tested.push_back(difference);
  }
  const std::vector<double> adjusted = metrics::holm(p_values);
  for (std::size_t i = 0; i < tested.size(); ++i) {
    tested[i]->p_value_of_all = adjusted[i];
    tested[i]->significant = adjusted[i] < kSignificantLevel;
  }
}

double variance_by_effects(const EffectCovariance& first, const EffectCovariance& other) {
  // Per unit of an effect, the difference changes by the move of one estimate minus that of the
  // other.
  const auto variance_by = [](const EffectCovariance& own, const EffectCovariance& beside) {
    Eigen::RowVectorXd moves = own.moves.row(0);
    for (std::size_t e = 0; e < own.keys.size(); ++e) {
      const auto place = std::find(beside.keys.begin(), beside.keys.end(), own.keys[e]);
      if (place != beside.keys.end())
        moves(static_cast<Eigen::Index>(e)) -= beside.moves(0, place - beside.keys.begin());
    }
    return (moves * own.root).squaredNorm();
  };
  return std::max(variance_by(first, other), variance_by(other, first));
}

metrics::EstimateError with_days(const metrics::EstimateError& own,
                                 const std::optional<double>& between_days_error) {
  const double days = between_days_error.value_or(0.0);
  return days > 0.0 ? with_variance(own, days * days) : own;
}

ScoreDifference score_difference(const std::vector<std::pair<double, double>>& scores,
                                 bool higher_is_better, bool shared) {
  ScoreDifference result;
  for (const auto& [a, b] : scores) {
    ++result.conditions;
    result.mean_of_first += a;
    result.mean += b;
    if (a != b) ++((b > a) == higher_is_better ? result.better : result.worse);
  }
  result.mean_of_first /= result.conditions;
  result.mean /= result.conditions;
  sign_test(shared, result);
  return result;
}

EstimateTrend trend_of(const std::vector<PlacedEstimate>& estimates, bool shared) {
  EstimateTrend result;
  std::vector<double> x, y;
  std::vector<metrics::EstimateError> errors;
  metrics::DaysOfPoints days;
  days.counted = !estimates.empty();
  for (const PlacedEstimate& each : estimates) {
    x.push_back(each.place);
    y.push_back(each.value);
    errors.push_back(each.error);
    days.counted = days.counted && each.days_counted;
  }
  result.points = static_cast<long>(x.size());
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const bool few = x.size() < metrics::kLeastTrendPoints;
  if (few || *low == *high || shared) {
    result.reason = x.empty() ? "no estimate has a value of it"
                    : few     ? "fewer than three estimates with an error"
                    : *low == *high
                        ? "all estimates have the same date or temperature"
                        : "not tested: the results share records, so they are not independent";
    return result;
  }
  metrics::Trend trend;
  try {
    trend = metrics::weighted_trend(x, y, errors, {}, days);
  } catch (const std::domain_error&) {  // possible if a file was edited by hand
    result.reason = "the errors of the estimates are too far apart for a line";
    return result;
  }
  result.slope = trend.slope;
  result.intercept = trend.intercept;
  result.standard_error = trend.slope_standard_error;
  result.degrees_of_freedom = std::optional(trend.freedom);
  result.widened = std::optional(trend.widened);
  result.ci95 = {trend.ci95_low, trend.ci95_high};
  result.p_value = trend.p_value;
  result.reduced_chi_square = trend.reduced_chi_square;
  result.significant = trend.p_value < kSignificantLevel;
  return result;
}

std::optional<double> half_width_of_band(const EstimateTrend& trend,
                                         const std::vector<PlacedEstimate>& estimates,
                                         double place) {
  if (!trend.slope || !trend.ci95 || !(trend.standard_error.value_or(0.0) > 0.0))
    return std::nullopt;
  double weights = 0.0;
  double middle = 0.0;
  for (const PlacedEstimate& each : estimates) {
    const double weight = 1.0 / (each.error.standard_error * each.error.standard_error);
    weights += weight;
    middle += (each.place - middle) * weight / weights;
  }
  if (!(weights > 0.0) || !std::isfinite(weights)) return std::nullopt;
  const double level_error = trend.widened.value_or(1.0) / std::sqrt(weights);
  const double quantile = (trend.ci95->high - *trend.slope) / *trend.standard_error;
  return quantile * std::hypot(level_error, *trend.standard_error * (place - middle));
}

}  // namespace rigcal::calib
