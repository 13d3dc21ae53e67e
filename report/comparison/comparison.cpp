#include "report/comparison/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

/// Widens the range `ends` to include a value.
template <typename T>
void widen(std::optional<std::array<T, 2>>& ends, const T& value) {
  if (!ends) ends = {value, value};
  (*ends)[0] = std::min((*ends)[0], value);
  (*ends)[1] = std::max((*ends)[1], value);
}

StoredComparedResult stored(const Compared& compared) {
  const StoredFit& fit = compared.result;
  StoredComparedResult result;
  result.name = compared.name;
  result.file = compared.file.string();
  result.schema = fit.schema;
  result.status = fit.status;
  result.verdict = fit.verdict;
  result.message = fit.message;
  result.campaign = fit.campaign;
  result.model = fit.model;
  result.synthetic = fit.synthetic;
  result.cost = fit.cost;
  result.residual_count = fit.residual_count;
  result.reduced_chi_square = fit.reduced_chi_square;
  result.independent_residuals = fit.independent_residuals.value_or(std::nullopt);
  result.conditions = static_cast<long>(fit.conditions.size());
  std::optional<std::array<double, 2>> kelvin;
  for (const calib::ConditionResult& condition : fit.conditions) {
    if (condition.date) widen(result.dates, *condition.date);
    if (condition.temperature_k) widen(kelvin, *condition.temperature_k);
  }
  if (kelvin) result.temperature_k = {(*kelvin)[0], (*kelvin)[1]};
  result.version = fit.provenance.version;
  result.revision = fit.provenance.revision;
  result.command = fit.provenance.command;
  return result;
}

std::string repeats_warning(const std::string& name, const calib::BetweenRepeats& repeats) {
  const std::string cause = repeats.cause
                                ? fmt::format(", as variation of {} would cause", *repeats.cause)
                                : std::string();
  return fmt::format(
      "{}: its repeats differ from one another by more than their noise{}. If days differ in the "
      "same way, no standard error includes it, and it counts as a change of the rig",
      name, cause);
}

bool lacks_degrees(const StoredFit& fit) {
  return std::any_of(fit.parameters.begin(), fit.parameters.end(),
                     [](const calib::FittedParameter& p) {
                       return p.fitted && !p.nuisance && p.ci95 && !p.degrees_of_freedom;
                     });
}

std::vector<std::string> comparison_warnings(const std::vector<Compared>& results) {
  std::vector<std::string> list;
  for (const Compared& compared : results) {
    const StoredFit& fit = compared.result;
    if (fit.status != calib::FitStatus::converged)
      list.push_back(fmt::format("{}: {}: {}", compared.name, to_string(fit.status), fit.message));
    if (fit.verdict == calib::Verdict::fail)
      list.push_back(fmt::format("{}: outside the campaign's limits (FAIL)", compared.name));
    if (const auto& repeats = fit.between_repeats; repeats && repeats->differ)
      list.push_back(repeats_warning(compared.name, *repeats));
    if (lacks_degrees(fit))
      list.push_back(
          fmt::format("{}: written by a version that does not state degrees of freedom; they are "
                      "inferred from its intervals",
                      compared.name));
  }
  for (std::size_t i = 1; i < results.size(); ++i) {
    if (!share_fitted_records(results[0], results[i])) continue;
    list.push_back(fmt::format(
        "{} and {} were fitted to the same {}, at least in part: their estimates are not "
        "independent, so differences "
        "between them are not tested for significance",
        results[0].name, results[i].name, results[i].of_tables ? "published numbers" : "records"));
  }
  return list;
}

}  // namespace

StoredComparison compared(const std::vector<Compared>& results, const Provenance& provenance) {
  const auto usable = std::count_if(results.begin(), results.end(),
                                    [](const Compared& each) { return is_usable(each.result); });
  StoredComparison comparison;
  comparison.status = usable >= 2 ? "done" : "failed";
  for (const Compared& each : results) comparison.results.push_back(stored(each));
  comparison.parameters = compared_parameters(results);
  comparison.significance = tested_parameters(comparison.parameters, results.size());
  comparison.conditions = compared_conditions(results);
  comparison.metrics = compared_metrics(comparison.conditions, results);
  comparison.models = compared_models(results);
  comparison.records = compared_records(results);
  comparison.leak_trends = trends(results, "leakage_coefficient");
  comparison.warnings = comparison_warnings(results);
  comparison.provenance = stored(provenance);
  return comparison;
}

}  // namespace rigcal::report
