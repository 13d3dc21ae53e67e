#include "report/store/identity.hpp"

#include <algorithm>

namespace rigcal::report {
namespace {

Json fields_json(const datasets::ReportSettings::Fields& fields) {
  Json json = Json::object();
  for (const auto& [key, text] : fields) json[key] = text;
  return json;
}

}  // namespace

Json identity_json(const datasets::Campaign& campaign) {
  std::string first;
  std::string last;
  for (const datasets::Condition& condition : campaign.conditions) {
    // ISO 8601 dates can be compared as text.
    if (condition.use == datasets::Use::ignore || !condition.date) continue;
    first = first.empty() ? *condition.date : std::min(first, *condition.date);
    last = std::max(last, *condition.date);
  }
  if (campaign.report.empty() && first.empty()) return nullptr;
  Json json = fields_json(campaign.report.fields);
  json["test_dates"] = first.empty() ? Json(nullptr) : Json::array({first, last});
  json["sensors"] = Json::array();
  for (const auto& sensor : campaign.report.sensors) json["sensors"].push_back(fields_json(sensor));
  return json;
}

}  // namespace rigcal::report
