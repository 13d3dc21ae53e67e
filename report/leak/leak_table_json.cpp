#include "report/leak/leak_table.hpp"

namespace rigcal::report {
namespace {

using datasets::Feature;

/// Every value that the computation used; those that no section states are the campaign's.
Json assumptions_json(const LeakTableResult& result) {
  const auto values = datasets::leak_table_values(result.campaign, result.settings);
  const auto table = model::parameter_table(result.campaign.rig.plant);
  Json list = Json::array();
  const auto add = [&](const model::ParameterSpec& spec, double value, const std::string& source) {
    Json json;
    json["name"] = std::string(spec.name);
    json["key"] = std::string(spec.key);
    json["value"] = number(value);
    json["unit"] = std::string(spec.unit);
    json["source"] = source;
    list.push_back(std::move(json));
  };
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].key == "leakage_coefficient") continue;  // what the table varies
    const auto* assumption = result.settings.assumption(static_cast<int>(i));
    if (!values.given[i] && table[i].kind != model::ParameterKind::plant) continue;
    add(table[i], values.value[i], assumption == nullptr ? "campaign file" : assumption->source);
  }
  if (const auto* scale = result.settings.assumption(datasets::kResidualScale)) {
    add(datasets::assumption_spec(result.campaign.rig.plant, datasets::kResidualScale),
        scale->value, scale->source);
  }
  return list;
}

void put_signal(Json& json, const LeakTableResult& result, const datasets::LeakSignal& signal) {
  const bool closed_loop = result.campaign.rig.controller == model::ControllerKind::pid;
  json["waveform"] = std::string(to_string(signal.waveform));
  json["frequency_hz"] = number(signal.frequency_hz);
  json[closed_loop ? "amplitude_m" : "amplitude_v"] = number(signal.amplitude);
}

Json entry_json(const LeakTableResult& result, const calib::LeakEntry& entry) {
  Json json;
  put_signal(json, result, entry.signal);
  json["target_percent"] = number(entry.target_percent);
  json["coefficients"] = Json::array();
  json["coefficients_ci95"] = Json::array();
  json["log_slopes"] = Json::array();
  bool determined = !entry.roots.empty();
  for (const calib::LeakRoot& root : entry.roots) {
    json["coefficients"].push_back(number(root.coefficient));
    const auto range = root.ci95();
    json["coefficients_ci95"].push_back(
        range ? Json::array({number(range->front()), number(range->back())}) : Json(nullptr));
    json["log_slopes"].push_back(number(root.log_slope));
    determined = determined && root.determined();
  }
  json["log_slope"] = entry.roots.empty() ? Json(nullptr) : number(entry.roots.front().log_slope);
  json["determined"] = determined;
  const auto& c = entry.comparison;
  json["published_coefficient"] = c ? number(c->published) : Json(nullptr);
  json["relative_error_percent"] = c ? number(c->relative_error_percent) : Json(nullptr);
  json["share_at_published_percent"] = c ? number(c->share_percent) : Json(nullptr);
  json["share_by_rounding_percent"] =
      c ? Json::array({number(c->share_low_percent), number(c->share_high_percent)})
        : Json(nullptr);
  json["grade"] = std::string(to_string(entry.grade));
  json["note"] = entry.note;
  return json;
}

Json feature_json(const calib::FeatureRow& row) {
  const auto printed = [&](Feature feature, double unit) {
    const auto found = row.printed.printed.find(feature);
    return found == row.printed.printed.end() ? Json(nullptr) : number(found->second / unit);
  };
  Json json;
  json["level"] = row.printed.level;
  json["coefficient"] = number(row.printed.coefficient);
  json["servo_flow_l_per_min"] = number(row.servo_flow_m3_per_s / kLitrePerMinute);
  json["published_servo_flow_l_per_min"] = printed(Feature::servo_flow, kLitrePerMinute);
  json["leak_flow_l_per_min"] = number(row.leak_flow_m3_per_s / kLitrePerMinute);
  json["published_leak_flow_l_per_min"] = printed(Feature::leak_flow, kLitrePerMinute);
  json["mean"] = number(row.features.mean);
  json["published_mean"] = printed(Feature::mean, 1.0);
  json["rms"] = number(row.features.rms);
  json["published_rms"] = printed(Feature::rms, 1.0);
  json["std"] = number(row.features.std);
  json["published_std"] = printed(Feature::std, 1.0);
  json["coefficients_for_published_leak_flow"] = row.coefficients_for_leak_flow;
  json["left_out_of_fit"] = Json::array();
  for (const Feature feature : row.printed.left_out) {
    json["left_out_of_fit"].push_back(std::string(to_string(feature)));
  }
  json["reason"] = row.printed.reason.empty() ? Json(nullptr) : Json(row.printed.reason);
  return json;
}

Json summary_json(const calib::LeakSummary& summary) {
  Json json;
  json["published"] = summary.published;
  json["within_10_percent"] = summary.within_10;
  json["within_16_percent"] = summary.within_16;
  json["share_rms_percent"] = number(summary.share_rms_percent);
  return json;
}

}  // namespace

Json leak_table_json(const LeakTableResult& result) {
  Json json;
  json["status"] = "done";
  json["schema"] = kLeakTableSchema;
  json["campaign"] = result.campaign.name;
  json["share"] = "mean |Q_leak| / mean |Q_servo| over one period, periodic";
  json["residual"] = "|position without leak - position with leak| times residual_scale";
  json["interval"] =
      "95 % of each coefficient by the covariance of the fit, to first order in the fit's values: "
      "ln C moves by -(d ln s / dp) / (d ln s / d ln C); null without a fit";
  json["notes"] = result.notes;
  json["warnings"] = result.warnings;
  json["assumptions"] = assumptions_json(result);
  json["fixed_combinations"] = Json::array();
  for (const calib::FixedCombination& combination : result.table.fixed_combinations) {
    Json entry;
    entry["name"] = std::string(combination.name);
    entry["formula"] = std::string(combination.formula);
    entry["value"] = number(combination.value);
    entry["unit"] = std::string(combination.unit);
    json["fixed_combinations"].push_back(std::move(entry));
  }
  json["entries"] = Json::array();
  for (const calib::LeakEntry& entry : result.table.entries) {
    json["entries"].push_back(entry_json(result, entry));
  }
  json["summary"] = summary_json(result.table.summary);
  json["normal"] = Json::array();
  for (const calib::NormalEntry& normal : result.table.normals) {
    Json entry;
    put_signal(entry, result, normal.signal);
    entry["published_coefficient"] = number(normal.coefficient);
    entry["share_at_published_percent"] = number(normal.share_percent);
    json["normal"].push_back(std::move(entry));
  }
  json["features"] = Json::array();
  for (const calib::FeatureRow& row : result.table.features) {
    json["features"].push_back(feature_json(row));
  }
  json["provenance"] = provenance_json(result.provenance);
  return json;
}

}  // namespace rigcal::report
