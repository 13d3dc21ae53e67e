#include "report/store/trust_json.hpp"

namespace rigcal::report {
namespace {

Json lack_of_fit_json(const calib::Fit& fit) {
  Json tests = Json::array();
  for (const calib::LackOfFit& test : fit.lack_of_fit) {
    Json json;
    json["condition"] = test.condition;
    json["channel"] = std::string(info(test.channel).key);
    json["against"] = test.by_repeats ? "repeats" : "sd";
    json["ratio"] = number(test.ratio);
    json["freedom"] = number(test.freedom);
    json["pure_error_freedom"] = number(test.pure_freedom);
    json["p"] = number(test.p);
    json["outcome"] = std::string(metrics::to_string(test.outcome));
    json["reason"] = test.reason.empty() ? Json(nullptr) : Json(test.reason);
    tests.push_back(std::move(json));
  }
  Json json;
  json["misfit"] = fit.misfit ? Json(*fit.misfit) : Json(nullptr);
  json["tests"] = std::move(tests);
  return json;
}

Json between_repeats_json(const std::optional<calib::BetweenRepeats>& repeats) {
  if (!repeats) return nullptr;
  Json json;
  json["differ"] = repeats->differ;
  json["p"] = number(repeats->p);
  json["ratio"] = number(repeats->ratio);
  json["parameters"] = repeats->parameters;
  json["cause"] = repeats->cause.empty() ? Json(nullptr) : Json(repeats->cause);
  json["cause_sd"] = repeats->cause.empty() ? Json(nullptr) : number(repeats->cause_sd);
  json["cause_explains"] = repeats->cause.empty() ? Json(nullptr) : number(repeats->cause_explains);
  return json;
}

Json basins_json(const calib::Fit& fit) {
  Json list = Json::array();
  for (const calib::Basin& basin : fit.basins) {
    Json json;
    json["cost"] = number(basin.cost);
    json["starts"] = basin.starts;
    json["values"] = numbers(basin.values);
    list.push_back(std::move(json));
  }
  return list;
}

Json profile_end(const calib::ProfileEnd& end) {
  Json json;
  json["value"] = number(end.value);
  json["reached"] = number(end.reached);
  json["lost"] = end.lost;
  return json;
}

Json rms_json(const std::vector<std::pair<datasets::Channel, double>>& values) {
  Json json = Json::object();
  for (const auto& [channel, value] : values) json[std::string(info(channel).key)] = number(value);
  return json;
}

Json cross_validation_json(const calib::Fit& fit) {
  Json list = Json::array();
  for (const calib::HeldOut& held : fit.cross_validation) {
    Json json;
    json["condition"] = held.condition;
    json["problem"] = held.problem.empty() ? Json(nullptr) : Json(held.problem);
    json["rmse"] = rms_json(held.rms);
    json["fitted_rmse"] = rms_json(held.fitted_rms);
    json["largest_shift"] = held.problem.empty() ? number(held.largest_shift) : Json();
    json["shifted"] = held.shifted.empty() ? Json(nullptr) : Json(held.shifted);
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

void add_intervals(const calib::FittedParameter& parameter, Json& json) {
  if (parameter.bootstrap) {
    Json& entry = json["bootstrap"];
    entry["standard_error"] = number(parameter.bootstrap->standard_error);
    entry["bias"] = number(parameter.bootstrap->bias);
    entry["freedom"] = number(parameter.bootstrap->freedom);
    entry["ci95"] = Json::array(
        {number(parameter.bootstrap->ci95.first), number(parameter.bootstrap->ci95.second)});
  }
  if (parameter.profile) {
    Json& entry = json["profile"];
    entry["low"] = profile_end(parameter.profile->low);
    entry["high"] = profile_end(parameter.profile->high);
    entry["values"] = numbers(parameter.profile->values);
    entry["rises"] = numbers(parameter.profile->rises);
  }
}

void add_trust(const calib::Fit& fit, Json& json) {
  const bool solved = fit.rank > 0;
  json["independent_residuals"] =
      fit.independent_residuals > 0.0 ? number(fit.independent_residuals) : Json(nullptr);
  json["interval_advice"] = fit.interval_advice;
  json["combinations"] = fit.combinations;
  json["lack_of_fit"] = lack_of_fit_json(fit);
  json["between_repeats"] = between_repeats_json(fit.between_repeats);
  json["basins"] = basins_json(fit);
  json["agreement"] = fit.agreement;
  if (!fit.bootstrap_message.empty()) {
    json["bootstrap"]["replicates"] = fit.bootstrap_replicates;
    json["bootstrap"]["message"] = fit.bootstrap_message;
  }
  if (!fit.cross_validation.empty()) json["cross_validation"] = cross_validation_json(fit);
  json["aic"] = solved ? number(fit.aic) : Json(nullptr);
  json["bic"] = solved ? number(fit.bic) : Json(nullptr);
}

}  // namespace rigcal::report
