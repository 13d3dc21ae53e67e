#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/error.hpp"
#include "report/store/json.hpp"
#include "report/store/json_node.hpp"
#include "report/store/read_json.hpp"

namespace rigcal::report {
namespace {

using datasets::FittedValue;
using datasets::Scope;

constexpr const char* kTruthSchema = "rigcal.truth/1";

Validity read_validity(const JsonNode& node) {
  Validity validity;
  validity.frequency_hz = node["frequency_hz"].range();
  const JsonNode amplitude_m = node["amplitude_m"];
  validity.amplitude = amplitude_m.is_null() ? node["amplitude_v"].range() : amplitude_m.range();
  validity.supply_pressure_pa = node["supply_pressure_pa"].range();
  validity.leakage_coefficient = node["leakage_coefficient"].range();
  for (const JsonNode& level : node["leak_levels"].items()) {
    validity.leak_levels.push_back(level.string());
  }
  return validity;
}

/// Standard error of an entry of `parameters`: the larger of the two; empty where there is none.
std::optional<double> standard_error(const JsonNode& entry) {
  std::optional<double> largest;
  for (const char* key : {"standard_error", "robust_standard_error"}) {
    const JsonNode error = entry[key];
    if (!error.is_null()) largest = std::max(largest.value_or(0.0), error.real());
  }
  return largest;
}

double undetermined_error(const JsonNode& entry) {
  std::optional<std::pair<double, double>> ci95;
  if (const auto range = entry["ci95"].range()) ci95.emplace(range->low, range->high);
  return calib::undetermined_sd(ci95, entry["lower"].real(), entry["upper"].real());
}

/// Parameters of the rig with their covariance. One that the fit could not determine has no error:
/// it counts with its whole interval, or its bounds, else what it is unsure of would be left out.
void read_covariance(const JsonNode& root, model::PlantKind plant, EarlierFit& fit) {
  const auto names = root["correlation"]["names"].items();
  const auto rows = root["correlation"]["matrix"].items();
  std::vector<std::optional<std::size_t>> places;  // in the matrix
  std::vector<double> errors;
  for (const JsonNode& entry : root["parameters"].items()) {
    if (!entry["fitted"].boolean() || entry["nuisance"].boolean()) continue;
    if (one_of(entry["scope"], std::array{Scope::rig, Scope::leak_level, Scope::condition}) !=
        Scope::rig)
      continue;
    const std::string name = entry["name"].string();
    const auto place = std::find_if(names.begin(), names.end(),
                                    [&](const JsonNode& each) { return each.string() == name; });
    const auto error = standard_error(entry);
    fit.indices.push_back(parameter_row(entry["name"], plant));
    if (error && place != names.end()) {
      places.emplace_back(static_cast<std::size_t>(place - names.begin()));
      errors.push_back(*error);
    } else {
      places.emplace_back(std::nullopt);
      errors.push_back(undetermined_error(entry));
    }
  }
  const auto n = static_cast<Eigen::Index>(places.size());
  fit.covariance = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    fit.covariance(at, at) = errors[i] * errors[i];
    if (!places[i]) continue;
    if (*places[i] >= rows.size()) root["correlation"]["matrix"].fail("one row per name");
    const auto row = rows[*places[i]].items();
    for (std::size_t j = 0; j < places.size(); ++j) {
      if (!places[j]) continue;
      if (*places[j] >= row.size()) rows[*places[i]].fail("one number per name");
      fit.covariance(at, static_cast<Eigen::Index>(j)) =
          row[*places[j]].real() * errors[i] * errors[j];
    }
  }
}

/// What a fit of before there were assessments does not have.
calib::Aspect no_assessment() {
  calib::Aspect aspect;
  aspect.reasons.push_back({calib::AspectState::not_assessed,
                            "no_assessment",
                            "",
                            {},
                            "the fit.json of the values holds no assessment of its parameters"});
  return aspect;
}

calib::Aspect read_aspect(const JsonNode& node) {
  using calib::AspectState;
  const std::array states{AspectState::pass, AspectState::reservation, AspectState::fail,
                          AspectState::not_assessed};
  calib::Aspect aspect;
  aspect.state = one_of(node["state"], states);
  for (const JsonNode& entry : node["reasons"].items()) {
    calib::Reason& reason = aspect.reasons.emplace_back();
    reason.state = one_of(entry["state"], states);
    reason.code = entry["code"].string();
    if (!entry["subject"].is_null()) reason.subject = entry["subject"].string();
    reason.words = entry["words"].string();
    reason.numbers = entry["numbers"].numbers();
  }
  return aspect;
}

void read_origin(const Json& json, const JsonNode& root, EarlierFit& fit) {
  using datasets::Use;
  for (const JsonNode& entry : root["conditions"].items()) {
    fit.conditions.emplace_back(
        entry["id"].string(),
        one_of(entry["use"], std::array{Use::fit, Use::validate, Use::diagnose, Use::ignore}));
  }
  for (const JsonNode& input : root["provenance"]["inputs"].items())
    fit.input_hashes.push_back(input["sha256"].string());
  const auto judged = [&](const char* aspect) {
    return json.contains("assessment") ? read_aspect(root["assessment"][aspect]) : no_assessment();
  };
  fit.adequacy = judged("adequacy");
  fit.parameters = judged("parameters");
}

}  // namespace

