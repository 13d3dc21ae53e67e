#include "calib/fit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "calib/consider/consider.hpp"
#include "calib/consider/effect_changes.hpp"
#include "calib/consider/stability.hpp"
#include "calib/cross_validation.hpp"
#include "calib/finish.hpp"
#include "calib/posterior/posterior.hpp"
#include "calib/problem/initial_state.hpp"
#include "calib/problem/known_values.hpp"
#include "calib/problem/measured_tolerance.hpp"
#include "calib/score/scorecard.hpp"
#include "calib/search/late_flag.hpp"
#include "calib/solve.hpp"
#include "calib/trust/bootstrap.hpp"
#include "calib/trust/identifiability.hpp"
#include "calib/trust/interval_advice.hpp"
#include "calib/trust/prediction_band.hpp"
#include "calib/trust/profile.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::FittedValue;
using datasets::Record;
using datasets::Use;
using Clock = Budget::Clock;

std::vector<const Condition*> conditions_of(const Campaign& campaign, std::vector<Use> uses) {
  std::vector<const Condition*> result;
  for (const Condition& condition : campaign.conditions) {
    if (std::find(uses.begin(), uses.end(), condition.use) != uses.end())
      result.push_back(&condition);
  }
  return result;
}

std::vector<FittedValue> values_of(const std::vector<FittedParameter>& parameters) {
  std::vector<FittedValue> values;
  for (const FittedParameter& each : parameters) {
    if (each.fitted && !each.nuisance)
      values.push_back({each.index, each.scope, each.level.value_or(""), each.value});
  }
  return values;
}

Budget budget_of(const Campaign& campaign, const FitOptions& options, Clock::time_point began) {
  const auto limit_s = options.max_seconds ? options.max_seconds : campaign.fit.max_seconds;
  return Budget(options.cancel, began, limit_s, options.max_evaluations);
}

bool asks_for_more(const FitOptions& options) {
  return options.bootstrap > 0 || options.profiles || options.posterior > 0 ||
         options.cross_validate;
}

/// Runs the steps requested in addition to the fit: bootstrap, profiles, posterior,
/// cross-validation. If the budget runs out, the finished steps are kept.
void run_requested_steps(const Problem& problem, const Campaign& campaign,
                         const std::vector<Record>& records, const Solved& solved,
                         const std::optional<EffectLikelihood>& effects, const FitOptions& options,
                         Budget& budget, Fit& fit) {
  const auto note = [&](StoppedIn stage) {
    if (budget.spent() && !fit.stopped_in) fit.stopped_in = stage;
  };
  if (options.bootstrap > 0) {
    bootstrap(problem, solved.optimum, solved.uncertainty, fit.conditions, options, fit, budget);
    note(StoppedIn::bootstrap);
  }
  if (options.profiles) {
    profiles(problem, records, solved.optimum, options, fit, budget);
    note(StoppedIn::profiles);
  }
  if (options.posterior > 0) {
    sample_posterior(problem, solved.optimum, solved.uncertainty, effects ? &*effects : nullptr,
                     options, fit, budget);
    note(StoppedIn::posterior);
  }
  // The records do not bound these unknowns; only the smoothing of the square roots would.
  for (const std::size_t j : solved.open) {
    fit.parameters[j].bootstrap.reset();
    fit.parameters[j].profile.reset();
  }
  const std::string compared =
      compare_intervals(problem, fit.parameters, solved.uncertainty.known.names,
                        fit.lack_of_fit->misfit.value_or(false));
  if (!compared.empty()) fit.interval_advice += "; " + compared;
  if (options.cross_validate) {
    fit.cross_validation = cross_validate(campaign, records, fit, options, budget);
    note(StoppedIn::cross_validation);
    fit.interval_advice += "; " + cross_validation_summary(*fit.cross_validation);
    const auto words = cross_validation_words(*fit.cross_validation);
    fit.warnings.insert(fit.warnings.end(), words.begin(), words.end());
  }
}

void warn_of_start(const Campaign& campaign, const std::vector<const Condition*>& conditions,
                   const std::vector<Record>& records, Fit& fit) {
  const std::string text = moving_start(campaign, conditions, records);
  if (!text.empty()) fit.warnings.push_back(text);
}

/// Returns the distinct dates of some conditions; empty if any of them has no date.
std::vector<std::string> dates_of(const std::vector<const Condition*>& conditions) {
  std::vector<std::string> dates;
  for (const Condition* each : conditions) {
    if (!each->date) return {};
    if (std::find(dates.begin(), dates.end(), *each->date) == dates.end())
      dates.push_back(*each->date);
  }
  return dates;
}

