#include "report/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "common/error.hpp"
#include "metrics/significance.hpp"
#include "report/comparison_models.hpp"
#include "report/page_parts.hpp"
#include "report/stored.hpp"

namespace rigcal::report {
namespace {

constexpr double kSignificant = 0.05;
constexpr std::array kComparedMetrics{"rho2", "ccc", "absolute_error_percent"};

bool is_usable(const Json& result) {
  const std::string status = text_of(result, "status");
  return status == "converged" || status == "stopped";
}

/// Last parts of the paths, as many as it takes to tell them apart.
std::vector<std::string> short_names(const std::vector<std::filesystem::path>& folders) {
  std::vector<std::vector<std::string>> parts;
  std::size_t most = 1;
  for (const std::filesystem::path& folder : folders) {
    std::vector<std::string> names;
    for (const auto& part : std::filesystem::absolute(folder).lexically_normal()) {
      if (!part.empty() && part != "/") names.push_back(part.string());
    }
    most = std::max(most, names.size());
    parts.push_back(std::move(names));
  }
  std::vector<std::string> result;
  for (std::size_t count = 1; count <= most; ++count) {
    result.clear();
    for (const auto& names : parts) {
      std::string text;
      for (std::size_t i = names.size() - std::min(count, names.size()); i < names.size(); ++i)
        text += (text.empty() ? "" : "/") + names[i];
      result.push_back(text);
    }
    if (std::set<std::string>(result.begin(), result.end()).size() == result.size()) break;
  }
  return result;
}

/// Days since 1970-01-01 of "2026-03-01".
std::optional<double> day_of(const std::string& date) {
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  if (std::sscanf(date.c_str(), "%d-%u-%u", &year, &month, &day) != 3) return std::nullopt;
  const std::chrono::year_month_day whole{std::chrono::year(year), std::chrono::month(month),
                                          std::chrono::day(day)};
  if (!whole.ok()) return std::nullopt;
  return static_cast<double>(std::chrono::sys_days(whole).time_since_epoch().count());
}

/// The larger of standard and robust error.
std::optional<double> error_of(const Json& parameter) {
  const auto standard = number_of(parameter, "standard_error");
  const auto robust = number_of(parameter, "robust_standard_error");
  if (!standard) return robust;
  return robust ? std::max(*standard, *robust) : *standard;
}

/// Hashes of what the result was made from, but for the campaign file and an earlier fit.
std::map<std::string, std::string> record_hashes(const Json& result) {
  std::map<std::string, std::string> hashes;
  for (const Json& input : result.at("provenance").at("inputs")) {
    const std::filesystem::path path = text_of(input, "path");
    if (path.extension() == ".toml" || path.extension() == ".json") continue;
    hashes.emplace(text_of(input, "sha256"), path.filename().string());
  }
  return hashes;
}

bool is_of_tables(const Json& result) { return text_of(result, "of") == "published tables"; }

/// Fits to published tables name their numbers; they have no records.
bool share_published_numbers(const Json& a, const Json& b) {
  if (!is_of_tables(a) || !is_of_tables(b)) return false;
  for (const Json& x : a.at("residuals"))
    for (const Json& y : b.at("residuals"))
      if (x.at("of") == y.at("of")) return true;
  return false;
}

bool share_records(const Json& a, const Json& b) {
  if (share_published_numbers(a, b)) return true;
  const auto theirs = record_hashes(b);
  for (const auto& [hash, path] : record_hashes(a))
    if (theirs.contains(hash)) return true;
  return false;
}

Json compared_result_json(const Compared& compared) {
  const Json& result = compared.result;
  Json json;
  json["name"] = compared.name;
  json["file"] = compared.file.string();
  for (const char* key :
       {"schema", "status", "verdict", "message", "campaign", "synthetic", "model", "cost",
        "residual_count", "reduced_chi_square", "effective_samples"}) {
    const auto found = result.find(key);
    json[key] = found == result.end() ? Json(nullptr) : *found;
  }
  // Published numbers are no synthetic records.
  if (is_of_tables(result)) json["synthetic"] = false;
  std::set<std::string> dates;
  std::vector<double> kelvins;
  for (const Json& condition : result.at("conditions")) {
    if (const std::string date = text_of(condition, "date"); !date.empty()) dates.insert(date);
    if (const auto kelvin = number_of(condition, "temperature_k")) kelvins.push_back(*kelvin);
  }
  json["conditions"] = result.at("conditions").size();
  json["dates"] = dates.empty() ? Json(nullptr) : Json::array({*dates.begin(), *dates.rbegin()});
  json["temperature_k"] = kelvins.empty()
                              ? Json(nullptr)
                              : Json::array({*std::min_element(kelvins.begin(), kelvins.end()),
                                             *std::max_element(kelvins.begin(), kelvins.end())});
  const Json& provenance = result.at("provenance");
  json["version"] = text_of(provenance, "version");
  json["revision"] = text_of(provenance, "revision");
  json["command"] = text_of(provenance, "command");
  return json;
}

/// What tells a parameter of one result from all others of it.
struct ParameterId {
  std::string name, scope, level;
  bool operator==(const ParameterId&) const = default;
};

ParameterId id_of(const Json& parameter) {
  return {text_of(parameter, "name"), text_of(parameter, "scope"), text_of(parameter, "level")};
}

const Json* find_parameter(const Json& result, const ParameterId& id) {
  for (const Json& parameter : result.at("parameters"))
    if (id_of(parameter) == id) return &parameter;
  return nullptr;
}

Json estimate_json(const Json* parameter, bool usable) {
  if (parameter == nullptr) return nullptr;
  const bool fitted = parameter->at("fitted").get<bool>();
  Json json;
  json["value"] = usable || !fitted ? parameter->at("value") : Json(nullptr);
  json["fitted"] = fitted;
  json["standard_error"] = usable && fitted ? number(error_of(*parameter)) : Json(nullptr);
  json["ci95"] = usable ? parameter->at("ci95") : Json(nullptr);
  json["identifiability"] = parameter->at("identifiability");
  json["at_bound"] = parameter->at("at_bound");
  return json;
}

/// `p_value` is that of this difference alone; `significant` is set later, for all together.
Json difference_json(const Json& first, const Json& other, bool same_records) {
  if (!first.is_object() || !other.is_object()) return nullptr;
  const auto a = number_of(first, "value");
  const auto b = number_of(other, "value");
  Json json;
  json["difference"] = a && b ? number(*b - *a) : Json(nullptr);
  json["percent"] = a && b && *a != 0.0 ? number(100.0 * (*b / *a - 1.0)) : Json(nullptr);
  json["standard_error"] = nullptr;
  json["p_value"] = nullptr;
  json["p_value_of_all"] = nullptr;
  json["significant"] = nullptr;
  const auto reason = [&](const char* text) {
    json["reason"] = text;
    return json;
  };
  if (!a || !b) return reason("one has no value");
  const bool first_fitted = first.at("fitted").get<bool>();
  const bool other_fitted = other.at("fitted").get<bool>();
  if (!first_fitted && !other_fitted) return reason("known in both");
  const auto error = [](const Json& estimate) -> std::optional<double> {
    if (!estimate.at("fitted").get<bool>()) return 0.0;
    return number_of(estimate, "standard_error");
  };
  const auto error_a = error(first);
  const auto error_b = error(other);
  if (!error_a || !error_b) return reason("an estimate has no standard error");
  if (first_fitted && other_fitted && same_records)
    return reason("estimated from the same data, so not independent of each other");
  const double both = std::hypot(*error_a, *error_b);
  if (!(both > 0.0)) return reason("an estimate has no standard error");
  json["standard_error"] = number(both);
  json["p_value"] = number(metrics::difference_p_value(*b - *a, both));
  json["reason"] = nullptr;
  return json;
}

/// Judges all differences of one result from the first together.
void judge_together(Json& parameters, std::size_t result) {
  std::vector<double> p_values;
  std::vector<Json*> differences;
  for (Json& parameter : parameters) {
    Json& difference = parameter["differences"][result];
    if (!difference.is_object() || !difference.at("p_value").is_number()) continue;
    p_values.push_back(difference.at("p_value").get<double>());
    differences.push_back(&difference);
  }
  const std::vector<double> adjusted = metrics::holm(p_values);
  for (std::size_t i = 0; i < differences.size(); ++i) {
    (*differences[i])["p_value_of_all"] = number(adjusted[i]);
    (*differences[i])["significant"] = adjusted[i] < kSignificant;
  }
}

Json parameters_json_of(const std::vector<Compared>& results) {
  std::vector<ParameterId> ids;
  for (const Compared& compared : results) {
    for (const Json& parameter : compared.result.at("parameters")) {
      const ParameterId id = id_of(parameter);
      if (!parameter.at("nuisance").get<bool>() &&
          std::find(ids.begin(), ids.end(), id) == ids.end())
        ids.push_back(id);
    }
  }
  Json list = Json::array();
  for (const ParameterId& id : ids) {
    Json json;
    Json estimates = Json::array();
    for (const Compared& compared : results) {
      const Json* parameter = find_parameter(compared.result, id);
      if (parameter != nullptr && !json.contains("name")) {
        for (const char* key : {"name", "key", "symbol", "unit", "scope", "level"})
          json[key] = parameter->at(key);
      }
      estimates.push_back(estimate_json(parameter, is_usable(compared.result)));
    }
    Json differences = Json::array({nullptr});
    for (std::size_t i = 1; i < results.size(); ++i) {
      differences.push_back(difference_json(estimates[0], estimates[i],
                                            share_records(results[0].result, results[i].result)));
    }
    json["estimates"] = std::move(estimates);
    json["differences"] = std::move(differences);
    list.push_back(std::move(json));
  }
  for (std::size_t i = 1; i < results.size(); ++i) judge_together(list, i);
  return list;
}

const Json* find_condition(const Json& result, const std::string& id) {
  for (const Json& condition : result.at("conditions"))
    if (text_of(condition, "id") == id) return &condition;
  return nullptr;
}

Json score_of(const Json* condition, const std::string& channel, bool usable) {
  if (condition == nullptr) return nullptr;
  const Json& metrics_of = condition->at("metrics");
  const auto scores = metrics_of.find(channel);
  Json json;
  json["use"] = condition->at("use");
  json["samples"] = condition->at("samples");
  json["date"] = text_of(*condition, "date").empty() ? Json(nullptr) : condition->at("date");
  json["temperature_k"] = number(number_of(*condition, "temperature_k"));
  json["verdict"] = condition->at("verdict");
  json["failure"] = condition->at("failure");
  for (const char* metric : kComparedMetrics)
    json[metric] = usable && scores != metrics_of.end() ? scores->at(metric) : Json(nullptr);
  return json;
}

Json conditions_json_of(const std::vector<Compared>& results) {
  std::vector<std::pair<std::string, std::string>> ids;  // condition and channel
  for (const Compared& compared : results) {
    for (const Json& condition : compared.result.at("conditions")) {
      for (const auto& [channel, unused] : condition.at("metrics").items()) {
        const std::pair<std::string, std::string> id{text_of(condition, "id"), channel};
        if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
      }
    }
  }
  Json list = Json::array();
  for (const auto& [id, channel] : ids) {
    Json json{{"id", id}, {"channel", channel}};
    Json scores = Json::array();
    for (const Compared& compared : results) {
      const Json* condition = find_condition(compared.result, id);
      if (condition != nullptr && !json.contains("waveform")) {
        for (const char* key : {"waveform", "frequency_hz", "leak_level"}) {
          const auto found = condition->find(key);
          json[key] = found == condition->end() ? Json(nullptr) : *found;
        }
      }
      scores.push_back(score_of(condition, channel, is_usable(compared.result)));
    }
    json["scores"] = std::move(scores);
    list.push_back(std::move(json));
  }
  return list;
}

/// Means over the conditions that both have, and in how many of them the other is the better.
Json metric_against(const Json& conditions, const std::string& channel, const char* metric,
                    std::size_t other) {
  const bool higher_is_better = std::string_view(metric) != "absolute_error_percent";
  int better = 0;
  int worse = 0;
  int pairs = 0;
  double first_sum = 0.0;
  double other_sum = 0.0;
  for (const Json& condition : conditions) {
    if (text_of(condition, "channel") != channel) continue;
    const Json& scores = condition.at("scores");
    if (!scores[0].is_object() || !scores[other].is_object()) continue;
    const auto a = number_of(scores[0], metric);
    const auto b = number_of(scores[other], metric);
    if (!a || !b) continue;
    ++pairs;
    first_sum += *a;
    other_sum += *b;
    if (*a == *b) continue;
    ++((*b > *a) == higher_is_better ? better : worse);
  }
  if (pairs == 0) return nullptr;
  const double p = metrics::sign_test_p_value(better, worse);
  Json json;
  json["conditions"] = pairs;
  json["mean_of_first"] = number(first_sum / pairs);
  json["mean"] = number(other_sum / pairs);
  json["better"] = better;
  json["worse"] = worse;
  json["p_value"] = number(p);
  json["significant"] = p < kSignificant;
  return json;
}

Json metrics_json_of(const Json& conditions, std::size_t count) {
  std::vector<std::string> channels;
  for (const Json& condition : conditions) {
    const std::string channel = text_of(condition, "channel");
    if (std::find(channels.begin(), channels.end(), channel) == channels.end())
      channels.push_back(channel);
  }
  Json list = Json::array();
  for (const std::string& channel : channels) {
    for (const char* metric : kComparedMetrics) {
      Json against = Json::array({nullptr});
      for (std::size_t i = 1; i < count; ++i)
        against.push_back(metric_against(conditions, channel, metric, i));
      list.push_back({{"channel", channel}, {"metric", metric}, {"against_first", against}});
    }
  }
  return list;
}

Json records_json_of(const std::vector<Compared>& results) {
  std::vector<std::map<std::string, std::string>> hashes;
  std::set<std::pair<std::string, std::string>> all;  // file and hash
  for (const Compared& compared : results) {
    hashes.push_back(record_hashes(compared.result));
    for (const auto& [hash, file] : hashes.back()) all.emplace(file, hash);
  }
  Json list = Json::array();
  std::set<std::string> listed;
  for (const auto& [file, hash] : all) {
    // The same content under another name is the same record.
    if (!listed.insert(hash).second) continue;
    Json in = Json::array();
    for (const auto& each : hashes) in.push_back(each.contains(hash));
    list.push_back({{"file", file}, {"sha256", hash}, {"in", in}});
  }
  return list;
}

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

/// What a leak is a leak of: estimates of equal name are points of one trend.
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

Json trend_json(const Json& points, const Along& along) {
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
  if (x.size() < 3 || *low == *high) {
    json["reason"] = x.empty()      ? "no estimate has it"
                     : x.size() < 3 ? "fewer than three estimates with an error"
                                    : "all estimates are at the same place";
    return json;
  }
  const metrics::Trend trend = metrics::weighted_trend(x, y, error);
  json[along.per_unit] = number(trend.slope);
  json["intercept"] = number(trend.intercept);
  json["standard_error"] = number(trend.slope_standard_error);
  json["ci95"] = Json::array({number(trend.ci95_low), number(trend.ci95_high)});
  json["p_value"] = number(trend.p_value);
  json["reduced_chi_square"] = number(trend.reduced_chi_square);
  json["significant"] = trend.p_value < kSignificant;
  return json;
}

Json leak_trends_json(const std::vector<Compared>& results) {
  std::vector<std::pair<std::string, Json>> series;
  for (const Compared& compared : results) {
    if (!is_usable(compared.result)) continue;
    for (const Json& parameter : compared.result.at("parameters")) {
      if (text_of(parameter, "key") != "leakage_coefficient" || !parameter.at("fitted").get<bool>())
        continue;
      const std::string name = series_of(compared.result, parameter);
      auto found = std::find_if(series.begin(), series.end(),
                                [&](const auto& each) { return each.first == name; });
      if (found == series.end()) found = series.insert(series.end(), {name, Json::array()});
      Json point;
      point["result"] = compared.name;
      point["level"] = parameter.at("level");
      point["day"] = number(mean_over(compared.result, parameter, [](const Json& condition) {
        return day_of(text_of(condition, "date"));
      }));
      point["temperature_k"] =
          number(mean_over(compared.result, parameter, [](const Json& condition) {
            return number_of(condition, "temperature_k");
          }));
      point["value"] = parameter.at("value");
      point["standard_error"] = number(error_of(parameter));
      point["ci95"] = parameter.at("ci95");
      found->second.push_back(std::move(point));
    }
  }
  Json list = Json::array();
  for (const auto& [name, points] : series) {
    Json json{{"of", name}, {"points", points}};
    for (const Along& along : kAlong) json[along.trend] = trend_json(points, along);
    list.push_back(std::move(json));
  }
  return list;
}

Json comparison_warnings(const std::vector<Compared>& results) {
  Json list = Json::array();
  for (const Compared& compared : results) {
    const std::string status = text_of(compared.result, "status");
    if (status != "converged")
      list.push_back(
          fmt::format("{}: {}: {}", compared.name, status, text_of(compared.result, "message")));
    if (text_of(compared.result, "verdict") == "FAIL")
      list.push_back(fmt::format("{}: outside the campaign's limits (FAIL)", compared.name));
  }
  for (std::size_t i = 1; i < results.size(); ++i) {
    if (share_records(results[0].result, results[i].result)) {
      list.push_back(fmt::format(
          "{} and {} share {}: their estimates are not independent, so that no significance "
          "is given for differences between them",
          results[0].name, results[i].name,
          is_of_tables(results[i].result) ? "published numbers" : "records"));
    }
  }
  return list;
}

}  // namespace

std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders) {
  const std::vector<std::string> names = short_names(folders);
  std::vector<Compared> results;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    const ReadFile read = files_in(folders[i]);
    for (const char* name : {"fit.json", "validation.json"}) {
      if (!read(name)) continue;
      Json result = load_json(read, folders[i].string(), name);
      if (result.is_object() && is_of_tables(result)) result["conditions"] = Json::array();
      results.push_back({names[i], folders[i] / name, std::move(result)});
      break;
    }
    if (results.size() == i + 1) continue;
    throw InputError({folders[i].string()},
                     "found neither fit.json nor validation.json; expected the folder of a fit or "
                     "validation");
  }
  return results;
}