EarlierFit read_fit(const std::filesystem::path& file, model::PlantKind plant) {
  return earlier_fit(read_json(file, "the fit.json of an earlier fit"), file.string(), plant);
}

EarlierFit earlier_fit(const Json& json, const std::string& name, model::PlantKind plant) {
  const JsonNode root(json, name, "", "fit.json");
  if (!json.is_object()) {
    throw InputError({name}, "found no JSON object, expected the fit.json of an earlier fit");
  }
  if (root["schema"].string() != kFitSchema) {
    root["schema"].fail(fmt::format("\"{}\"", kFitSchema));
  }
  using calib::FitStatus;
  EarlierFit result;
  result.status = one_of(root["status"],
                         std::array{FitStatus::converged, FitStatus::stopped, FitStatus::failed});
  result.message = root["message"].string();
  if (result.status == FitStatus::failed) {
    throw InputError({name}, fmt::format("this fit failed ({}), its values mean nothing; expected "
                                         "one that converged",
                                         result.message));
  }
  for (const JsonNode& entry : root["parameters"].items()) {
    FittedValue value;
    value.index = parameter_row(entry["name"], plant);
    value.scope =
        one_of(entry["scope"], std::array{Scope::rig, Scope::leak_level, Scope::condition});
    if (value.scope != Scope::rig) value.level = entry["level"].string();
    const bool fitted = entry["fitted"].boolean();
    // A nuisance parameter belongs to the records of its fit.
    if (entry["nuisance"].boolean() || (!fitted && entry["value"].is_null())) continue;
    value.value = entry["value"].real();
    if (fitted) {
      result.values.push_back(std::move(value));
    } else if (value.scope == Scope::rig) {
      result.known.push_back(std::move(value));
    }
  }
  result.validity = read_validity(root["validity"]);
  read_covariance(root, plant, result);
  read_origin(json, root, result);
  return result;
}

std::vector<FittedValue> read_truth(const std::filesystem::path& file, model::PlantKind plant) {
  const Json json = read_json(file, "the truth.json of a synthetic campaign");
  const JsonNode root(json, file.string(), "", "truth.json");
  if (root["schema"].string() != kTruthSchema)
    root["schema"].fail(fmt::format("\"{}\"", kTruthSchema));
  std::vector<FittedValue> values;
  for (const JsonNode& entry : root["parameters"].items()) {
    if (!entry["given"].boolean()) continue;
    FittedValue value;
    value.index = parameter_row(entry["name"], plant);
    value.scope =
        one_of(entry["scope"], std::array{Scope::rig, Scope::leak_level, Scope::condition});
    if (value.scope != Scope::rig) value.level = entry["level"].string();
    value.value = entry["value"].real();
    values.push_back(std::move(value));
  }
  return values;
}

}  // namespace rigcal::report
