#include <fmt/format.h>

#include "datasets/campaign/report_settings.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {

Json identity_view(const Json& identity) {
  if (!identity.is_object()) return {{"there", false}};
  Json view{{"there", true}, {"facts", Json::array()}, {"sensors", Json::array()}};
  const auto add = [&](std::string_view label, const std::string& value) {
    if (!value.empty()) view["facts"].push_back({{"name", label}, {"value", value}});
  };
  for (const datasets::ReportField& field : datasets::kReportFields) {
    // The test comes before its report was issued.
    if (field.key == "laboratory") {
      const Json& dates = identity.at("test_dates");
      if (dates.is_array()) {
        const std::string first = dates[0].get<std::string>();
        const std::string last = dates[1].get<std::string>();
        add("Tested", first == last ? first : fmt::format("{} to {}", first, last));
      }
    }
    add(field.label, text_of(identity, std::string(field.key)));
  }
  for (const Json& sensor : identity.at("sensors")) {
    Json cells = Json::array();
    for (const datasets::ReportField& field : datasets::kSensorFields)
      cells.push_back({{"text", text_of(sensor, std::string(field.key))}});
    view["sensors"].push_back({{"cells", std::move(cells)}});
  }
  view["has_sensors"] = !view["sensors"].empty();
  view["sensor_titles"] = Json::array();
  for (const datasets::ReportField& field : datasets::kSensorFields)
    view["sensor_titles"].push_back({{"title", field.label}});
  view["operator"] = text_of(identity, "operator");
  view["approver"] = text_of(identity, "approver");
  // Somebody is to put their name to it.
  view["signed"] = !text_of(identity, "operator").empty() || !text_of(identity, "approver").empty();
  return view;
}

}  // namespace rigcal::report
