#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "metrics/significance.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

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

/// Whether a value is zero or not significantly different from it, so that nothing is a percentage
/// of it.
bool may_be_zero(const Json& estimate) {
  if (number_of(estimate, "value").value_or(0.0) == 0.0) return true;
  const Json& ci = estimate.at("ci95");
  if (!ci.is_array() || !ci.at(0).is_number() || !ci.at(1).is_number()) return false;
  return ci.at(0).get<double>() <= 0.0 && ci.at(1).get<double>() >= 0.0;
}

/// `p_value` is that of this difference alone; `significant` is set later, for all together.
Json difference_json(const Json& first, const Json& other, bool same_records) {
  if (!first.is_object() || !other.is_object()) return nullptr;
  const auto a = number_of(first, "value");
  const auto b = number_of(other, "value");
  Json json;
  json["difference"] = a && b ? number(*b - *a) : Json(nullptr);
  json["percent"] = a && b && !may_be_zero(first) ? number(100.0 * (*b / *a - 1.0)) : Json(nullptr);
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
  if (!first_fitted && !other_fitted) return reason(kKnownInBoth);
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
    (*differences[i])["significant"] = adjusted[i] < kSignificantLevel;
  }
}

}  // namespace

Json compared_parameters(const std::vector<Compared>& results) {
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
        for (const char* key : {"name", "key", "symbol", "unit", "scope", "level"}) {
          text_of(*parameter, key);  // or else it is not what this version writes
          json[key] = parameter->at(key);
        }
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

std::string change_text(const Json& difference, const RowUnit& unit) {
  if (const auto percent = number_of(difference, "percent"))
    return fmt::format("{:+.3g} %", *percent);
  const auto absolute = number_of(difference, "difference");
  if (!absolute) return {};
  return fmt::format("{:+.2g}{}{}", *absolute / unit.si, unit.name.empty() ? "" : " ", unit.name);
}

bool worth_a_row(const Json& parameter) {
  for (const Json& estimate : parameter.at("estimates"))
    if (estimate.is_object() && estimate.at("fitted").get<bool>()) return true;
  for (const Json& difference : parameter.at("differences")) {
    if (difference.is_object() && number_of(difference, "difference").value_or(0.0) != 0.0)
      return true;
  }
  return false;
}

RowUnit unit_of_estimates(const Json& parameter) {
  double size = 0.0;
  for (const Json& estimate : parameter.at("estimates")) {
    if (estimate.is_object())
      size = std::max(size, std::abs(number_of(estimate, "value").value_or(0.0)));
  }
  return row_unit(size, parameter);
}

}  // namespace rigcal::report
