#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "metrics/significance.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

constexpr std::array kComparedMetrics{"rho2", "ccc", "absolute_error_percent"};

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

/// Means over the conditions that both have, and in how many of them the other is the better.
Json metric_against(const Json& conditions, const std::string& channel, const char* metric,
                    std::size_t other, bool shared) {
  const bool higher_is_better = std::string_view(metric) != "absolute_error_percent";
  int better = 0;
  int worse = 0;
  int pairs = 0;
  double first_sum = 0.0;
  double other_sum = 0.0;
  for (const Json& condition : conditions) {
    if (text_of(condition, "channel") != channel) continue;
    const Json& scores = condition.at("scores");
    if (!scores.at(0).is_object() || !scores.at(other).is_object()) continue;
    const auto a = number_of(scores.at(0), metric);
    const auto b = number_of(scores.at(other), metric);
    if (!a || !b) continue;
    ++pairs;
    first_sum += *a;
    other_sum += *b;
    if (*a == *b) continue;
    ++((*b > *a) == higher_is_better ? better : worse);
  }
  if (pairs == 0) return nullptr;
  Json json;
  json["conditions"] = pairs;
  json["mean_of_first"] = number(first_sum / pairs);
  json["mean"] = number(other_sum / pairs);
  json["better"] = better;
  json["worse"] = worse;
  json["p_value"] = json["significant"] = json["reason"] = nullptr;
  const int untied = better + worse;
  if (shared) {
    json["reason"] = "not tested: the results share records, so their scores are not independent";
  } else if (untied < metrics::kLeastSignPairs) {
    json["reason"] = fmt::format("not tested: {} condition{}, and a sign test needs {}", untied,
                                 untied == 1 ? "" : "s", metrics::kLeastSignPairs);
  } else {
    const double p = metrics::sign_test_p_value(better, worse);
    json["p_value"] = number(p);
    json["significant"] = p < kSignificantLevel;
  }
  return json;
}

}  // namespace

Json compared_conditions(const std::vector<Compared>& results) {
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

Json compared_metrics(const Json& conditions, const std::vector<Compared>& results) {
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
      for (std::size_t i = 1; i < results.size(); ++i) {
        against.push_back(metric_against(conditions, channel, metric, i,
                                         share_records(results[0].result, results[i].result)));
      }
      list.push_back({{"channel", channel}, {"metric", metric}, {"against_first", against}});
    }
  }
  return list;
}

}  // namespace rigcal::report