/// Returns the effects that a fit considered in addition to its estimates.
EffectCovariance effects_beside(const Fit& fit, const EstimateCovariance& covariance) {
  if (!fit.considered) return {};
  std::vector<const Budget95*> budgets;
  for (const EstimateCovariance::Estimate& each : covariance.estimates) {
    const auto found =
        std::find_if(fit.parameters.begin(), fit.parameters.end(), [&](const auto& parameter) {
          return parameter.fitted && parameter.matches(each.index, each.scope, each.level);
        });
    const bool known = found != fit.parameters.end() && found->budget.has_value();
    budgets.push_back(known ? &*found->budget : nullptr);
  }
  return effect_covariance(*fit.considered, budgets);
}

/// Scores conditions at known values. Nuisance parameters are estimated again.
///
/// @param late    ends the simulations that give the scores
/// @param covariance  covariance of the values for prediction bands; if null, no bands are computed
Fit score_at(const Campaign& campaign, const std::vector<Record>& records,
             const std::vector<const Condition*>& conditions,
             const std::vector<FittedValue>* values, const FitOptions& options, Budget& budget,
             const LateFlag& late, const EstimateCovariance* covariance) {
  Fit fit;
  warn_of_start(campaign, conditions, records, fit);
  Problem problem = make_problem(campaign, records, conditions, true, values);
  problem.cancel = late.flag();
  Evaluator evaluator(problem, budget, options.threads);
  evaluator.keep_rows();
  FitOptions once = options;
  once.starts = 1;
  once.further_starts = 0;
  once.resume = nullptr;
  once.checkpoint = nullptr;
  std::vector<double> z = problem.start();
  if (problem.map.unknowns().empty()) {
    measure_tolerances(problem, z, options.threads, options.cancel);
    fit.status = FitStatus::converged;
    fit.message = "scored at known values; nothing was estimated";
    fit.residual_count = problem.residual_count();
    fit.tolerance = problem.tolerance;
  } else {
    const Evaluation optimum = solve_problem(problem, evaluator, once, fit).optimum;
    if (optimum.ok) z = optimum.z;
    fit.message = "nuisance parameters: " + fit.message;
  }
  const auto known = describe_known(problem, values);
  fit.parameters.insert(fit.parameters.end(), known.begin(), known.end());
  if (fit.status == FitStatus::stopped) {
    fit.stopped_in = StoppedIn::validation;
    fit.conditions = unscored_conditions(problem, fit.message);
    return fit;
  }
  const EffectCovariance effects = covariance != nullptr ? covariance->effects : EffectCovariance{};
  fit.conditions = score_conditions(problem, z, options.threads, effects);
  if (covariance != nullptr) {
    const auto changes = predicted_changes(problem, z, effects, options.threads, options.cancel);
    add_prediction_sd(problem, z, *covariance, changes, options.threads, fit.conditions);
    test_predictions(problem, covariance->dates, fit.conditions);
  }
  if (is_raised(late.flag())) {
    fit.status = FitStatus::stopped;
    fit.stopped_in = StoppedIn::validation;
    fit.message = budget.reason();
    return fit;
  }
  if (problem.map.unknowns().empty() &&
      std::all_of(fit.conditions.begin(), fit.conditions.end(),
                  [](const ConditionScore& score) { return score.failure.has_value(); })) {
    fit.status = FitStatus::failed;
    fit.message = "no condition could be simulated";
  }
  return fit;
}

/// Returns the name of a stage in messages.
std::string_view words(StoppedIn stage) {
  switch (stage) {
    case StoppedIn::starts:
      return "search";
    case StoppedIn::validation:
      return "scoring";
    case StoppedIn::bootstrap:
      return "bootstrap";
    case StoppedIn::profiles:
      return "profiles' computation";
    case StoppedIn::posterior:
      return "sampling of the posterior";
    case StoppedIn::cross_validation:
      return "cross-validation";
  }
  return "";
}

/// Adds the nuisance parameters and scores of the validate conditions to a fit.
void add_validation(Fit validation, Fit& fit) {
  for (FittedParameter& each : validation.parameters) {
    if (each.fitted) fit.parameters.push_back(std::move(each));
  }
  if (validation.status != FitStatus::converged)
    fit.warnings.push_back("validate conditions: " + validation.message);
  for (const std::string& text : validation.warnings)
    fit.warnings.push_back("validate conditions: " + text);
  fit.evaluations += validation.evaluations;
  std::move(validation.conditions.begin(), validation.conditions.end(),
            std::back_inserter(fit.conditions));
}

}  // namespace

