#include <algorithm>

#include "common/calendar.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

using datasets::Scope;

/// Averages a quantity over the conditions that an estimate with this scope and level is based on.
template <typename Quantity>
std::optional<double> mean_over(const StoredFit& fit, const calib::FittedParameter& parameter,
                                Quantity quantity) {
  double sum = 0.0;
  int count = 0;
  for (const calib::ConditionResult& condition : fit.conditions) {
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
std::string series_of(const StoredFit& fit, const calib::FittedParameter& parameter) {
  const std::string level = parameter.level.value_or("");
  if (parameter.scope == Scope::rig) return "rig";
  if (parameter.scope == Scope::leak_level) return level;
  const calib::ConditionResult* condition = fit.find(level);
  return condition == nullptr ? "rig" : condition->leak_level.value_or("rig");
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

StoredTrendPoint point_of(const Compared& compared, const calib::FittedParameter& parameter) {
  StoredTrendPoint point;
  point.result = compared.name;
  point.level = parameter.level;
  point.day = mean_over(compared.result, parameter, [](const calib::ConditionResult& condition) {
    return std::optional<double>(condition.date ? day_of(*condition.date) : std::nullopt);
  });
  point.temperature_k =
      mean_over(compared.result, parameter,
                [](const calib::ConditionResult& condition) -> std::optional<double> {
                  return condition.temperature_k;
                });
  point.value = finite(parameter.value);
  if (const auto error = interval_error(parameter)) {
    const bool dated = point.day.has_value();  // the between-day error applies only to points with
                                               // a date
    const metrics::EstimateError all =
        dated ? calib::with_days(*error, parameter.between_days_error) : *error;
    if (dated && parameter.between_days_error)
      point.between_days_error = parameter.between_days_error;
    point.standard_error = all.standard_error;
    point.degrees_of_freedom = std::optional(all.freedom);
  }
  point.ci95 = parameter.ci95;
  return point;
}

}  // namespace

std::vector<calib::PlacedEstimate> placed_estimates(
    const std::vector<StoredTrendPoint>& points, std::optional<double> StoredTrendPoint::*place) {
  std::vector<calib::PlacedEstimate> placed;
  for (const StoredTrendPoint& point : points) {
    if (!(point.*place) || !point.value || !(point.standard_error.value_or(0.0) > 0.0)) continue;
    placed.push_back(
        {*(point.*place),
         *point.value,
         {*point.standard_error, point.degrees_of_freedom.value_or(metrics::kManyDegrees)},
         point.between_days_error.value_or(0.0) > 0.0});
  }
  return placed;
}

std::vector<StoredSeries> trends(const std::vector<Compared>& results, std::string_view key) {
  std::vector<StoredSeries> list;
  std::vector<std::vector<const Compared*>> sources;  // the results that contribute to each series
  for (const Compared& compared : results) {
    if (!is_usable(compared.result)) continue;
    for (const calib::FittedParameter& parameter : compared.result.parameters) {
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
    const auto trend_along = [&](std::optional<double> StoredTrendPoint::*place) {
      return calib::trend_of(placed_estimates(list[i].points, place), shared);
    };
    list[i].along_date = {trend_along(&StoredTrendPoint::day)};
    list[i].along_temperature = {trend_along(&StoredTrendPoint::temperature_k)};
  }
  return list;
}

}  // namespace rigcal::report
