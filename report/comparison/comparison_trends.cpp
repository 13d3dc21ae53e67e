#include <algorithm>
#include <stdexcept>

#include "common/calendar.hpp"
#include "metrics/trend.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

using datasets::Scope;

/// Averages a quantity over the conditions that an estimate with this scope and level is based on.
template <typename Quantity>
std::optional<double> mean_over(const StoredFit& fit, const StoredParameter& parameter,
                                Quantity quantity) {
  double sum = 0.0;
  int count = 0;
  for (const StoredCondition& condition : fit.conditions) {
    if (condition.use != datasets::Use::fit) continue;
    if (parameter.scope == Scope::leak_level && condition.leak_level != parameter.level) continue;
    if (parameter.scope == Scope::condition && condition.id != parameter.level) continue;
    const std::optional<double> value = quantity(condition);
    if (!value) continue;
    sum += *value;
    ++count;
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

/// Names the series of an estimate. Estimates with the same name are points on one trend.
std::string series_of(const StoredFit& fit, const StoredParameter& parameter) {
  const std::string level = parameter.level.value_or("");
  if (parameter.scope == Scope::rig) return "rig";
  if (parameter.scope == Scope::leak_level) return level;
  const StoredCondition* condition = fit.find(level);
  return condition == nullptr ? "rig" : condition->leak_level.value_or("rig");
}

/// Fits a line to the points of a series.
///
/// @param place   member that gives the abscissa of a point
///
/// @param shared  whether results in the series have common records
void find_trend(const std::vector<StoredTrendPoint>& points,
                std::optional<double> StoredTrendPoint::*place, bool shared, StoredTrend& result) {
  std::vector<double> x, y;
  std::vector<metrics::EstimateError> errors;
  for (const StoredTrendPoint& point : points) {
    if (!(point.*place) || !point.value || !(point.standard_error.value_or(0.0) > 0.0)) continue;
    x.push_back(*(point.*place));
    y.push_back(*point.value);
    errors.push_back(
        {*point.standard_error, point.degrees_of_freedom.value_or(metrics::kManyDegrees)});
  }
  result.points = static_cast<long>(x.size());
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const bool few = x.size() < metrics::kLeastTrendPoints;
  if (few || *low == *high || shared) {
    result.reason = x.empty() ? "no estimate has it"
                    : few     ? "fewer than three estimates with an error"
                    : *low == *high
                        ? "all estimates are at the same place"
                        : "not tested: the results share records, so they are not independent";
    return;
  }
  metrics::Trend trend;
  try {
    trend = metrics::weighted_trend(x, y, errors);
  } catch (const std::domain_error&) {  // only possible in files that were edited by hand
    result.reason = "the errors of the estimates are too far apart for a line";
    return;
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
}

bool any_share_records(const std::vector<const Compared*>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    for (std::size_t j = i + 1; j < results.size(); ++j) {
      // The levels of one fit have separate records.
      if (results[i] != results[j] && share_fitted_records(*results[i], *results[j])) return true;
    }
  }
  return false;
}

StoredTrendPoint point_of(const Compared& compared, const StoredParameter& parameter) {
  StoredTrendPoint point;
  point.result = compared.name;
  point.level = parameter.level;
  point.day = mean_over(compared.result, parameter, [](const StoredCondition& condition) {
    return std::optional<double>(condition.date ? day_of(*condition.date) : std::nullopt);
  });
  point.temperature_k = mean_over(compared.result, parameter,
                                  [](const StoredCondition& condition) -> std::optional<double> {
                                    return condition.temperature_k;
                                  });
  point.value = parameter.value;
  if (const auto error = interval_error(parameter)) {
    const bool dated = point.day.has_value();  // results of other dates have other day effects
    const metrics::EstimateError all =
        dated ? with_days(*error, parameter.between_days_error) : *error;
    if (dated && parameter.between_days_error)
      point.between_days_error = parameter.between_days_error;
    point.standard_error = all.standard_error;
    point.degrees_of_freedom = std::optional(all.freedom);
  }
  point.ci95 = parameter.ci95;
  return point;
}

}  // namespace

std::vector<StoredSeries> trends(const std::vector<Compared>& results, std::string_view key) {
  std::vector<StoredSeries> list;
  std::vector<std::vector<const Compared*>> sources;  // the results that contribute to each series
  for (const Compared& compared : results) {
    if (!is_usable(compared.result)) continue;
    for (const StoredParameter& parameter : compared.result.parameters) {
      if (parameter.key != key || !parameter.fitted) continue;
      const std::string of = series_of(compared.result, parameter);
      const auto found =
          std::find_if(list.begin(), list.end(), [&](const auto& each) { return each.of == of; });
      const auto at = static_cast<std::size_t>(found - list.begin());
      if (found == list.end()) {
        list.push_back({of, {}, {}, {}});
        sources.emplace_back();
      }
      list[at].points.push_back(point_of(compared, parameter));
      sources[at].push_back(&compared);
    }
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const bool shared = any_share_records(sources[i]);
    find_trend(list[i].points, &StoredTrendPoint::day, shared, list[i].along_date);
    find_trend(list[i].points, &StoredTrendPoint::temperature_k, shared, list[i].along_temperature);
  }
  return list;
}

}  // namespace rigcal::report
