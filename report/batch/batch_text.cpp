#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "common/significant.hpp"
#include "report/batch/batch.hpp"
#include "report/store/csv_columns.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

/// Returns the first reason, which is short enough for a table; empty if there is none.
std::string first_reason(const StoredRig& rig) {
  return rig.reasons.empty() ? "" : rig.reasons.front();
}

/// Returns the worst score; null if nothing was scored.
const StoredRigScore* worst_score(const StoredRig& rig) {
  return rig.worst_scores.empty() ? nullptr : &rig.worst_scores.front();
}

/// Returns the verdict of a rig that was judged, and otherwise how its run ended.
std::string outcome_of(const StoredRig& rig) {
  if (!rig.status) return "no result";
  if (!has_converged(rig)) return std::string(to_string(*rig.status));
  return rig.verdict ? std::string(to_string(*rig.verdict)) : "not judged";
}

std::string column_of(const StoredRigEstimate& each) {
  return each.level ? each.name + "[" + *each.level + "]" : each.name;
}

/// Returns the names of the estimates of all rigs, in order of first appearance.
std::vector<std::string> estimate_columns(const StoredBatch& batch) {
  std::vector<std::string> names;
  for (const StoredRig& rig : batch.rigs) {
    for (const StoredRigEstimate& each : rig.parameters) {
      const std::string name = column_of(each);
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

const StoredRigEstimate* estimate_of(const StoredRig& rig, const std::string& column) {
  for (const StoredRigEstimate& each : rig.parameters)
    if (column_of(each) == column) return &each;
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
  const ReadableUnit unit = readable_unit(*along.slope, trend.unit);
  const auto number = [&](double value) { return significant(value / unit.si, 3); };
  return fmt::format("{}: {}{}{}{} per day ({} to {}): {}.", trend_name(trend),
                     *along.slope < 0.0 ? "" : "+", number(*along.slope),
                     unit.name.empty() ? "" : " ", unit.name, number(along.ci95->low),
                     number(along.ci95->high),
                     is_significant(trend) ? "significant trend" : "no significant trend");
}

std::string batch_csv(const StoredBatch& batch) {
  using R = StoredRig;
  using Score = StoredRigScore;
  CsvColumns<R> columns;
  columns
      .members(&R::rig, &R::name, &R::exit_code, &R::status, &R::verdict, &R::seconds,
               &R::unchanged)
      .add("warnings", [](const R& rig) { return rig.warnings.size(); })
      .members(&R::message)
      .add("first_reason", first_reason)
      .add("worst_condition", worst_score, &Score::condition)
      .add("worst_channel", worst_score, &Score::channel)
      .add("worst_rho2", worst_score, &Score::rho2)
      .add("worst_absolute_error_percent", worst_score, &Score::absolute_error_percent);
  for (const std::string& name : estimate_columns(batch)) {
    const auto estimate = [name](const R& rig) { return estimate_of(rig, name); };
    columns.add(name, estimate, &StoredRigEstimate::value);
    columns.add(name + "_ci95_low", estimate, &StoredRigEstimate::ci95, &Range::low);
    columns.add(name + "_ci95_high", estimate, &StoredRigEstimate::ci95, &Range::high);
  }
  return columns.table(batch.rigs);
}

}  // namespace rigcal::report
