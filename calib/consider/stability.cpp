#include "calib/consider/stability.hpp"

#include <algorithm>
#include <cmath>

#include "calib/problem/arrow_svd.hpp"
#include "calib/problem/day_effects.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/uncertainty.hpp"
#include "metrics/distributions.hpp"
#include "metrics/significance.hpp"

namespace rigcal::calib {
namespace {

/// A second step is needed if the model is not quite linear between the two estimates.
constexpr int kSteps = 2;
/// Maximum half-width of an interval, as a fraction of the value. A wider interval is not
/// symmetric, so that a comparison would be a guess.
constexpr double kWidestInterval = 0.25;

const FittedParameter* same_unknown(const std::vector<FittedParameter>& parameters,
                                    const Unknown& unknown) {
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const FittedParameter& each) {
        return each.fitted && each.matches(unknown.index, unknown.scope, unknown.level);
      });
  return found == parameters.end() ? nullptr : &*found;
}

/// Estimates the noise from the residuals at the fit's values if there are neither repeats nor an
/// `sd`.
void weigh_by_residuals(const Evaluation& at, Problem& problem) {
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    auto& channels = problem.conditions[i].channels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (!channels[k].sd_known)
        channels[k].sd = std::max(at.conditions[i].rms[k], problem.least_sd(channels[k]));
    }
  }
}

Evaluation evaluated(const Problem& problem, const std::vector<double>& z, int threads,
                     const std::atomic<bool>* cancel) {
  return evaluate_at(problem, z, threads, {Fidelity::full, cancel, true});
}

/// Returns z after a Gauss-Newton step within the box.
std::vector<double> after_step(const Problem& problem, const Evaluation& at) {
  const Eigen::VectorXd step =
      ArrowSvd(linearise(problem, at), rank_threshold(problem.tolerance)).step();
  std::vector<double> z = at.z;
  for (std::size_t j = 0; j < z.size(); ++j)
    z[j] = std::clamp(z[j] + step(static_cast<Eigen::Index>(j)), 0.0, 1.0);
  return z;
}

/// Returns the variance of the difference between two estimates of one unknown that is due to the
/// days of their records.
double variance_between_days(const FittedParameter& fitted, const Uncertainty& again,
                             std::size_t unknown) {
  const double first = fitted.between_days_error.value_or(0.0);
  const double second = unknown < again.between_days.size() ? again.between_days[unknown] : 0.0;
  return std::isfinite(second) ? first * first + second * second : first * first;
}

}  // namespace

void repeat_on_validation(Problem validation, const std::vector<FittedParameter>& nuisance,
                          const std::vector<std::string>& dates, int threads,
                          const std::atomic<bool>* cancel, Fit& fit) {
  const auto& unknowns = validation.map.unknowns();
  std::vector<double> z = validation.start();
  std::vector<const FittedParameter*> fitted(unknowns.size(), nullptr);
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    fitted[j] = unknowns[j].nuisance ? nullptr : same_unknown(fit.parameters, unknowns[j]);
    const FittedParameter* value =
        fitted[j] != nullptr ? fitted[j] : same_unknown(nuisance, unknowns[j]);
    if (value != nullptr)
      z[j] = std::clamp(validation.map.to_unit(static_cast<int>(j), value->value), 0.0, 1.0);
  }
  Evaluation at = evaluated(validation, z, threads, cancel);
  if (!at.ok) return;
  if (validation.has_estimated_sd()) {
    weigh_by_residuals(at, validation);
    at = evaluated(validation, z, threads, cancel);
  }
  for (int step = 0; step < kSteps && at.ok; ++step)
    at = evaluated(validation, after_step(validation, at), threads, cancel);
  if (!at.ok) return;
  std::vector<ConditionRows> rows = std::move(*at.rows);
  at.rows.reset();
  const Uncertainty found = uncertainty(validation, at, std::move(rows), threads);
  const bool other_day = std::any_of(
      validation.conditions.begin(), validation.conditions.end(),
      [&](const ProblemCondition& each) { return is_of_another_day(*each.condition, dates); });
  std::vector<double> p_values;
  std::vector<StabilityCheck> checks;
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
    if (fitted[j] == nullptr || !fitted[j]->budget || !found.robust_standard_error[j]) continue;
    if (bound_side(at.z[j]) != BoundSide::inside) continue;  // at a bound its error is not valid
    const double value = validation.map.to_physical(static_cast<int>(j), at.z[j]);
    if (student_t(found.robust_freedom[j]) * *found.robust_standard_error[j] >
        kWidestInterval * std::abs(value))
      continue;
    const Budget95& own = *fitted[j]->budget;
    const std::vector<metrics::ErrorPart> parts{
        {own.combined * own.combined, own.degrees_of_freedom},
        {*found.robust_standard_error[j] * *found.robust_standard_error[j],
         std::clamp(found.robust_freedom[j], 1.0, metrics::kManyDegrees)},
        {other_day ? variance_between_days(*fitted[j], found, j) : 0.0}};
    double variance = 0.0;
    for (const metrics::ErrorPart& each : parts) variance += each.variance;
    const metrics::EstimateError error{std::sqrt(variance), metrics::effective_freedom(parts)};
    if (!(error.standard_error > 0.0)) continue;
    StabilityCheck& check = checks.emplace_back();
    check.key = validation.spec(j).key;
    check.unit = validation.spec(j).unit;
    check.scope = unknowns[j].scope;
    check.level = unless_empty(unknowns[j].level);
    check.value = value;
    check.difference = check.value - fitted[j]->value;
    check.expanded = student_t(error.freedom) * error.standard_error;
    p_values.push_back(metrics::difference_p_value(check.difference, error));
  }
  const auto together = metrics::holm(p_values);
  for (std::size_t i = 0; i < together.size(); ++i)
    checks[i].differs = together[i] < metrics::kWarningLevel;
  if (!checks.empty()) fit.stability = std::move(checks);
}

}  // namespace rigcal::calib
