#include "report/trust_json.hpp"

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
    tests.push_back(std::move(json));
  }
  Json json;
  json["misfit"] = fit.misfit ? Json(*fit.misfit) : Json(nullptr);
  json["tests"] = std::move(tests);
  return json;
}

Json basins_json(const calib::Fit& fit) {
  Json list = Json::array();
  for (const calib::Basin& basin : fit.basins) {
    Json json;
    json["cost"] = number(basin.cost);
    json["starts"] = basin.starts;
    json["values"] = Json::array();
    for (const double value : basin.values) json["values"].push_back(number(value));
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

void add_trust(const calib::Fit& fit, Json& json) {
  const bool solved = fit.rank > 0;
  json["effective_samples"] =
      fit.effective_samples > 0.0 ? number(fit.effective_samples) : Json(nullptr);
  json["interval_advice"] = fit.interval_advice;
  json["combinations"] = fit.combinations;
  json["lack_of_fit"] = lack_of_fit_json(fit);
  json["basins"] = basins_json(fit);
  json["agreement"] = fit.agreement;
  json["aic"] = solved ? number(fit.aic) : Json(nullptr);
  json["bic"] = solved ? number(fit.bic) : Json(nullptr);
}

}  // namespace rigcal::report
