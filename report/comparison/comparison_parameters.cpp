#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/result/estimate_covariance.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

/// Returns true if `a` and `b`, from different results, describe the same parameter.
template <typename A, typename B>
bool same_parameter(const A& a, const B& b) {
  return a.name == b.name && a.scope == b.scope && a.level == b.level;
}

std::optional<calib::ComparedEstimate> estimate_of(const StoredFit& fit,
                                                   const StoredComparedParameter& wanted) {
  const auto found = std::find_if(fit.parameters.begin(), fit.parameters.end(),
                                  [&](const auto& each) { return same_parameter(each, wanted); });
  if (found == fit.parameters.end()) return std::nullopt;
  calib::ComparedEstimate estimate;
  const bool usable = is_usable(fit);
  if (usable || !found->fitted) estimate.value = finite(found->value);
  estimate.fitted = found->fitted;
  if (const auto error = interval_error(*found); error && usable && found->fitted) {
    estimate.standard_error = error->standard_error;
    estimate.degrees_of_freedom = std::optional(error->freedom);
  }
  if (usable) estimate.ci95 = found->ci95;
  if (usable && found->between_days_error) estimate.between_days_error = found->between_days_error;
  estimate.identifiability = found->identifiability;
  estimate.at_bound = found->at_bound;
  return estimate;
}

/// Returns the variance of the difference between two estimates due to effects that both models
/// omit.
double by_effects(const StoredFit& first, const StoredFit& other,
                  const StoredComparedParameter& wanted) {
  const auto effects_of = [&](const StoredFit& fit) -> std::optional<calib::EffectCovariance> {
    const auto found = std::find_if(fit.parameters.begin(), fit.parameters.end(),
                                    [&](const auto& each) { return same_parameter(each, wanted); });
    if (!fit.considered || found == fit.parameters.end() || !found->budget) return std::nullopt;
    return calib::effect_covariance(*fit.considered, {&*found->budget});
  };
  const auto a = effects_of(first);
  const auto b = effects_of(other);
  return a && b ? calib::variance_by_effects(*a, *b) : 0.0;
}

/// Lists every parameter that occurs in any result, except nuisance parameters, without values.
std::vector<StoredComparedParameter> all_parameters(const std::vector<Compared>& results) {
  std::vector<StoredComparedParameter> list;
  for (const Compared& compared : results) {
    for (const calib::FittedParameter& p : compared.result.parameters) {
      const bool known = std::any_of(list.begin(), list.end(),
                                     [&](const auto& each) { return same_parameter(each, p); });
      if (p.nuisance || known) continue;
      list.push_back({p.name, p.key, p.symbol, p.unit, p.scope, p.level, {}, {}});
    }
  }
  return list;
}

/// Returns the dates of the conditions that a result was fitted to; empty if any of them has no
/// date.
std::set<std::string> fitted_dates(const Compared& compared) {
  std::set<std::string> dates;
  for (const calib::ConditionResult& condition : compared.result.conditions) {
    if (condition.use != datasets::Use::fit) continue;
    if (!condition.date) return {};
    dates.insert(*condition.date);
  }
  return dates;
}

/// Returns true if two results were recorded on different dates. Returns false if a date is
/// missing.
bool of_other_dates(const Compared& first, const Compared& other) {
  const auto a = fitted_dates(first);
  const auto b = fitted_dates(other);
  return !a.empty() && !b.empty() && a != b;
}

}  // namespace

std::vector<StoredComparedParameter> compared_parameters(const std::vector<Compared>& results) {
  std::vector<StoredComparedParameter> list = all_parameters(results);
  for (StoredComparedParameter& parameter : list) {
    for (const Compared& compared : results)
      parameter.estimates.push_back(estimate_of(compared.result, parameter));
    parameter.differences.emplace_back();
    for (std::size_t i = 1; i < results.size(); ++i) {
      auto& difference = parameter.differences.emplace_back();
      if (!parameter.estimates[0] || !parameter.estimates[i]) continue;
      difference = calib::difference_of(
          *parameter.estimates[0], *parameter.estimates[i],
          {share_fitted_records(results[0], results[i]), of_other_dates(results[0], results[i]),
           by_effects(results[0].result, results[i].result, parameter)});
    }
  }
  for (std::size_t i = 1; i < results.size(); ++i) {
    std::vector<calib::EstimateDifference*> differences;
    for (StoredComparedParameter& parameter : list)
      if (parameter.differences[i]) differences.push_back(&*parameter.differences[i]);
    calib::judge_together(differences);
  }
  return list;
}

std::string change_text(const calib::EstimateDifference& difference, const ReadableUnit& unit) {
  if (difference.percent) return fmt::format("{:+.3g} %", *difference.percent);
  if (!difference.difference) return {};
  return fmt::format("{:+.2g}{}{}", *difference.difference / unit.si, unit.name.empty() ? "" : " ",
                     unit.name);
}

bool worth_a_row(const StoredComparedParameter& parameter) {
  return std::any_of(parameter.estimates.begin(), parameter.estimates.end(),
                     [](const auto& each) { return each && each->fitted; }) ||
         std::any_of(
             parameter.differences.begin(), parameter.differences.end(),
             [](const auto& each) { return each && each->difference.value_or(0.0) != 0.0; });
}

ReadableUnit unit_of_estimates(const StoredComparedParameter& parameter) {
  double size = 0.0;
  for (const auto& estimate : parameter.estimates)
    if (estimate) size = std::max(size, std::abs(estimate->value.value_or(0.0)));
  return readable_unit(size, parameter.unit);
}

}  // namespace rigcal::report
