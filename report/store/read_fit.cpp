#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "common/error.hpp"
#include "metrics/distributions.hpp"
#include "report/json/json_node.hpp"
#include "report/json/read_json.hpp"
#include "report/store/json.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::report {
namespace {

using datasets::FittedValue;
using datasets::Scope;

constexpr const char* kTruthSchema = "rigcal.truth/1";

/// Computes an error for a parameter that the fit could not determine, from its interval or its
/// bounds. Otherwise its uncertainty would be omitted.
double undetermined_error(const calib::FittedParameter& p, const JsonNode& node) {
  if (!p.lower) node["lower"].fail("a number");
  if (!p.upper) node["upper"].fail("a number");
  return calib::undetermined_sd(p.ci95, *p.lower, *p.upper);
}

/// The estimates of a fit, except nuisance parameters, with their covariance.
struct Estimates {
  std::vector<calib::EstimateSpread::Estimate> list;
  Eigen::MatrixXd covariance;  ///< SI, from the larger of standard and robust error
  /// Estimates for single conditions whose correlations are not stored, with their errors.
  std::map<std::string, std::vector<std::pair<calib::EstimateSpread::Estimate, double>>> own;
  std::vector<const calib::Budget95*> budgets;  ///< parallel to `list`; null without a budget
  double widened = 1.0;  ///< largest ratio of an interval to the normal one with its error
};

/// Returns the half width of ci95_if_exact in units of the standard error; 0 without a finite
/// interval.
double half_in_errors(const calib::FittedParameter& p, double error) {
  const auto& ci95 = p.ci95_if_exact;
  if (!ci95 || !std::isfinite(ci95->high - ci95->low)) return 0.0;
  return 0.5 * (ci95->high - ci95->low) / error;
}

/// Refuses a matrix that is not a correlation matrix.
void require_correlations(const calib::Correlation& stored, const JsonNode& matrix) {
  const auto size = static_cast<Eigen::Index>(stored.names.size());
  if (stored.matrix.rows() != size || stored.matrix.cols() != size)
    matrix.fail("one row and one column per name");
  if (calib::are_correlations(stored.matrix)) return;
  matrix.fail(
      "correlations: numbers from -1 to 1, the same on both sides of a diagonal of ones, by which "
      "no combination of the parameters has a negative variance");
}

Estimates estimates_of(const StoredFit& stored, const JsonNode& root, model::PlantKind plant) {
  const std::vector<std::string>& names = stored.correlation.names;
  const JsonNode matrix = root["correlation"]["matrix"];
  const std::vector<JsonNode> nodes = root["parameters"].items();
  Estimates result;
  require_correlations(stored.correlation, matrix);
  std::vector<std::optional<Eigen::Index>> places;  // rows in the correlation matrix
  std::vector<double> errors;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const calib::FittedParameter& p = stored.parameters[i];
    if (!p.fitted || p.nuisance) continue;
    const auto place =
        std::find(names.begin(), names.end(), parameter_label(p.name, p.scope, p.level));
    const auto error = error_of(p);
    const calib::EstimateSpread::Estimate estimate{parameter_row(nodes[i]["name"], plant), p.scope,
                                                   p.level.value_or("")};
    if (p.scope == Scope::condition && error && *error > 0.0 && place == names.end()) {
      result.own[estimate.level].emplace_back(estimate, *error);
      result.widened = std::max(result.widened, half_in_errors(p, *error) / metrics::kNormal95);
      continue;
    }
    result.list.push_back(estimate);
    result.budgets.push_back(p.budget ? &*p.budget : nullptr);
    const bool determined = error && place != names.end();
    places.push_back(determined ? std::optional<Eigen::Index>(place - names.begin())
                                : std::nullopt);
    errors.push_back(determined ? *error : undetermined_error(p, nodes[i]));
    if (determined && *error > 0.0)
      result.widened = std::max(result.widened, half_in_errors(p, *error) / metrics::kNormal95);
  }
  result.covariance = calib::covariance_of(errors, places, stored.correlation.matrix);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (places[i] && result.covariance.row(static_cast<Eigen::Index>(i)).hasNaN())
      matrix.items()[static_cast<std::size_t>(*places[i])].fail("one number per name");
  }
  return result;
}

