#include <algorithm>
#include <array>
#include <string_view>

#include "common/calendar.hpp"
#include "metrics/significance.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

/// Mean of a condition's quantity over those that an estimate of this scope and level rests on.
template <typename Quantity>
std::optional<double> mean_over(const Json& result, const Json& parameter, Quantity quantity) {
  const std::string scope = text_of(parameter, "scope");
  const std::string level = text_of(parameter, "level");
  double sum = 0.0;
  int count = 0;
  for (const Json& condition : result.at("conditions")) {
    if (text_of(condition, "use") != "fit") continue;
    if (scope == "leak_level" && text_of(condition, "leak_level") != level) continue;
    if (scope == "condition" && text_of(condition, "id") != level) continue;
    const std::optional<double> value = quantity(condition);
    if (!value) continue;
    sum += *value;
    ++count;
  }
  return count > 0 ? std::optional<double>(sum / count) : std::nullopt;
}

/// What an estimate is of: those of equal name are points of one trend.
std::string series_of(const Json& result, const Json& parameter) {
  const std::string scope = text_of(parameter, "scope");
  const std::string level = text_of(parameter, "level");
  if (scope == "rig") return "rig";
  if (scope == "leak_level") return level;
  const Json* condition = find_condition(result, level);
  const std::string own = condition == nullptr ? std::string() : text_of(*condition, "leak_level");
  return own.empty() ? "rig" : own;
}

struct Along {
  const char* key;       ///< of a point
  const char* trend;     ///< of the series
  const char* per_unit;  ///< of the slope
};
constexpr std::array kAlong{Along{"day", "along_date", "slope_per_day"},
                            Along{"temperature_k", "along_temperature", "slope_per_k"}};

/// @param shared  whether results of the series share records
Json trend_json(const Json& points, const Along& along, bool shared) {
  std::vector<double> x, y, error;
  for (const Json& point : points) {
    const auto at = number_of(point, along.key);
    const auto value = number_of(point, "value");
    const auto sd = number_of(point, "standard_error");
    if (!at || !value || !sd || !(*sd > 0.0)) continue;
    x.push_back(*at);
    y.push_back(*value);
    error.push_back(*sd);
  }
  Json json;
  json["points"] = x.size();
  for (const char* key : {along.per_unit, "intercept", "standard_error", "ci95", "p_value",
                          "reduced_chi_square", "significant"})
    json[key] = nullptr;
  json["reason"] = nullptr;
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  if (x.size() < 3 || *low == *high || shared) {
    json["reason"] = x.empty()      ? "no estimate has it"
                     : x.size() < 3 ? "fewer than three estimates with an error"
                     : *low == *high
                         ? "all estimates are at the same place"
                         : "not tested: the results share records, so they are not independent";
    return json;
  }
  const metrics::Trend trend = metrics::weighted_trend(x, y, error);
  json[along.per_unit] = number(trend.slope);
  json["intercept"] = number(trend.intercept);
  json["standard_error"] = number(trend.slope_standard_error);
  json["ci95"] = Json::array({number(trend.ci95_low), number(trend.ci95_high)});
  json["p_value"] = number(trend.p_value);
  json["reduced_chi_square"] = number(trend.reduced_chi_square);
  json["significant"] = trend.p_value < kSignificantLevel;
  return json;
}

bool any_share_records(const std::vector<const Json*>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) {
    for (std::size_t j = i + 1; j < results.size(); ++j) {
      // Several levels of one fit are told apart by their own records.
      if (results[i] != results[j] && share_records(*results[i], *results[j])) return true;
    }
  }
  return false;
}

}  // namespace

Json trends(const std::vector<Compared>& results, std::string_view key) {
  struct Series {
    std::string name;
    Json points = Json::array();
    std::vector<const Json*> results;
  };
  std::vector<Series> series;
  for (const Compared& compared : results) {
    if (!is_usable(compared.result)) continue;
    for (const Json& parameter : compared.result.at("parameters")) {
      if (text_of(parameter, "key") != key || !parameter.at("fitted").get<bool>()) continue;
      const std::string name = series_of(compared.result, parameter);
      auto found = std::find_if(series.begin(), series.end(),
                                [&](const auto& each) { return each.name == name; });
      if (found == series.end())
        found = series.insert(series.end(), Series{name, Json::array(), {}});
      Json point;
      point["result"] = compared.name;
      point["level"] = parameter.at("level");
      point["day"] = number(mean_over(compared.result, parameter, [](const Json& condition) {
        return std::optional<double>(day_of(text_of(condition, "date")));
      }));
      point["temperature_k"] =
          number(mean_over(compared.result, parameter, [](const Json& condition) {
            return number_of(condition, "temperature_k");
          }));
      point["value"] = parameter.at("value");
      point["standard_error"] = number(error_of(parameter));
      point["ci95"] = parameter.at("ci95");
      found->points.push_back(std::move(point));
      found->results.push_back(&compared.result);
    }
  }
  Json list = Json::array();
  for (const Series& each : series) {
    Json json{{"of", each.name}, {"points", each.points}};
    const bool shared = any_share_records(each.results);
    for (const Along& along : kAlong) json[along.trend] = trend_json(each.points, along, shared);
    list.push_back(std::move(json));
  }
  return list;
}

Json leak_trends(const std::vector<Compared>& results) {
  return trends(results, "leakage_coefficient");
}

}  // namespace rigcal::report
