#include "report/comparison/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/error.hpp"
#include "report/comparison/comparison_models.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

/// A member of a foreign result; null where it has none.
///
/// @throws nlohmann::json::exception  it is of another kind than Value
template <typename Value>
Json member(const Json& result, const char* key) {
  const auto found = result.find(key);
  if (found == result.end() || found->is_null()) return nullptr;
  static_cast<void>(found->get<Value>());
  return *found;
}

Json compared_result_json(const Compared& compared) {
  const Json& result = compared.result;
  Json json;
  json["name"] = compared.name;
  json["file"] = compared.file.string();
  for (const char* key : {"schema", "status", "verdict", "message", "campaign", "model"})
    json[key] = member<std::string>(result, key);
  json["synthetic"] = member<bool>(result, "synthetic");
  for (const char* key : {"cost", "residual_count", "reduced_chi_square", "independent_residuals"})
    json[key] = member<double>(result, key);
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
          "{} and {} share {}: their estimates are not independent, so differences between "
          "them are not tested for significance",
          results[0].name, results[i].name,
          is_of_tables(results[i].result) ? "published numbers" : "records"));
    }
  }
  return list;
}

/// @throws nlohmann::json::exception  a result is not what this version writes
Json made_comparison(const std::vector<Compared>& results, const Provenance& provenance) {
  const auto usable = std::count_if(results.begin(), results.end(),
                                    [](const Compared& each) { return is_usable(each.result); });
  Json json;
  json["status"] = usable >= 2 ? "done" : "failed";
  json["schema"] = kComparisonSchema;
  json["results"] = Json::array();
  for (const Compared& compared : results)
    json["results"].push_back(compared_result_json(compared));
  json["parameters"] = compared_parameters(results);
  json["significance"] = tested_parameters(json["parameters"], results.size());
  json["conditions"] = compared_conditions(results);
  json["metrics"] = compared_metrics(json["conditions"], results);
  json["models"] = models_json(results);
  json["records"] = compared_records(results);
  json["leak_trends"] = leak_trends(results);
  json["warnings"] = comparison_warnings(results);
  json["provenance"] = json_of(stored(provenance));
  return json;
}

}  // namespace

Json comparison_json(const std::vector<Compared>& results, const Provenance& provenance) {
  try {
    return made_comparison(results, provenance);
  } catch (const Json::exception& error) {
    // Each with itself, so that the error can name the file.
    for (const Compared& result : results) {
      try {
        made_comparison({result, result}, provenance);
      } catch (const Json::exception& of_result) {
        refuse_json(result.file.string(), of_result);
      }
    }
    refuse_json(results.back().file.string(), error);  // which shows beside another alone
  }
}

}  // namespace rigcal::report
