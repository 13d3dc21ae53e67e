#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "report/batch/batch.hpp"
#include "report/store/csv_fields.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Returns the first reason, which is short enough for a table; empty if there is none.
std::string first_reason(const StoredRig& rig) {
  return rig.reasons.empty() ? "" : rig.reasons.front();
}

/// Returns the verdict of a rig that was judged, and otherwise how its run ended.
std::string outcome_of(const StoredRig& rig) {
  if (!rig.status) return "no result";
  if (!has_converged(rig)) return std::string(to_string(*rig.status));
  return rig.verdict ? std::string(to_string(*rig.verdict)) : "not judged";
}

/// Returns the names of the estimates of all rigs, in order of first appearance.
std::vector<std::string> estimate_columns(const StoredBatch& batch) {
  std::vector<std::string> names;
  for (const StoredRig& rig : batch.rigs) {
    for (const StoredRigEstimate& each : rig.parameters) {
      const std::string name = each.level ? each.name + "[" + *each.level + "]" : each.name;
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

const StoredRigEstimate* estimate_of(const StoredRig& rig, const std::string& column) {
  for (const StoredRigEstimate& each : rig.parameters)
    if ((each.level ? each.name + "[" + *each.level + "]" : each.name) == column) return &each;
  return nullptr;
}

}  // namespace

std::string batch_sentence(const StoredBatch& batch) {
  constexpr std::array kOutcomes{"PASS",    "WARN",   "FAIL",     "not judged",
                                 "stopped", "failed", "no result"};
  std::string counts;
  for (const char* outcome : kOutcomes) {
    const auto count = std::count_if(batch.rigs.begin(), batch.rigs.end(),
                                     [&](const auto& rig) { return outcome_of(rig) == outcome; });
    if (count > 0) counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count, outcome);
  }
  return fmt::format("{} rig{}: {}", batch.rigs.size(), batch.rigs.size() == 1 ? "" : "s", counts);
}

std::string trend_name(const StoredRigTrend& trend) {
  const std::string& of = trend.series.of;
  return of == "rig" ? trend.key : fmt::format("{} ({})", trend.key, of);
}

bool is_significant(const StoredRigTrend& trend) {
  return trend.series.along_date.significant == true;
}

std::string trend_sentence(const StoredRigTrend& trend) {
  const calib::EstimateTrend& along = trend.series.along_date;
  if (!along.slope || !along.ci95)
    return fmt::format("{}: {}.", trend_name(trend), along.reason.value_or(""));
  const std::string unit = trend.unit == "1" ? "" : typographic(trend.unit) + " ";
  return fmt::format("{}: {:+.3g} {}per day ({:.3g} to {:.3g}): {}.", trend_name(trend),
                     *along.slope, unit, along.ci95->low, along.ci95->high,
                     is_significant(trend) ? "significant trend" : "no significant trend");
}

std::string batch_csv(const StoredBatch& batch) {
  const std::vector<std::string> columns = estimate_columns(batch);
  std::vector<std::string> head{"rig",
                                "name",
                                "exit_code",
                                "status",
                                "verdict",
                                "seconds",
                                "unchanged",
                                "warnings",
                                "message",
                                "first_reason",
                                "worst_condition",
                                "worst_channel",
                                "worst_rho2",
                                "worst_absolute_error_percent"};
  for (const std::string& name : columns) {
    for (const char* what : {"", "_ci95_low", "_ci95_high"}) head.push_back(csv_text(name + what));
  }
  std::string text = csv_row(head);
  for (const StoredRig& rig : batch.rigs) {
    const StoredRigScore none;
    const StoredRigScore& worst = rig.worst_scores.empty() ? none : rig.worst_scores.front();
    std::vector<std::string> row{csv_text(rig.rig),
                                 csv_text(rig.name.value_or("")),
                                 fmt::format("{}", rig.exit_code),
                                 rig.status ? std::string(to_string(*rig.status)) : "",
                                 rig.verdict ? std::string(to_string(*rig.verdict)) : "",
                                 csv_number(rig.seconds),
                                 rig.unchanged ? "1" : "0",
                                 fmt::format("{}", rig.warnings.size()),
                                 csv_text(rig.message),
                                 csv_text(first_reason(rig)),
                                 csv_text(worst.condition),
                                 worst.channel,
                                 csv_number(worst.rho2),
                                 csv_number(worst.absolute_error_percent)};
    for (const std::string& name : columns) {
      const StoredRigEstimate* each = estimate_of(rig, name);
      row.push_back(each == nullptr ? "" : csv_number(each->value));
      for (const bool low : {true, false}) {
        const bool known = each != nullptr && each->ci95;
        row.push_back(!known ? "" : csv_number(low ? each->ci95->low : each->ci95->high));
      }
    }
    text += csv_row(row);
  }
  return text;
}

}  // namespace rigcal::report
