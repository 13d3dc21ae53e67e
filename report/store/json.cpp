#include "report/store/json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "datasets/prepare/repeatability.hpp"

namespace rigcal::report {
namespace {

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

std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string json_line(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
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
