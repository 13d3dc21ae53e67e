#include "report/store/stored/stored_fit.hpp"

#include <algorithm>
#include <cmath>

#include "calib/problem/problem.hpp"
#include "report/store/identity.hpp"
#include "report/store/stored/stored_tables_fit.hpp"

namespace rigcal::report {
namespace {

std::string key_of(datasets::Channel channel) { return std::string(info(channel).key); }

std::vector<std::string> keys_of(const std::vector<datasets::Channel>& channels) {
  std::vector<std::string> keys;
  for (const datasets::Channel channel : channels) keys.push_back(key_of(channel));
  return keys;
}

/// Returns the reason with why the file has null as the value, if it has.
std::string reason_of(const calib::FittedParameter& p) {
  if (std::isfinite(p.value)) return p.reason;
  return p.reason + (p.reason.empty() ? "" : "; ") +
         (std::isinf(p.value) && !p.fitted ? "no limit" : "the value is not a finite number");
}

const datasets::Record* record_of(const Result& result, const std::string& condition) {
  const auto found = std::find_if(result.records.begin(), result.records.end(),
                                  [&](const auto& each) { return each.condition == condition; });
  return found == result.records.end() ? nullptr : &*found;
}

std::vector<StoredWeight> weights(const Result& result) {
  std::vector<StoredWeight> list;
  for (const calib::ConditionScore& score : result.fit.conditions) {
    const datasets::Record* record = record_of(result, score.id);
    if (score.use != datasets::Use::fit || record == nullptr) continue;
    for (const calib::ChannelScore& channel : score.channels) {
      const auto series = record->channels.find(channel.channel);
      if (series == record->channels.end()) continue;
      list.push_back({score.id, key_of(channel.channel), score.samples,
                      finite(calib::known_sd(result.campaign, channel.channel, series->second)),
                      finite(channel.metrics.rmse)});
    }
  }
  return list;
}

/// Returns the hashes of a record's files from the provenance.
std::vector<std::string> hashes_of(const Result& result, const datasets::Record& record) {
  std::vector<std::string> hashes;
  for (const FileState& file : record.files) {
    const auto& inputs = result.provenance.inputs;
    const auto found = std::find_if(inputs.begin(), inputs.end(), [&](const InputFile& input) {
      return input.path == file.path;
    });
    if (found != inputs.end()) hashes.push_back(found->sha256);
  }
  return hashes;
}

calib::ConditionResult stored(const Result& result, const calib::ConditionScore& score) {
  calib::ConditionResult condition = score;
  if (const datasets::Record* record = record_of(result, score.id))
    condition.record_sha256 = hashes_of(result, *record);
  for (calib::ChannelScore& channel : condition.channels)
    if (channel.residual_tests) add_verdicts(*channel.residual_tests, info(channel.channel).unit);
  return condition;
}

/// Finds the degrees of freedom for which Student's t times this error gives the half width of
/// ci95_if_exact. A bound may cut off one end of the interval, so the longer side is used.
double freedom_of_interval(const calib::FittedParameter& parameter, double error) {
  const auto& interval = parameter.ci95_if_exact;
  if (!interval || !std::isfinite(parameter.value)) return metrics::kManyDegrees;
  const double quantile =
      std::max(interval->high - parameter.value, parameter.value - interval->low) / error;
  return metrics::freedom_of_quantile(quantile);
}

}  // namespace

void as_of_now(std::string_view schema, std::vector<calib::FittedParameter>& parameters) {
  if (schema == kFitSchema) return;
  for (calib::FittedParameter& each : parameters) {
    if (!each.ci95_if_exact && each.ci95) each.ci95_if_exact = *each.ci95;
  }
}

std::optional<metrics::EstimateError> interval_error(const calib::FittedParameter& parameter) {
  const auto& source = parameter.ci95_from;
  const auto error = source == calib::IntervalSource::standard_error ? parameter.standard_error
                     : source == calib::IntervalSource::robust_standard_error
                         ? parameter.robust_standard_error
                         : error_of(parameter);
  if (!error || !(*error > 0.0)) return std::nullopt;
  if (parameter.degrees_of_freedom && *parameter.degrees_of_freedom > 0.0)
    return metrics::EstimateError{*error, *parameter.degrees_of_freedom};
  return metrics::EstimateError{*error, freedom_of_interval(parameter, *error)};
}

std::optional<double> error_of(const calib::FittedParameter& parameter) {
  if (!parameter.standard_error) return parameter.robust_standard_error;
  return std::max(*parameter.standard_error, parameter.robust_standard_error.value_or(0.0));
}

StoredFit as_fit(const StoredTablesFit& tables) {
  StoredFit fit;
  fit.status = tables.status;
  fit.schema = tables.schema;
  fit.message = tables.message;
  fit.campaign = tables.campaign;
  fit.cost = tables.cost;
  fit.residual_count = tables.residual_count;
  fit.parameters = tables.parameters;
  fit.correlation = tables.correlation;
  fit.provenance = tables.provenance;
  return fit;
}

std::optional<double> periodic_frequency(const calib::ConditionResult& condition) {
  if (!condition.waveform || !datasets::is_periodic(*condition.waveform)) return std::nullopt;
  return condition.frequency_hz;
}

const calib::ConditionResult* StoredFit::find(const std::string& condition) const {
  const auto found = std::find_if(conditions.begin(), conditions.end(),
                                  [&](const auto& each) { return each.id == condition; });
  return found == conditions.end() ? nullptr : &*found;
}

StoredFit stored(const Result& result) {
  const calib::Fit& fit = result.fit;
  StoredFit json;
  json.status = status_of(fit);
  json.stopped_in = fit.stopped_in;
  json.schema = result.kind == ResultKind::fit ? kFitSchema : kValidationSchema;
  json.verdict = fit.verdict;
  json.assessment = std::optional(fit.assessment);
  json.message = fit.message;
  json.campaign = result.campaign.name;
  json.synthetic = result.campaign.synthetic;
  json.report = identity_json(result.campaign);
  json.model = std::optional(result.campaign.rig.plant);
  // Without any start nothing was estimated, and a cost of zero would look like a perfect fit.
  if (json.status != calib::FitStatus::failed && !fit.starts.empty()) json.cost = finite(fit.cost);
  json.residual_count = fit.residual_count;
  json.evaluations = fit.evaluations;
  json.wall_seconds = finite(fit.wall_seconds);
  json.simulation_tolerance = finite(fit.tolerance);
  json.findings() = Inlined<calib::Findings>(fit);
  for (calib::FittedParameter& each : json.parameters) each.reason = reason_of(each);
  if (result.kind == ResultKind::fit) json.weights = weights(result);
  using datasets::Use;
  const auto covered = [&](const std::vector<Use>& uses) {
    return calib::coverage(result.campaign, result.records, fit, uses);
  };
  json.validity =
      result.kind == ResultKind::fit ? covered({Use::fit}) : covered({Use::fit, Use::validate});
  const bool validated = std::any_of(fit.conditions.begin(), fit.conditions.end(),
                                     [](const auto& score) { return score.use == Use::validate; });
  if (validated) json.validated = covered({Use::validate});
  json.decision = result.campaign.acceptance_bounds.decision;
  json.acceptance = result.campaign.acceptance;
  const auto& not_judged = result.campaign.acceptance_bounds.not_judged;
  if (!not_judged.empty()) json.not_judged = keys_of(not_judged);
  for (const calib::ConditionScore& score : fit.conditions)
    json.conditions.push_back(stored(result, score));
  json.groups = calib::groups(result.campaign, fit);
  json.search() = Inlined<calib::SearchOutcome>(fit);
  json.warnings = fit.warnings;
  json.provenance = stored(result.provenance);
  return json;
}

}  // namespace rigcal::report
