#include "calib/trust/identifiability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/readable.hpp"
#include "common/significant.hpp"
#include "metrics/significance.hpp"

namespace rigcal::calib {
namespace {

/// At this ratio, the interval extends as far to each side as the value itself, so that not even
/// the sign is known (docs/uncertainty.md).
constexpr double kNotIdentifiable = 1.0;
/// If the robust error exceeds the plain error by this factor, the user is informed that the
/// residuals are autocorrelated, because the interval is then one and a half times as wide.
constexpr double kRobustMatters = 1.5;
/// Residuals below this fraction of the noise show simulation errors or a wrong `sd` rather than
/// noise.
constexpr double kSuspiciouslySmall = 0.5;
/// With two degrees of freedom Student's t has no finite variance, so a robust error below the
/// plain one is meaningless.
constexpr double kLeastFreedom = 3.0;
/// A partner is named if the parameter would have less than a fifth of its variance with the
/// partner known (1 - 0.9^2).
constexpr double kStrongCorrelation = 0.9;

using datasets::FittedValue;
using datasets::Scope;
using model::ParameterKind;
using model::ParameterSpec;

bool zero_is_arbitrary(const ParameterSpec& spec, const Unknown& unknown) {
  return spec.kind == ParameterKind::sensor || spec.kind == ParameterKind::initial ||
         (unknown.lower < 0.0 && unknown.upper > 0.0);
}

bool may_be_absent(const ParameterSpec& spec) {
  return spec.lower == 0.0 && (spec.kind == ParameterKind::term ||
                               spec.key == "leakage_coefficient" || model::is_lag(spec));
}

/// Writes the end of an interval with two significant digits, as reports do.
std::string number(const ParameterSpec& spec, double value) {
  return readable(value, spec.unit, 2);
}

/// Returns, for example, "; correlated 0.98 with mass_kg", or an empty string.
std::string partner(const Problem& problem, const Uncertainty& found, std::size_t unknown) {
  const auto row = static_cast<Eigen::Index>(unknown);
  Eigen::Index best = -1;
  double strongest = 0.0;
  for (Eigen::Index k = 0; k < found.root.unknowns(); ++k) {
    if (k == row || !found.standard_error[static_cast<std::size_t>(k)]) continue;
    const double each = found.correlation(row, k);
    if (best >= 0 && std::abs(each) <= std::abs(strongest)) continue;
    best = k;
    strongest = each;
  }
  if (best < 0 || std::abs(strongest) < kStrongCorrelation) return {};
  return fmt::format("; correlated {:.3f} with {}", strongest,
                     problem.name(static_cast<std::size_t>(best)));
}

/// Returns the half-width relative to the value. If the value is zero, returns a number above the
/// limit for identifiability.
double share_of_value(double value, double half_width) {
  return value != 0.0 ? half_width / std::abs(value) : kNotIdentifiable * 2.0;
}

void add_reason(FittedParameter& parameter, const std::string& text) {
  parameter.reason += parameter.reason.empty() ? text : "; " + text;
}

/// Removes one of the clauses of a reason, with the mark that parts it from its neighbours.
void remove_reason(FittedParameter& parameter, const std::string& text) {
  const std::string mark = "; ";
  std::size_t begin = parameter.reason.find(text);
  if (begin == std::string::npos) return;
  std::size_t end = begin + text.size();
  if (parameter.reason.compare(end, mark.size(), mark) == 0) {
    end += mark.size();
  } else if (begin >= mark.size() &&
             parameter.reason.compare(begin - mark.size(), mark.size(), mark) == 0) {
    begin -= mark.size();
  }
  parameter.reason.erase(begin, end - begin);
}

/// Explains why an interval with this half-width leads to the grade; empty if no explanation is
/// needed.
std::string grade_words(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                        double half_width, const FittedParameter& parameter) {
  const ParameterSpec& spec = problem.spec(unknown);
  switch (*parameter.identifiability) {
    case Identifiability::identified:
      return {};
    case Identifiability::bounded:
      return may_be_absent(spec)
                 ? fmt::format("not significantly different from zero: at most {} (95 %)",
                               number(spec, parameter.value + half_width))
                 : fmt::format("not significantly different from zero: {} to {} (95 %)",
                               number(spec, parameter.value - half_width),
                               number(spec, parameter.value + half_width));
    case Identifiability::weak:
    case Identifiability::not_identifiable:
      break;
  }
  return half_width_words(share_of_value(parameter.value, half_width)) +
         partner(problem, found, unknown);
}

/// Sets the grade and reason of a parameter for this half-width. Both depend only on the interval
/// and the value, so that wider bounds do not change them.
void grade(const Problem& problem, const Uncertainty& found, std::size_t unknown, double half_width,
           FittedParameter& parameter) {
  const ParameterSpec& spec = problem.spec(unknown);
  parameter.identifiability = grade_of(spec, parameter.value, half_width,
                                       zero_is_arbitrary(spec, problem.map.unknowns()[unknown]));
  const std::string words = grade_words(problem, found, unknown, half_width, parameter);
  if (!words.empty()) add_reason(parameter, words);
}

/// Names the largest contribution to an interval that is wider than it would be if the model were
/// exact.
std::string widened_words(const Budget95& budget) {
  const BudgetLine* largest = budget.largest_effect();
  if (largest == nullptr) return "with what the model leaves out";
  return fmt::format("with effects that the model leaves out, mainly {}", largest->source);
}

/// Returns the length of the longer side of an interval.
double longer_side(double value, const Range& interval) {
  return std::max(interval.high - value, value - interval.low);
}

/// Limits degrees of freedom to the range of student_t(). Known variances have infinitely many.
double degrees(double freedom) { return std::clamp(freedom, 1.0, metrics::kManyDegrees); }

/// Returns the half-width of the 95 % interval, and stores which error it is based on.
double choose_interval(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                       FittedParameter& parameter) {
  const double plain = *parameter.standard_error;
  const double robust = parameter.robust_standard_error.value_or(0.0);
  const double freedom = found.robust_freedom[unknown];
  const double least = kSuspiciouslySmall * problem.least_noise();
  const bool unresolved = found.reduced_chi_square < least * least;
  if (!(robust > 0.0) || unresolved || (freedom < kLeastFreedom && robust < plain)) {
    parameter.ci95_from = std::optional(IntervalSource::standard_error);
    parameter.degrees_of_freedom = std::optional(degrees(found.freedom));
    return student_t(found.freedom) * plain;
  }
  parameter.ci95_from = std::optional(IntervalSource::robust_standard_error);
  parameter.degrees_of_freedom = std::optional(degrees(freedom));
  if (robust > kRobustMatters * plain) {
    add_reason(
        parameter,
        fmt::format("{}: the robust error, which the interval uses, is {} times the plain one",
                    found.from_repeats[unknown] ? "repeats differ from one another"
                                                : "residuals are autocorrelated",
                    significant(robust / plain, 2)));
  }
  return found.robust_quantile[unknown] * robust;
}

/// Describes the bound that the estimate has reached, and whether the cost still decreases beyond
/// it.
void describe_bound(const Problem& problem, const OptimumCheck& check, std::size_t unknown,
                    FittedParameter& parameter) {
  const BoundSide side = check.side[unknown];
  if (side == BoundSide::inside) return;
  const Unknown& u = problem.map.unknowns()[unknown];
  parameter.at_bound = true;
  const bool lower = side == BoundSide::lower;
  const std::string text =
      fmt::format("at its {} bound {} ({})", lower ? "lower" : "upper",
                  number(problem.spec(unknown), lower ? u.lower : u.upper),
                  parameter.identifiability == Identifiability::not_identifiable
                      ? "the records do not determine it"
                  : check.active_bound[unknown] ? "active: the fit would improve beyond it"
                                                : "the fit would not improve beyond it");
  parameter.reason = parameter.reason.empty() ? text : text + "; " + parameter.reason;
}

/// Returns true if a value from an earlier fit applies to at least one of the problem's conditions.
bool holds_somewhere(const Problem& problem, const FittedValue& value) {
  return std::any_of(problem.conditions.begin(), problem.conditions.end(),
                     [&](const ProblemCondition& each) {
                       const datasets::Condition& condition = *each.condition;
                       return !known_in(*problem.campaign, condition, value.index) &&
                              condition.is_within(value.scope, value.level);
                     });
}

FittedParameter known(const datasets::Campaign& campaign, int index, Scope scope,
                      const std::string& level, double value) {
  FittedParameter parameter = parameter_in_row(campaign.rig.plant, index, scope, level);
  parameter.value = value;
  parameter.start = value;
  return parameter;
}

}  // namespace

Identifiability grade_of(const ParameterSpec& spec, double value, double half_width,
                         bool arbitrary_zero) {
  const bool holds_zero = std::abs(value) <= half_width;
  if (holds_zero && (may_be_absent(spec) || arbitrary_zero)) return Identifiability::bounded;
  const double share = share_of_value(value, half_width);
  if (share > kNotIdentifiable) return Identifiability::not_identifiable;
  return share > kWeak ? Identifiability::weak : Identifiability::identified;
}

std::string half_width_words(double fraction) {
  constexpr double kMeaningless = 10.0;
  if (!(fraction <= kMeaningless))
    return "not determined: the 95 % interval is more than 10 times as wide as the value to each "
           "side";
  return fmt::format("half width of the 95 % interval is {:.0f} % of the value", 100.0 * fraction);
}

void withhold_grades(std::vector<FittedParameter>& parameters) {
  for (FittedParameter& each : parameters) {
    if (!each.fitted) continue;
    each.identifiability = Identifiability::not_identifiable;
    each.reason = "not judged: the search was stopped before it converged";
  }
}

std::vector<FittedParameter> describe_unknowns(const Problem& problem, const Evaluation& optimum,
                                               const OptimumCheck& check,
                                               const Uncertainty& found) {
  std::vector<FittedParameter> result;
  for (std::size_t j = 0; j < optimum.z.size(); ++j) {
    const Unknown& u = problem.map.unknowns()[j];
    const ParameterSpec& spec = problem.spec(j);
    FittedParameter& parameter = result.emplace_back(
        parameter_in_row(problem.campaign->rig.plant, u.index, u.scope, u.level));
    parameter.value = problem.map.to_physical(static_cast<int>(j), optimum.z[j]);
    parameter.start = u.start;
    parameter.lower = u.lower;
    parameter.upper = u.upper;
    parameter.fitted = true;
    parameter.nuisance = u.nuisance;
    parameter.correlated = found.root.condition_of(static_cast<Eigen::Index>(j)) < 0;
    parameter.standard_error = found.standard_error[j];
    parameter.robust_standard_error = found.robust_standard_error[j];
    if (found.standard_error[j] && j < found.between_days.size() &&
        std::isfinite(found.between_days[j]))
      parameter.between_days_error = found.between_days[j];
    if (parameter.standard_error) {
      const double half_width = choose_interval(problem, found, j, parameter);
      parameter.ci95 = {std::max(spec.lower, parameter.value - half_width),
                        std::min(spec.upper, parameter.value + half_width)};
      parameter.ci95_if_exact = parameter.ci95;
      grade(problem, found, j, half_width, parameter);
    } else {
      parameter.identifiability = Identifiability::not_identifiable;
      parameter.reason = found.reason[j];
    }
    describe_bound(problem, check, j, parameter);
  }
  return result;
}

void grade_widened(const Problem& problem, const Uncertainty& found, std::size_t unknown,
                   FittedParameter& parameter) {
  if (!parameter.ci95 || !parameter.ci95_if_exact) return;
  const double before = longer_side(parameter.value, *parameter.ci95_if_exact);
  const double half_width = longer_side(parameter.value, *parameter.ci95);
  if (!(half_width > before)) return;
  const std::string old = grade_words(problem, found, unknown, before, parameter);
  if (!old.empty()) remove_reason(parameter, old);
  grade(problem, found, unknown, half_width, parameter);
  if (parameter.identifiability != Identifiability::identified && parameter.budget)
    add_reason(parameter, widened_words(*parameter.budget));
}

bool rests_on_known(const Problem& problem, const Uncertainty& uncertainty,
                    const std::vector<double>& z, std::size_t unknown) {
  constexpr double kMost = 0.7;  // fraction of the error; squared, about half of the variance
  const auto row = static_cast<Eigen::Index>(unknown);
  const auto& error = uncertainty.standard_error[unknown];
  if (!error || uncertainty.known.names.empty()) return false;
  const double slope = problem.map.slope(static_cast<int>(unknown), z[unknown]);
  return slope * uncertainty.known.response.row(row).norm() > kMost * *error;
}

std::vector<FittedParameter> describe_known(const Problem& problem,
                                            const std::vector<FittedValue>* values) {
  const datasets::Campaign& campaign = *problem.campaign;
  std::vector<FittedParameter> result;
  for (const auto& setting : campaign.parameters) {
    const auto of_setting = [&](const auto& each) { return each.index == setting.index; };
    const auto& unknowns = problem.map.unknowns();
    if (std::any_of(unknowns.begin(), unknowns.end(), of_setting)) continue;
    if (values == nullptr || std::none_of(values->begin(), values->end(), of_setting)) {
      result.push_back(known(campaign, setting.index, Scope::rig, {}, setting.value));
      continue;
    }
    for (const FittedValue& each : *values) {
      if (of_setting(each) && holds_somewhere(problem, each))
        result.push_back(known(campaign, each.index, each.scope, each.level, each.value));
    }
  }
  std::set<std::string> levels;
  for (const ProblemCondition& each : problem.conditions) {
    const datasets::Condition& condition = *each.condition;
    for (const auto& [index, value] : condition.overrides)
      result.push_back(known(campaign, index, Scope::condition, condition.id, value));
    if (!condition.leak_level || !levels.insert(*condition.leak_level).second) continue;
    const auto level = campaign.leak_levels.find(*condition.leak_level);
    if (level == campaign.leak_levels.end()) continue;
    for (const auto& [index, value] : level->second)
      result.push_back(known(campaign, index, Scope::leak_level, *condition.leak_level, value));
  }
  return result;
}

}  // namespace rigcal::calib
