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

/// A fit with the name of its file for messages.
struct NamedFit {
  const StoredFit& stored;
  const std::string& file;

  template <typename T>
  [[noreturn]] void refuse(const std::string& key, const T& found,
                           const std::string& expected) const {
    JsonNode(json_of(found), file, key, "fit.json").fail(expected);
  }

  /// Returns the row of parameter `i` in the table of the plant.
  int row(std::size_t i, model::PlantKind plant) const {
    const Json name = stored.parameters[i].name;
    return parameter_row({name, file, fmt::format("parameters[{}].name", i), "fit.json"}, plant);
  }
};

/// Computes an error for a parameter that the fit could not determine, from its interval or its
/// bounds. Otherwise its uncertainty would be omitted.
double undetermined_error(const NamedFit& fit, std::size_t i) {
  const calib::FittedParameter& p = fit.stored.parameters[i];
  if (!p.lower) fit.refuse(fmt::format("parameters[{}].lower", i), p.lower, "a number");
  if (!p.upper) fit.refuse(fmt::format("parameters[{}].upper", i), p.upper, "a number");
  return calib::undetermined_sd(p.ci95, *p.lower, *p.upper);
}

/// The estimates of a fit, except nuisance parameters, with their covariance.
struct Estimates {
  std::vector<calib::EstimateCovariance::Estimate> list;
  Eigen::MatrixXd covariance;  ///< SI, from the larger of standard and robust error
  /// Estimates for single conditions whose correlations are not stored, with their errors.
  std::map<std::string, std::vector<std::pair<calib::EstimateCovariance::Estimate, double>>> own;
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
void require_correlations(const NamedFit& fit) {
  const Eigen::MatrixXd& matrix = fit.stored.correlation.matrix;
  const auto size = static_cast<Eigen::Index>(fit.stored.correlation.names.size());
  if (matrix.rows() != size || matrix.cols() != size)
    fit.refuse("correlation.matrix", matrix, "one row and one column per name");
  if (calib::are_correlations(matrix)) return;
  fit.refuse("correlation.matrix", matrix,
             "correlations: numbers from -1 to 1, the same on both sides of a diagonal of ones, "
             "without a negative variance for any combination of the parameters");
}

Estimates estimates_of(const NamedFit& fit, model::PlantKind plant) {
  const StoredFit& stored = fit.stored;
  const std::vector<std::string>& names = stored.correlation.names;
  Estimates result;
  require_correlations(fit);
  std::vector<std::optional<Eigen::Index>> places;  // rows in the correlation matrix
  std::vector<double> errors;
  for (std::size_t i = 0; i < stored.parameters.size(); ++i) {
    const calib::FittedParameter& p = stored.parameters[i];
    if (!p.fitted || p.nuisance) continue;
    const auto place =
        std::find(names.begin(), names.end(), parameter_label(p.name, p.scope, p.level));
    const auto error = error_of(p);
    const calib::EstimateCovariance::Estimate estimate{fit.row(i, plant), p.scope,
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
    errors.push_back(determined ? *error : undetermined_error(fit, i));
    if (determined && *error > 0.0)
      result.widened = std::max(result.widened, half_in_errors(p, *error) / metrics::kNormal95);
  }
  result.covariance = calib::covariance_of(errors, places, stored.correlation.matrix);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (!places[i] || !result.covariance.row(static_cast<Eigen::Index>(i)).hasNaN()) continue;
    const auto row = stored.correlation.matrix.row(*places[i]);
    fit.refuse(fmt::format("correlation.matrix[{}]", *places[i]),
               std::vector<double>(row.begin(), row.end()), "one number per name");
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

void read_covariance(const NamedFit& named, model::PlantKind plant, EarlierFit& fit) {
  const StoredFit& stored = named.stored;
  const Estimates estimates = estimates_of(named, plant);
  std::vector<Eigen::Index> of_rig;
  for (std::size_t i = 0; i < estimates.list.size(); ++i) {
    if (estimates.list[i].scope != Scope::rig) continue;
    of_rig.push_back(static_cast<Eigen::Index>(i));
    fit.indices.push_back(estimates.list[i].index);
  }
  fit.covariance = estimates.covariance(of_rig, of_rig);
  if (stored.status != calib::FitStatus::converged) return;
  fit.joint = calib::EstimateCovariance{
      estimates.list, estimates.widened * calib::square_root(estimates.covariance)};
  fit.joint->dates = dates_of_fit(stored);
  if (stored.considered)
    fit.joint->effects = calib::effect_covariance(*stored.considered, estimates.budgets);
  for (const auto& [condition, values] : estimates.own) {
    std::vector<calib::EstimateCovariance::Estimate> own;
    std::vector<double> errors;
    for (const auto& [estimate, error] : values) {
      own.push_back(estimate);
      errors.push_back(estimates.widened * error);
    }
    calib::add_own(std::move(own), errors, *fit.joint);
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
void read_values(const NamedFit& named, model::PlantKind plant, EarlierFit& fit) {
  for (std::size_t i = 0; i < named.stored.parameters.size(); ++i) {
    const calib::FittedParameter& p = named.stored.parameters[i];
    FittedValue value;
    value.index = named.row(i, plant);
    value.scope = p.scope;
    if (p.scope != Scope::rig) {
      if (!p.level) named.refuse(fmt::format("parameters[{}].level", i), p.level, "text");
      value.level = *p.level;
    }
    // A nuisance parameter applies only to the records of its own fit.
    if (p.nuisance || (!p.fitted && !std::isfinite(p.value))) continue;
    if (!std::isfinite(p.value))
      named.refuse(fmt::format("parameters[{}].value", i), p.value, "a number");
    value.value = p.value;
    if (p.fitted) {
      fit.values.push_back(std::move(value));
    } else if (value.scope == Scope::rig) {
      fit.known.push_back(std::move(value));
    }
  }
}

void require_fit(const NamedFit& fit) {
  if (!is_fit_schema(fit.stored.schema))
    fit.refuse("schema", fit.stored.schema, fmt::format("\"{}\"", kFitSchema));
}

}  // namespace

EarlierFit read_fit(const std::filesystem::path& file, model::PlantKind plant) {
  const Json json = read_json(file, "the fit.json of an earlier fit");
  const JsonNode root(json, file.string(), "", "fit.json");
  if (!json.is_object()) {
    throw InputError({file.string()},
                     "found no JSON object, expected the fit.json of an earlier fit");
  }
  StoredFit stored;
  stored.schema = root["schema"].string();
  require_fit({stored, file.string()});
  read_into(root, stored);
  as_of_now(stored.schema, stored.parameters);
  return earlier_fit(stored, file.string(), plant);
}

EarlierFit earlier_fit(const StoredFit& stored, const std::string& name, model::PlantKind plant) {
  const NamedFit named{stored, name};
  require_fit(named);
  if (stored.status == calib::FitStatus::failed) {
    throw InputError(
        {name},
        fmt::format(
            "this fit failed ({}), so its values are meaningless; expected one that converged",
            stored.message));
  }
  EarlierFit result;
  result.status = stored.status;
  result.verdict = stored.verdict;
  result.message = stored.message;
  read_values(named, plant, result);
  result.validity = stored.validity;
  if (stored.validated) result.validated = *stored.validated;
  read_covariance(named, plant, result);
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
