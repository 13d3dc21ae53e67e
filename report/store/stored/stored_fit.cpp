#include "report/store/stored/stored_fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/problem/known_sd.hpp"
#include "report/store/identity.hpp"
#include "report/store/stored/stored_residual_tests.hpp"
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

void add_checks(const calib::ConditionScore& score, StoredCondition& condition) {
  condition.limit_checks = score.checks;
  std::set<datasets::Channel> judged;
  for (const calib::LimitCheck& check : score.checks) judged.insert(check.channel);
  for (const datasets::Channel channel : judged)
    condition.channel_verdicts.emplace_back(key_of(channel), score.verdict_of(channel).value());
}

void add_stated(const Result& result, const calib::ConditionScore& score, StoredCondition& stated) {
  const datasets::Condition* condition = result.campaign.find(score.id);
  if (condition == nullptr) return;
  stated.waveform = std::optional(condition->waveform);
  stated.frequency_hz = condition->frequency_hz;
  calib::put_amplitude(info(drive_channel(result.campaign)).unit, condition->amplitude, stated);
  stated.leak_level = condition->leak_level;
  if (condition->temperature_k) stated.temperature_k = *condition->temperature_k;
  if (condition->date) stated.date = *condition->date;
  if (condition->acceptance) stated.acceptance = *condition->acceptance;
  if (!condition->not_judged.empty()) stated.not_judged = keys_of(condition->not_judged);
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

StoredCondition stored(const Result& result, const calib::ConditionScore& score) {
  StoredCondition condition;
  condition.id = score.id;
  add_stated(result, score, condition);
  condition.use = score.use;
  condition.samples = score.samples;
  if (const datasets::Record* record = record_of(result, score.id)) {
    condition.record_sha256 = hashes_of(result, *record);
    condition.windows_s.emplace();
    for (const datasets::TimeWindow& window : record->windows)
      condition.windows_s->push_back({window.start_s, window.end_s});
    condition.notes = record->notes;
  }
  condition.warnings = score.data_warnings;
  condition.not_scored = unless_empty(score.not_scored);
  condition.failure = unless_empty(score.failure);
  condition.expanded_uncertainty.emplace();
  condition.two_sided_uncertainty.emplace();
  for (const calib::ChannelScore& channel : score.channels) {
    const std::string key = key_of(channel.channel);
    condition.metrics.emplace_back(key, channel.metrics);
    condition.noise_floor.emplace_back(key, channel.noise_floor);
    condition.expanded_uncertainty->emplace_back(key, channel.expanded_uncertainty);
    condition.two_sided_uncertainty->emplace_back(key, channel.two_sided_uncertainty);
    if (!channel.budgets.empty()) {
      if (!condition.score_budgets) condition.score_budgets.emplace();
      condition.score_budgets->emplace_back(key, channel.budgets);
    }
    auto& tests =
        condition.residual_tests.emplace_back(channel.channel, channel.residual_tests).second;
    if (tests) add_verdicts(*tests, info(channel.channel).unit);
  }
  add_checks(score, condition);
  condition.verdict = score.verdict;
  condition.reasons = score.reasons;
  return condition;
}

void add_trust(const calib::Fit& fit, StoredFit& result) {
  result.considered = fit.considered;
  const bool solved = fit.rank > 0;
  result.rank = fit.rank;
  result.singular_values = fit.singular_values;
  result.correlation = fit.correlation;
  if (solved) {
    result.reduced_chi_square = finite(fit.reduced_chi_square);
    result.aic = finite(fit.aic);
    result.bic = finite(fit.bic);
  }
  result.independent_residuals =
      fit.independent_residuals > 0.0 ? finite(fit.independent_residuals) : std::nullopt;
  result.interval_advice = fit.interval_advice;
  result.combinations = fit.combinations;
  result.lack_of_fit = std::optional(fit.lack_of_fit);
  result.between_repeats = fit.between_repeats;
  result.basins = fit.basins;
  result.agreement = fit.agreement;
  result.bootstrap = fit.bootstrap;
  result.posterior = fit.posterior;
  if (!fit.cross_validation.empty()) result.cross_validation = fit.cross_validation;
}

void add_search(const calib::Fit& fit, StoredFit& result) {
  result.starts = fit.starts;
  result.best_start = fit.best_start;
  result.failure_count = fit.failure_count;
  result.failures = fit.failures;
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

std::optional<calib::Verdict> StoredCondition::verdict_of(const std::string& channel) const {
  if (failure) return verdict;
  const calib::Verdict* found = find(channel_verdicts, channel);
  return found == nullptr ? std::nullopt : std::optional(*found);
}

const metrics::Agreement* StoredCondition::printed_uncertainty_of(
    const std::string& channel) const {
  const auto& all = two_sided_uncertainty ? two_sided_uncertainty : expanded_uncertainty;
  if (!all) return nullptr;
  const auto* found = report::find(*all, channel);
  return found != nullptr && found->has_value() ? &**found : nullptr;
}

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

calib::Badness badness(const StoredCondition& condition, const std::string& channel) {
  calib::Badness found{condition.failure || condition.not_scored,
                       channel.empty() ? condition.verdict : condition.verdict_of(channel)};
  for (const calib::LimitCheck& check : condition.limit_checks)
    if (channel.empty() || info(check.channel).key == channel) found.add(check);
  for (const auto& [key, scores] : condition.metrics)
    if (channel.empty() || key == channel) found.add_rho2(scores.rho2);
  return found;
}

std::optional<double> periodic_frequency(const StoredCondition& condition) {
  if (!condition.waveform || !datasets::is_periodic(*condition.waveform)) return std::nullopt;
  return condition.frequency_hz;
}

const StoredCondition* StoredFit::find(const std::string& condition) const {
  const auto found = std::find_if(conditions.begin(), conditions.end(),
                                  [&](const auto& each) { return each.id == condition; });
  return found == conditions.end() ? nullptr : &*found;
}

StoredFit stored(const Result& result) {
  const calib::Fit& fit = result.fit;
  StoredFit json;
  json.status = status_of(fit);
  if (fit.stopped_in != calib::StoppedIn::nothing) json.stopped_in = std::optional(fit.stopped_in);
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
  json.parameters = fit.parameters;
  for (calib::FittedParameter& each : json.parameters) each.reason = reason_of(each);
  add_trust(fit, json);
  if (!fit.stability.empty()) json.stability = fit.stability;
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
  add_search(fit, json);
  json.warnings = fit.warnings;
  json.provenance = stored(result.provenance);
  return json;
}

}  // namespace rigcal::report
