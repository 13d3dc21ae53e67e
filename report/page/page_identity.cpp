#include <fmt/format.h>

#include "datasets/campaign/report_settings.hpp"
#include "report/page/page_parts.hpp"

namespace rigcal::report {
namespace {

/// Describes a sensor: "LVDT, serial number 4711, DKD 17, due 2027-01-31". Marks a sensor whose
/// calibration was overdue on the last day of the test.
doc::Line sensor_line(const Json& sensor, const std::string& tested) {
  doc::Line line;
  for (const datasets::ReportField& field : datasets::kSensorFields) {
    const std::string text = text_of(sensor, std::string(field.key));
    if (text.empty() || field.key == "channel") continue;
    if (!line.empty()) line.emplace_back(", ");
    if (field.key == "instrument") {
      line.emplace_back(text);
      continue;
    }
    std::string words(field.label);
    words.front() = static_cast<char>(words.front() | 0x20);  // ASCII, to lower case
    words.append(" ").append(text);
    // ISO 8601 dates sort as text.
    const bool overdue = field.key == "due" && !tested.empty() && text.substr(0, 10) < tested;
    line.push_back(overdue ? doc::Inline(doc::Badge{doc::State::bad, words}) : doc::Inline(words));
  }
  return line;
}

}  // namespace

Identity identity_of(const Json& report) {
  Identity identity;
  if (!report.is_object()) return identity;
  identity.number = text_of(report, "number");
  if (const std::string revision = text_of(report, "revision"); !revision.empty())
    identity.number += ", revision " + revision;
  identity.replaces = text_of(report, "replaces");
  identity.issued = text_of(report, "issued");
  identity.laboratory = text_of(report, "laboratory");
  identity.customer = text_of(report, "customer");
  identity.rig = text_of(report, "rig");
  identity.facts.label = "Item and method";
  identity.facts.shape = doc::Facts::Shape::grid;
  const auto add = [&](std::string_view label, const std::string& value) {
    if (!value.empty()) identity.facts.rows.push_back({std::string(label), {value}});
  };
  std::string tested;
  if (const Json& dates = report.at("test_dates"); dates.is_array()) {
    const std::string first = dates[0].get<std::string>();
    const std::string last = dates[1].get<std::string>();
    tested = last.substr(0, 10);
    add("Tested", first == last ? first : fmt::format("{} to {}", first, last));
  }
  for (const datasets::ReportField& field : datasets::kReportFields) {
    if (field.is_fact) add(field.label, text_of(report, std::string(field.key)));
  }
  for (const Json& sensor : report.at("sensors")) {
    const std::string channel = text_of(sensor, "channel");
    identity.facts.rows.emplace_back(
        channel.empty() ? std::string("Sensor") : "Sensor: " + spaced(channel),
        sensor_line(sensor, tested));
  }
  // The operator signs for the test.
  const std::string tester = text_of(report, "operator");
  std::string approver = text_of(report, "approver");
  if (const std::string function = text_of(report, "approver_function"); !function.empty())
    approver += ", " + function;
  if (!tester.empty() || !approver.empty())
    identity.signatures.rows = {{"Tested by", tester}, {"Approved by", approver}};
  return identity;
}

}  // namespace rigcal::report