Json comparison_json(const std::vector<Compared>& results, const Provenance& provenance) {
  for (const Compared& compared : results) {
    // Each on its own, so that the error can name the file.
    try {
      compared_result_json(compared);
      parameters_json_of({compared});
      models_json({compared, compared});
      conditions_json_of({compared});
    } catch (const Json::exception& error) {
      throw InputError(
          {compared.file.string()},
          fmt::format("the result is not as this version writes it: {}", error.what()));
    }
  }
  const auto usable = std::count_if(results.begin(), results.end(),
                                    [](const Compared& each) { return is_usable(each.result); });
  Json json;
  json["status"] = usable >= 2 ? "done" : "failed";
  json["schema"] = kComparisonSchema;
  json["results"] = Json::array();
  for (const Compared& compared : results)
    json["results"].push_back(compared_result_json(compared));
  json["parameters"] = parameters_json_of(results);
  json["conditions"] = conditions_json_of(results);
  json["metrics"] = metrics_json_of(json["conditions"], results.size());
  json["models"] = models_json(results);
  json["records"] = records_json_of(results);
  json["leak_trends"] = leak_trends_json(results);
  json["warnings"] = comparison_warnings(results);
  json["provenance"] = provenance_json(provenance);
  return json;
}

}  // namespace rigcal::report
