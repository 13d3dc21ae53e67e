#include "report/store/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "datasets/prepare/repeatability.hpp"
#include "metrics/metric_table.hpp"
#include "report/store/identity.hpp"
#include "report/store/residual_tests_json.hpp"
#include "report/store/stored_provenance.hpp"
#include "report/store/trust_json.hpp"
#include "report/store/weights_json.hpp"
#include "report/text/groups.hpp"

namespace rigcal::report {
namespace {

using datasets::Scope;

template <typename Enum>
Json text_or_null(const std::optional<Enum>& value) {
  return value ? Json(std::string(to_string(*value))) : Json(nullptr);
}

Json text_or_null(const std::optional<std::string>& text) {
  return text ? Json(*text) : Json(nullptr);
}

Json range_json(const std::optional<Range>& range) {
  return range ? Json::array({number(range->low), number(range->high)}) : Json(nullptr);
}

Json parameter_json(const calib::FittedParameter& p, const model::ParameterSpec& spec) {
  std::string reason = p.reason;
  if (!std::isfinite(p.value)) {
    reason += std::string(reason.empty() ? "" : "; ") +
              (std::isinf(p.value) && !p.fitted ? "no limit" : "the value is not a finite number");
  }
  Json json;
  json["name"] = std::string(spec.name);
  json["key"] = std::string(spec.key);
  json["symbol"] = std::string(spec.symbol);
  json["unit"] = std::string(spec.unit);
  json["scope"] = std::string(to_string(p.scope));
  json["level"] = p.scope == Scope::rig ? Json(nullptr) : Json(p.level);
  json["value"] = number(p.value);
  json["start"] = number(p.start);
  json["lower"] = p.fitted ? number(p.lower) : Json(nullptr);
  json["upper"] = p.fitted ? number(p.upper) : Json(nullptr);
  json["fitted"] = p.fitted;
  json["nuisance"] = p.nuisance;
  json["standard_error"] = number(p.standard_error);
  json["robust_standard_error"] = number(p.robust_standard_error);
  json["ci95"] =
      p.ci95 ? Json::array({number(p.ci95->first), number(p.ci95->second)}) : Json(nullptr);
  json["ci95_from"] = p.ci95 ? Json(std::string(to_string(p.interval))) : Json(nullptr);
  add_intervals(p, json);
  json["at_bound"] = p.at_bound;
  json["identifiability"] =
      p.fitted ? Json(std::string(to_string(p.identifiability))) : Json(nullptr);
  json["reason"] = reason;
  return json;
}

Json parameter_list(const Result& result) {
  const auto table = model::parameter_table(result.campaign.rig.plant);
  Json list = Json::array();
  for (const calib::FittedParameter& p : result.fit.parameters) {
    list.push_back(parameter_json(p, table[static_cast<std::size_t>(p.index)]));
  }
  return list;
}

Json validity_json(const Result& result) {
  const bool closed_loop = result.campaign.rig.controller == model::ControllerKind::pid;
  const auto use = result.kind == ResultKind::fit
                       ? std::vector<datasets::Use>{datasets::Use::fit}
                       : std::vector<datasets::Use>{datasets::Use::fit, datasets::Use::validate};
  const Validity validity = coverage(result.campaign, result.records, result.fit, use);
  Json json;
  json["frequency_hz"] = range_json(validity.frequency_hz);
  json["amplitude_m"] = closed_loop ? range_json(validity.amplitude) : Json(nullptr);
  json["amplitude_v"] = closed_loop ? Json(nullptr) : range_json(validity.amplitude);
  json["supply_pressure_pa"] = range_json(validity.supply_pressure_pa);
  json["leakage_coefficient"] = range_json(validity.leakage_coefficient);
  json["leak_levels"] = validity.leak_levels;
  return json;
}

Json agreement_json(const metrics::Agreement& agreement) {
  Json json;
  for (const metrics::MetricSpec& metric : metrics::kMetrics) {
    json[std::string(metric.name)] = number(agreement.*metric.value);
  }
  return json;
}

Json score_json(const calib::ChannelScore& score) {
  Json json;
  for (const metrics::MetricSpec& metric : metrics::kMetrics) {
    json[std::string(metric.name)] =
        score.agreement ? number((*score.agreement).*metric.value) : Json(nullptr);
  }
  json["gain_ratio"] = number(score.gain_ratio);
  json["phase_deg"] = number(score.phase_deg);
  json["delay_s"] = number(score.delay_s);
  json["problem"] = score.problem.empty() ? Json(nullptr) : Json(score.problem);
  return json;
}

Json noise_floor_json(const std::optional<metrics::NoiseFloor>& floor) {
  if (!floor) return nullptr;
  Json json;
  json["rho2"] = number(floor->rho2);
  json["ccc"] = number(floor->ccc);
  json["absolute_error_percent"] = number(floor->absolute_error_percent);
  return json;
}

/// [start, end] in seconds of each part that counts; empty: the whole record.
Json windows_json(const datasets::Record& record) {
  Json list = Json::array();
  for (const datasets::TimeWindow& window : record.windows) {
    list.push_back(Json::array({number(window.start_s), number(window.end_s)}));
  }
  return list;
}

Json acceptance_json(const std::vector<datasets::AcceptanceLimit>& limits) {
  Json list = Json::array();
  for (const datasets::AcceptanceLimit& limit : limits) {
    Json json;
    json["channel"] = std::string(info(limit.channel).key);
    json["metric"] = limit.metric;
    json["limit"] = number(limit.limit);
    json["warn"] = number(limit.warn);
    list.push_back(std::move(json));
  }
  return list;
}

Json checks_json(const calib::ConditionScore& score) {
  Json list = Json::array();
  for (const calib::LimitCheck& check : score.checks) {
    Json json;
    json["channel"] = std::string(info(check.channel).key);
    json["metric"] = check.metric;
    json["value"] = number(check.value);
    json["limit"] = number(check.limit);
    json["warn"] = number(check.warn);
    json["tolerance_used"] = check.value ? number(check.used) : Json(nullptr);
    json["verdict"] = std::string(to_string(check.verdict));
    list.push_back(std::move(json));
  }
  return list;
}

/// The worst of the checks of every channel that has some.
Json channel_verdicts_json(const calib::ConditionScore& score) {
  std::map<datasets::Channel, calib::Verdict> worst;
  for (const calib::LimitCheck& check : score.checks)
    worst[check.channel] = std::max(worst[check.channel], check.verdict);
  Json json = Json::object();
  for (const auto& [channel, verdict] : worst)
    json[std::string(info(channel).key)] = std::string(to_string(verdict));
  return json;
}

Json aspect_json(const calib::Aspect& aspect) {
  Json json;
  json["state"] = std::string(to_string(aspect.state));
  json["reasons"] = Json::array();
  for (const calib::Reason& reason : aspect.reasons) {
    Json entry;
    entry["code"] = reason.code;
    entry["state"] = std::string(to_string(reason.state));
    entry["subject"] = reason.subject.empty() ? Json(nullptr) : Json(reason.subject);
    entry["numbers"] = Json::object();
    for (const auto& [name, value] : reason.numbers) entry["numbers"][name] = number(value);
    entry["words"] = reason.words;
    json["reasons"].push_back(std::move(entry));
  }
  return json;
}

Json assessment_json(const calib::Assessment& assessment) {
  Json json;
  json["agreement"] = aspect_json(assessment.agreement);
  json["validation"] = aspect_json(assessment.validation);
  json["adequacy"] = aspect_json(assessment.adequacy);
  json["parameters"] = aspect_json(assessment.parameters);
  return json;
}

Json condition_json(const Result& result, const calib::ConditionScore& score) {
  const bool closed_loop = result.campaign.rig.controller == model::ControllerKind::pid;
  const datasets::Condition* condition = result.campaign.find(score.id);
  Json json;
  json["id"] = score.id;
  if (condition != nullptr) {
    json["waveform"] = std::string(to_string(condition->waveform));
    json["frequency_hz"] = number(condition->frequency_hz);
    json["amplitude_m"] = closed_loop ? number(condition->amplitude) : Json(nullptr);
    if (!closed_loop) json["amplitude_v"] = number(condition->amplitude);
    json["leak_level"] = text_or_null(condition->leak_level);
  }
  json["use"] = std::string(to_string(score.use));
  if (condition != nullptr && condition->temperature_k) {
    json["temperature_k"] = number(condition->temperature_k);
  }
  if (condition != nullptr && condition->date) json["date"] = *condition->date;
  json["samples"] = score.samples;
  const auto record = std::find_if(result.records.begin(), result.records.end(),
                                   [&](const auto& r) { return r.condition == score.id; });
  if (record != result.records.end()) {
    json["windows_s"] = windows_json(*record);
    json["notes"] = record->notes;
  }
  if (condition != nullptr && condition->acceptance) {
    json["acceptance"] = acceptance_json(*condition->acceptance);
  }
  json["warnings"] = score.data_warnings;
  json["not_scored"] = score.not_scored.empty() ? Json(nullptr) : Json(score.not_scored);
  json["failure"] = score.failure.empty() ? Json(nullptr) : Json(score.failure);
  json["metrics"] = Json::object();
  json["noise_floor"] = Json::object();
  json["residual_tests"] = Json::object();
  for (const calib::ChannelScore& channel : score.channels) {
    const std::string key(info(channel.channel).key);
    json["residual_tests"][key] =
        channel.residual_tests
            ? residual_tests_json(*channel.residual_tests, info(channel.channel).unit)
            : Json(nullptr);
    json["metrics"][key] = score_json(channel);
    json["noise_floor"][key] = noise_floor_json(channel.noise_floor);
  }
  json["limit_checks"] = checks_json(score);
  json["channel_verdicts"] = channel_verdicts_json(score);
  json["verdict"] = text_or_null(score.verdict);
  json["reasons"] = score.reasons;
  return json;
}

Json groups_json(const Result& result) {
  Json list = Json::array();
  for (const Group& group : groups(result.campaign, result.fit)) {
    Json json;
    json["by"] = group.by;
    json["label"] = group.label;
    json["conditions"] = group.conditions;
    json["metrics"] = Json::object();
    for (const auto& [channel, score] : group.channels) {
      Json& entry = json["metrics"][std::string(info(channel).key)];
      entry["conditions"] = score.conditions;
      entry["mean"] = agreement_json(score.mean);
      entry["worst"] = agreement_json(score.worst);
    }
    list.push_back(std::move(json));
  }
  return list;
}

Json starts_json(const calib::Fit& fit) {
  Json list = Json::array();
  for (const calib::StartReport& start : fit.starts) {
    Json json;
    json["number"] = start.number;
    json["status"] = std::string(to_string(start.status));
    json["message"] = start.message;
    json["start_values"] = numbers(start.start_values);
    json["end_values"] = numbers(start.end_values);
    const bool simulated = !start.end_values.empty();
    json["initial_cost"] = simulated ? number(start.initial_cost) : Json(nullptr);
    json["final_cost"] = simulated ? number(start.final_cost) : Json(nullptr);
    json["iterations"] = start.iterations;
    list.push_back(std::move(json));
  }
  return list;
}

Json failures_json(const calib::Fit& fit) {
  Json list = Json::array();
  for (const calib::SimulationFailure& failure : fit.failures) {
    Json json;
    json["condition"] = failure.condition;
    json["start"] = failure.start;
    json["time_s"] = number(failure.time_s);
    json["reason"] = failure.reason;
    json["parameters"] = Json::object();
    for (const auto& [name, value] : failure.parameters) json["parameters"][name] = number(value);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json correlation_json(const std::vector<std::string>& names, const Eigen::MatrixXd& correlation) {
  Json matrix = Json::array();
  for (Eigen::Index i = 0; i < correlation.rows(); ++i) {
    Json row = Json::array();
    for (Eigen::Index j = 0; j < correlation.cols(); ++j) row.push_back(number(correlation(i, j)));
    matrix.push_back(std::move(row));
  }
  Json json;
  json["names"] = names;
  json["matrix"] = std::move(matrix);
  return json;
}

Json result_json(const Result& result) {
  const calib::Fit& fit = result.fit;
  Json json;
  json["status"] = std::string(to_string(status_of(fit)));
  json["stopped_in"] = fit.stopped_in == calib::StoppedIn::nothing
                           ? Json(nullptr)
                           : Json(std::string(to_string(fit.stopped_in)));
  json["schema"] = result.kind == ResultKind::fit ? kFitSchema : kValidationSchema;
  json["verdict"] = text_or_null(fit.verdict);
  json["assessment"] = assessment_json(fit.assessment);
  json["message"] = fit.message;
  json["campaign"] = result.campaign.name;
  json["synthetic"] = result.campaign.synthetic;
  json["report"] = identity_json(result.campaign);
  json["model"] = std::string(to_string(result.campaign.rig.plant));
  // Without a start nothing was estimated. A cost of zero would look like a perfect fit.
  const bool has_cost = status_of(fit) != calib::FitStatus::failed && !fit.starts.empty();
  json["cost"] = has_cost ? number(fit.cost) : Json(nullptr);
  json["residual_count"] = fit.residual_count;
  json["evaluations"] = fit.evaluations;
  json["wall_seconds"] = number(fit.wall_seconds);
  json["simulation_tolerance"] = number(fit.tolerance);
  json["parameters"] = parameter_list(result);
  json["correlation"] = correlation_json(fit.correlation_names, fit.correlation);
  json["rank"] = fit.rank;
  json["singular_values"] = numbers(fit.singular_values);
  json["reduced_chi_square"] = fit.rank > 0 ? number(fit.reduced_chi_square) : Json(nullptr);
  add_trust(fit, json);
  if (result.kind == ResultKind::fit) json["weights"] = weights_json(result);
  json["validity"] = validity_json(result);
  json["acceptance"] = acceptance_json(result.campaign.acceptance);
  json["conditions"] = Json::array();
  for (const calib::ConditionScore& score : fit.conditions) {
    json["conditions"].push_back(condition_json(result, score));
  }
  json["groups"] = groups_json(result);
  json["starts"] = starts_json(fit);
  json["best_start"] = fit.best_start;
  json["failure_count"] = fit.failure_count;
  json["failures"] = failures_json(fit);
  json["warnings"] = fit.warnings;
  json["provenance"] = json_of(stored(result.provenance));
  return json;
}

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json record_json(const datasets::Condition& condition, const datasets::Record& record) {
  const auto& time_s = record.time_s;
  const double duration_s = time_s.empty() ? 0.0 : time_s.back() - time_s.front();
  Json json;
  json["condition"] = condition.id;
  json["use"] = std::string(to_string(condition.use));
  json["samples"] = time_s.size();
  json["sample_rate_hz"] = duration_s > 0.0
                               ? number(static_cast<double>(time_s.size() - 1) / duration_s)
                               : Json(nullptr);
  json["duration_s"] = number(duration_s);
  json["repeats"] = record.repeats;
  json["files"] = Json::array();
  for (const FileState& file : record.files) json["files"].push_back(file.path);
  json["channels"] = Json::object();
  for (const datasets::Repeatability& r : datasets::repeatability(record)) {
    Json& channel = json["channels"][std::string(info(r.channel).key)];
    channel["unit"] = std::string(info(r.channel).unit);
    channel["repeats"] = r.repeats;
    channel["pooled_sd"] = number(r.pooled_sd);
    channel["sd_of_mean"] = number(r.sd_of_mean);
    channel["noise_floor"] = noise_floor_json(r.noise_floor);
  }
  json["offset_range_s"] = number(datasets::offset_range_s(record));
  json["repeat_reports"] = Json::array();
  for (const datasets::RepeatReport& repeat : record.repeat_reports) {
    Json entry;
    entry["source"] = repeat.source;
    entry["offset_s"] = number(repeat.offset_s);
    entry["deviation"] = number(repeat.deviation);
    entry["outlier"] = repeat.outlier;
    json["repeat_reports"].push_back(std::move(entry));
  }
  json["windows_s"] = windows_json(record);
  json["notes"] = record.notes;
  json["warnings"] = record.warnings;
  return json;
}

Json parameters_json(model::PlantKind plant) {
  Json list = Json::array();
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    Json json;
    json["key"] = std::string(spec.key);
    json["name"] = std::string(spec.name);
    json["symbol"] = std::string(spec.symbol);
    json["unit"] = std::string(spec.unit);
    json["default"] = number(spec.default_value);
    json["lower"] = number(spec.lower);
    json["upper"] = number(spec.upper);
    json["kind"] = std::string(to_string(spec.kind));
    json["can_be_fitted"] = spec.can_be_fitted;
    json["meaning"] = std::string(spec.meaning);
    json["source"] = std::string(spec.source);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace rigcal::report
