#include "report/store/parameters_csv.hpp"

#include <fmt/format.h>

#include "report/store/csv_fields.hpp"

namespace rigcal::report {
namespace {

std::string yes_or_no(bool value) { return value ? "1" : "0"; }

void add_budget(const calib::FittedParameter& p, std::vector<std::string>& fields) {
  const auto& exact = p.ci95_if_exact;
  fields.push_back(exact ? csv_number(exact->low) : std::string());
  fields.push_back(exact ? csv_number(exact->high) : std::string());
  if (!p.budget) {
    fields.insert(fields.end(), 9, std::string());
    return;
  }
  for (const char* kind : {"records", "known_value", "effect"})
    fields.push_back(csv_number(p.budget->contribution(kind)));
  for (const double number : {p.budget->combined, p.budget->degrees_of_freedom,
                              p.budget->coverage_factor, p.budget->shift})
    fields.push_back(csv_number(number));
  for (const char* kind : {"days", "numerics"})
    fields.push_back(csv_number(p.budget->beside_of(kind)));
}

std::string row_of(const calib::FittedParameter& p) {
  std::vector<std::string> fields;
  for (const std::string& text :
       {p.name, p.key, p.symbol, p.unit, std::string(to_string(p.scope)), p.level.value_or("")})
    fields.push_back(csv_text(text));
  fields.push_back(yes_or_no(p.fitted));
  fields.push_back(yes_or_no(p.nuisance));
  for (const std::optional<double>& number :
       {std::optional(p.start), p.lower, p.upper, std::optional(p.value), p.standard_error,
        p.robust_standard_error})
    fields.push_back(csv_number(number));
  fields.push_back(p.ci95 ? csv_number(p.ci95->low) : std::string());
  fields.push_back(p.ci95 ? csv_number(p.ci95->high) : std::string());
  fields.push_back(yes_or_no(p.at_bound));
  fields.push_back(p.identifiability ? std::string(to_string(*p.identifiability)) : std::string());
  fields.push_back(csv_text(p.reason));
  add_budget(p, fields);
  return csv_row(fields);
}

}  // namespace

std::string parameters_csv(calib::FitStatus status, const std::string& message,
                           const std::vector<calib::FittedParameter>& parameters) {
  std::string text;
  if (status != calib::FitStatus::converged)
    text += csv_comment(fmt::format("status: {}: {}", to_string(status), message));
  text += csv_row({"name",
                   "key",
                   "symbol",
                   "unit",
                   "scope",
                   "level",
                   "fitted",
                   "nuisance",
                   "start",
                   "lower",
                   "upper",
                   "value",
                   "standard_error",
                   "robust_standard_error",
                   "ci95_low",
                   "ci95_high",
                   "at_bound",
                   "identifiability",
                   "reason",
                   "ci95_if_exact_low",
                   "ci95_if_exact_high",
                   "u_records",
                   "u_known_values",
                   "u_effects",
                   "u_combined",
                   "u_degrees_of_freedom",
                   "coverage_factor",
                   "shift",
                   "u_days",
                   "u_numerics"});
  for (const calib::FittedParameter& parameter : parameters) text += row_of(parameter);
  return text;
}

}  // namespace rigcal::report
