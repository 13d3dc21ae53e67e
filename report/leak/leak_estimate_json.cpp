#include "report/leak/leak_estimate_json.hpp"

#include <algorithm>
#include <string>

namespace rigcal::report {

Json interval_json(const std::pair<double, double>& range, double scale) {
  return Json::array({number(scale * range.first), number(scale * range.second)});
}

Json leak_estimate_json(const diagnosis::LeakEstimate& estimate,
                        const std::optional<datasets::LeakClass>& leak_class, bool ok) {
  const auto value = [&](double x) { return ok ? number(x) : Json(nullptr); };
  Json json;
  json["leakage_coefficient"] = value(std::max(0.0, estimate.coefficient));
  json["ci95"] = ok ? interval_json(estimate.ci95) : Json(nullptr);
  json["standard_error"] = value(estimate.standard_error);
  json["leak_share_percent"] = value(kInPercent * estimate.share);
  json["leak_share_ci95_percent"] =
      ok ? interval_json(estimate.share_ci95, kInPercent) : Json(nullptr);
  json["leak_share_upper_limit_percent"] = ok && estimate.share_upper_limit
                                               ? number(kInPercent * *estimate.share_upper_limit)
                                               : Json(nullptr);
  json["leak_flow_l_per_min"] = value(kLitresPerMinute * estimate.leak_flow_m3_per_s);
  json["leak_detected"] = ok ? Json(estimate.leak_detected) : Json(nullptr);
  json["class"] = ok && leak_class ? Json(std::string(to_string(*leak_class))) : Json(nullptr);
  json["class_probabilities"] = Json::object();
  for (std::size_t i = 0; i < diagnosis::kClassCount; ++i) {
    json["class_probabilities"][std::string(to_string(datasets::kLeakClasses[i]))] =
        value(estimate.probability[i]);
  }
  return json;
}

}  // namespace rigcal::report
