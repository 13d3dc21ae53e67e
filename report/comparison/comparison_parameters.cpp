#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "calib/result/estimate_spread.hpp"
#include "metrics/significance.hpp"
#include "report/comparison/comparison_parts.hpp"

namespace rigcal::report {
namespace {

/// Whether two are the same parameter, each of its result.
template <typename A, typename B>
bool same_parameter(const A& a, const B& b) {
  return a.name == b.name && a.scope == b.scope && a.level == b.level;
}

std::optional<StoredEstimate> estimate_of(const StoredFit& fit,
                                          const StoredComparedParameter& wanted) {
  const auto found = std::find_if(fit.parameters.begin(), fit.parameters.end(),
                                  [&](const auto& each) { return same_parameter(each, wanted); });
  if (found == fit.parameters.end()) return std::nullopt;
  StoredEstimate estimate;
  const bool usable = is_usable(fit);
  if (usable || !found->fitted) estimate.value = found->value;
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

/// Variance that the effects which both models leave out give the difference of two estimates of
/// one rig: the effects are the same in both, and what they move both estimates by cancels. By the
/// size that either result leaves them.
double variance_by_effects(const StoredFit& first, const StoredFit& other,
                           const StoredComparedParameter& wanted) {
  const auto spread_of = [&](const StoredFit& fit) -> std::optional<calib::EffectSpread> {
    const auto found = std::find_if(fit.parameters.begin(), fit.parameters.end(),
                                    [&](const auto& each) { return same_parameter(each, wanted); });
    if (!fit.considered || found == fit.parameters.end() || !found->budget) return std::nullopt;
    return calib::effect_spread(*fit.considered, {&*found->budget});
  };
  const auto a = spread_of(first);
  const auto b = spread_of(other);
  if (!a || !b) return 0.0;
  // The change of the difference per unit of each effect of one, as its own moves less those of
  // the other.
  const auto variance_by = [](const calib::EffectSpread& own, const calib::EffectSpread& beside) {
    Eigen::RowVectorXd moves = own.moves.row(0);
    for (std::size_t e = 0; e < own.keys.size(); ++e) {
      const auto place = std::find(beside.keys.begin(), beside.keys.end(), own.keys[e]);
      if (place != beside.keys.end())
        moves(static_cast<Eigen::Index>(e)) -= beside.moves(0, place - beside.keys.begin());
    }
    return (moves * own.root).squaredNorm();
  };
  return std::max(variance_by(*a, *b), variance_by(*b, *a));
}

/// Whether a value is zero or not significantly different from it, so that percentages of it mean
/// nothing.
bool may_be_zero(const StoredEstimate& estimate) {
  if (estimate.value.value_or(0.0) == 0.0) return true;
  const Interval interval(estimate.ci95);
  return interval.ends && interval.ends->low <= 0.0 && interval.ends->high >= 0.0;
}

/// The difference, except for the adjustment that needs all parameters together.
std::optional<StoredDifference> difference_of(const std::optional<StoredEstimate>& first,
                                              const std::optional<StoredEstimate>& other,
                                              bool same_records, bool other_dates,
                                              double by_effects) {
  if (!first || !other) return std::nullopt;
  StoredDifference result;
  const auto untested = [&](const char* reason) {
    result.reason = reason;
    return result;
  };
  if (!first->value || !other->value) return untested("one has no value");
  const double difference = *other->value - *first->value;
  result.difference = difference;
  if (!may_be_zero(*first)) result.percent = 100.0 * (*other->value / *first->value - 1.0);
  if (!first->fitted && !other->fitted) return untested(kKnownInBoth);
  // A known value has no error.
  const auto error = [&](const StoredEstimate& estimate) {
    const metrics::EstimateError own{estimate.standard_error.value_or(0.0),
                                     estimate.degrees_of_freedom.value_or(metrics::kManyDegrees)};
    return other_dates ? with_days(own, estimate.between_days_error) : own;
  };
  for (const auto* estimate : {&*first, &*other})
    if (estimate->fitted && !estimate->standard_error)
      return untested("an estimate has no standard error");
  if (first->fitted && other->fitted && same_records)
    return untested("estimated from the same data, so not independent of each other");
  metrics::EstimateError both = metrics::error_of_difference(error(*first), error(*other));
  if (by_effects > 0.0) {
    const std::array parts{
        metrics::ErrorPart{both.standard_error * both.standard_error, both.freedom},
        metrics::ErrorPart{by_effects, metrics::kManyDegrees}};
    both = {std::hypot(both.standard_error, std::sqrt(by_effects)),
            metrics::effective_freedom(parts)};
    result.by_effects = std::sqrt(by_effects);
  }
  result.standard_error = both.standard_error;
  if (other_dates && (first->between_days_error || other->between_days_error))
    result.of_other_dates = true;
  result.degrees_of_freedom = std::optional(both.freedom);
  result.p_value = metrics::difference_p_value(difference, both);
  return result;
}

/// Judges all differences of one result from the first together.
void judge_together(std::vector<StoredComparedParameter>& parameters, std::size_t result) {
  std::vector<double> p_values;
  std::vector<StoredDifference*> differences;
  for (StoredComparedParameter& parameter : parameters) {
    auto& difference = parameter.differences[result];
    if (!difference || !difference->p_value) continue;
    p_values.push_back(*difference->p_value);
    differences.push_back(&*difference);
  }
  const std::vector<double> adjusted = metrics::holm(p_values);
  for (std::size_t i = 0; i < differences.size(); ++i) {
    differences[i]->p_value_of_all = adjusted[i];
    differences[i]->significant = adjusted[i] < kSignificantLevel;
  }
}

/// Every parameter that a result has, but for nuisance parameters, without values yet.
std::vector<StoredComparedParameter> all_parameters(const std::vector<Compared>& results) {
  std::vector<StoredComparedParameter> list;
  for (const Compared& compared : results) {
    for (const StoredParameter& p : compared.result.parameters) {
      const bool known = std::any_of(list.begin(), list.end(),
                                     [&](const auto& each) { return same_parameter(each, p); });
      if (p.nuisance || known) continue;
      list.push_back({p.name, p.key, p.symbol, p.unit, p.scope, p.level, {}, {}});
    }
  }
  return list;
}

/// Dates of the conditions that a result was fitted to; none where one has no date.
std::set<std::string> fitted_dates(const Compared& compared) {
  std::set<std::string> dates;
  for (const StoredCondition& condition : compared.result.conditions) {
    if (condition.use != datasets::Use::fit) continue;
    if (!condition.date) return {};
    dates.insert(*condition.date);
  }
  return dates;
}

/// Whether two results are stated to be of different dates. Where one has no date nothing tells.
bool of_other_dates(const Compared& first, const Compared& other) {
  const auto a = fitted_dates(first);
  const auto b = fitted_dates(other);
  return !a.empty() && !b.empty() && a != b;
}

}  // namespace

metrics::EstimateError with_days(const metrics::EstimateError& own,
                                 const std::optional<double>& between_days_error) {
  const double days = between_days_error.value_or(0.0);
  if (!(days > 0.0)) return own;
  const std::array parts{metrics::ErrorPart{own.standard_error * own.standard_error, own.freedom},
                         metrics::ErrorPart{days * days, metrics::kManyDegrees}};
  return {std::hypot(own.standard_error, days), metrics::effective_freedom(parts)};
}

std::vector<StoredComparedParameter> compared_parameters(const std::vector<Compared>& results) {
  std::vector<StoredComparedParameter> list = all_parameters(results);
  for (StoredComparedParameter& parameter : list) {
    for (const Compared& compared : results)
      parameter.estimates.push_back(estimate_of(compared.result, parameter));
    parameter.differences.emplace_back();
    for (std::size_t i = 1; i < results.size(); ++i) {
      parameter.differences.push_back(difference_of(
          parameter.estimates[0], parameter.estimates[i],
          share_fitted_records(results[0], results[i]), of_other_dates(results[0], results[i]),
          variance_by_effects(results[0].result, results[i].result, parameter)));
    }
  }
  for (std::size_t i = 1; i < results.size(); ++i) judge_together(list, i);
  return list;
}

std::string change_text(const StoredDifference& difference, const RowUnit& unit) {
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

RowUnit unit_of_estimates(const StoredComparedParameter& parameter) {
  double size = 0.0;
  for (const auto& estimate : parameter.estimates)
    if (estimate) size = std::max(size, std::abs(estimate->value.value_or(0.0)));
  return row_unit(size, parameter.unit);
}

}  // namespace rigcal::report