Fit fit(const Campaign& campaign, const std::vector<Record>& records, const FitOptions& options) {
  options.validate();
  const auto began = Clock::now();
  const auto fitted = conditions_of(campaign, {Use::fit});
  const auto validated = conditions_of(campaign, {Use::validate});
  if (fitted.empty()) {
    throw InputError({campaign.file.string()},
                     "no condition has use = \"fit\": expected at least one");
  }
  const LateFlag late(options.cancel);
  Problem problem = make_problem(campaign, records, fitted, false, nullptr);
  problem.cancel = late.flag();
  if (problem.map.unknowns().empty()) {
    throw InputError(
        {campaign.file.string()},
        "no parameter is free in the conditions of the fit: expected `fit = true` at a "
        "parameter, or --free");
  }
  // If only the validation uses a leak level, it has no fitted value. This is reported before a fit
  // that may take hours.
  std::vector<FittedValue> starts;
  for (const Unknown& unknown : problem.map.unknowns()) {
    if (!unknown.nuisance)
      starts.push_back({unknown.index, unknown.scope, unknown.level, unknown.start});
  }
  for (const Condition* condition : validated) values_with(campaign, *condition, starts);

  Fit result;
  warn_of_start(campaign, fitted, records, result);
  Budget budget = budget_of(campaign, options, began);
  Evaluator evaluator(problem, budget, options.threads);
  evaluator.keep_rows();
  Solved solved = solve_from_starts(problem, evaluator, options, result);
  if (solved.optimum.ok) {
    std::optional<EffectLikelihood> effects;  // large, and only the posterior needs it
    if (result.status == FitStatus::converged && options.consider) {
      consider_effects(problem, solved.optimum.z, solved.uncertainty, options.threads,
                       options.cancel, result, options.posterior > 0 ? &effects : nullptr);
    }
    solved.uncertainty.scores = {};
    std::optional<EstimateCovariance> covariance;
    if (result.status == FitStatus::converged) {
      covariance = estimate_covariance(problem, solved.optimum.z, solved.uncertainty);
      covariance->effects = effects_beside(result, *covariance);
      covariance->dates = dates_of(fitted);
    }
    result.conditions = score_conditions(problem, solved.optimum.z, options.threads,
                                         covariance ? covariance->effects : EffectCovariance{});
    if (covariance) {
      add_prediction_sd(problem, solved.optimum.z, *covariance, {}, options.threads,
                        result.conditions);
    }
    const bool unscored = is_raised(late.flag());
    // Conditions are scored before the steps that may take hours, so that stopping those does not
    // change a score.
    std::optional<Fit> validation;
    if (!validated.empty()) {
      const auto values = values_of(result.parameters);
      FitOptions quiet = options;
      quiet.progress = nullptr;
      validation = score_at(campaign, records, validated, &values, quiet, budget, late,
                            covariance ? &*covariance : nullptr);
    }
    if (result.considered && validation && validation->status == FitStatus::converged) {
      repeat_on_validation(make_problem(campaign, records, validated, false, nullptr),
                           validation->parameters, dates_of(fitted), options.threads,
                           options.cancel, result);
    }
    if (result.status == FitStatus::stopped) result.stopped_in = StoppedIn::starts;
    if (result.status == FitStatus::converged && validation)
      result.stopped_in = validation->stopped_in;
    if (result.status == FitStatus::converged && unscored)
      result.stopped_in = StoppedIn::validation;
    if (result.status == FitStatus::converged) {
      run_requested_steps(problem, campaign, records, solved, effects, options, budget, result);
    } else if (asks_for_more(options)) {
      result.message +=
          "; bootstrap, profiles, posterior and cross-validation require a converged fit";
    }
    if (validation) add_validation(std::move(*validation), result);
    if (result.status == FitStatus::converged && result.stopped_in) {
      result.status = FitStatus::stopped;
      result.message += fmt::format("; the {} was {}", words(*result.stopped_in), budget.reason());
    }
  }
  const auto known = describe_known(problem);
  result.parameters.insert(result.parameters.end(), known.begin(), known.end());
  finish(campaign, records, began, nullptr, result);
  return result;
}

Fit validate(const Campaign& campaign, const std::vector<Record>& records,
             const std::vector<FittedValue>* values, const FitOptions& options,
             const Origin* origin) {
  options.validate();
  const auto began = Clock::now();
  const auto conditions = conditions_of(campaign, {Use::fit, Use::validate});
  if (conditions.empty()) {
    throw InputError({campaign.file.string()},
                     "no condition has use = \"fit\" or \"validate\": expected at least one");
  }
  Budget budget = budget_of(campaign, options, began);
  const LateFlag late(options.cancel);
  Fit result = score_at(campaign, records, conditions, values, options, budget, late,
                        origin != nullptr && origin->covariance ? &*origin->covariance : nullptr);
  finish(campaign, records, began, origin, result);
  return result;
}

}  // namespace rigcal::calib