/// Lists the dates of the fitted conditions without duplicates; empty if one of them has no date.
std::vector<std::string> dates_of_fit(const StoredFit& stored) {
  std::vector<std::string> dates;
  for (const calib::ConditionResult& condition : stored.conditions) {
    if (condition.use != datasets::Use::fit) continue;
    if (!condition.date) return {};
    if (std::find(dates.begin(), dates.end(), *condition.date) == dates.end())
      dates.push_back(*condition.date);
  }
  return dates;
}

void read_covariance(const StoredFit& stored, const JsonNode& root, model::PlantKind plant,
                     EarlierFit& fit) {
  const Estimates estimates = estimates_of(stored, root, plant);
  std::vector<Eigen::Index> of_rig;
  for (std::size_t i = 0; i < estimates.list.size(); ++i) {
    if (estimates.list[i].scope != Scope::rig) continue;
    of_rig.push_back(static_cast<Eigen::Index>(i));
    fit.indices.push_back(estimates.list[i].index);
  }
  fit.covariance = estimates.covariance(of_rig, of_rig);
  if (stored.status != calib::FitStatus::converged) return;
  fit.spread = calib::EstimateSpread{estimates.list,
                                     estimates.widened * calib::square_root(estimates.covariance)};
  fit.spread->dates = dates_of_fit(stored);
  if (stored.considered)
    fit.spread->effects = calib::effect_spread(*stored.considered, estimates.budgets);
  for (const auto& [condition, values] : estimates.own) {
    std::vector<calib::EstimateSpread::Estimate> own;
    std::vector<double> errors;
    for (const auto& [estimate, error] : values) {
      own.push_back(estimate);
      errors.push_back(estimates.widened * error);
    }
    calib::add_own(std::move(own), errors, *fit.spread);
  }
}

/// Returns an aspect of the stored assessment. Fits by older versions have no assessment; for them
/// the aspect is not assessed.
calib::Aspect judged(const StoredFit& stored, calib::Aspect calib::Assessment::*member) {
  if (stored.assessment) return (*stored.assessment).*member;
  calib::Aspect aspect;
  aspect.reasons.push_back(
      calib::reason(calib::AspectState::not_assessed, "no_assessment",
                    "the fit.json of the values has no assessment of its parameters"));
  return aspect;
}

/// Reads the fitted values, and the known values with scope rig.
void read_values(const StoredFit& stored, const JsonNode& root, model::PlantKind plant,
                 EarlierFit& fit) {
  const std::vector<JsonNode> nodes = root["parameters"].items();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const calib::FittedParameter& p = stored.parameters[i];
    FittedValue value;
    value.index = parameter_row(nodes[i]["name"], plant);
    value.scope = p.scope;
    if (p.scope != Scope::rig) {
      if (!p.level) nodes[i]["level"].fail("a text");
      value.level = *p.level;
    }
    // A nuisance parameter applies only to the records of its own fit.
    if (p.nuisance || (!p.fitted && !std::isfinite(p.value))) continue;
    if (!std::isfinite(p.value)) nodes[i]["value"].fail("a number");
    value.value = p.value;
    if (p.fitted) {
      fit.values.push_back(std::move(value));
    } else if (value.scope == Scope::rig) {
      fit.known.push_back(std::move(value));
    }
  }
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
  if (!is_fit_schema(root["schema"].string())) {
    root["schema"].fail(fmt::format("\"{}\"", kFitSchema));
  }
  StoredFit stored;
  read_into(root, stored);
  as_of_now(stored.schema, stored.parameters);
  if (stored.status == calib::FitStatus::failed) {
    throw InputError({name}, fmt::format("this fit failed ({}), its values mean nothing; expected "
                                         "one that converged",
                                         stored.message));
  }
  EarlierFit result;
  result.status = stored.status;
  result.verdict = stored.verdict;
  result.message = stored.message;
  read_values(stored, root, plant, result);
  result.validity = stored.validity;
  if (stored.validated) result.validated = *stored.validated;
  read_covariance(stored, root, plant, result);
  for (const calib::ConditionResult& condition : stored.conditions)
    result.conditions.emplace_back(condition.id, condition.use);
  for (const InputFile& input : stored.provenance.inputs)
    result.input_hashes.push_back(input.sha256);
  result.adequacy = judged(stored, &calib::Assessment::adequacy);
  result.parameters = judged(stored, &calib::Assessment::parameters);
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
