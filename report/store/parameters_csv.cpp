#include "report/store/parameters_csv.hpp"

#include <fmt/format.h>

#include "report/store/csv_fields.hpp"
#include "report/store/json_fields.hpp"

namespace rigcal::report {
namespace {

std::string yes_or_no(const Json& value) { return value.get<bool>() ? "1" : "0"; }

std::string end_of(const Json& pair, std::size_t end) {
  return pair.is_array() && pair[end].is_number() ? csv_number(pair[end].get<double>())
                                                  : std::string();
}

std::string row_of(const Json& p) {
  std::vector<std::string> fields;
  for (const char* key : {"name", "key", "symbol", "unit", "scope", "level"})
    fields.push_back(csv_text(text_of(p, key)));
  fields.push_back(yes_or_no(p.at("fitted")));
  fields.push_back(yes_or_no(p.at("nuisance")));
  for (const char* key :
       {"start", "lower", "upper", "value", "standard_error", "robust_standard_error"})
    fields.push_back(csv_number(number_of(p, key)));
  for (const std::size_t end : {0U, 1U}) fields.push_back(end_of(p.at("ci95"), end));
  fields.push_back(yes_or_no(p.at("at_bound")));
  fields.push_back(text_of(p, "identifiability"));
  fields.push_back(csv_text(text_of(p, "reason")));
  return csv_row(fields);
}

}  // namespace

std::string parameters_csv(const Json& result) {
  std::string text;
  if (const std::string status = text_of(result, "status"); status != "converged")
    text += csv_comment(fmt::format("status: {}: {}", status, text_of(result, "message")));
  text += csv_row({"name", "key", "symbol", "unit", "scope", "level", "fitted", "nuisance", "start",
                   "lower", "upper", "value", "standard_error", "robust_standard_error", "ci95_low",
                   "ci95_high", "at_bound", "identifiability", "reason"});
  for (const Json& parameter : result.at("parameters")) text += row_of(parameter);
  return text;
}

}  // namespace rigcal::report
