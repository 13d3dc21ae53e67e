#include "calib/fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "calib/cross_validation.hpp"
#include "calib/problem/initial_state.hpp"
#include "calib/problem/known_values.hpp"
#include "calib/score/assessment.hpp"
#include "calib/score/scorecard.hpp"
#include "calib/search/basins.hpp"
#include "calib/search/budget.hpp"
#include "calib/search/checkpoint.hpp"
#include "calib/search/evaluator.hpp"
#include "calib/search/multi_start.hpp"
#include "calib/search/verify.hpp"
#include "calib/search/weights.hpp"
#include "calib/trust/bootstrap.hpp"
#include "calib/trust/combinations.hpp"
#include "calib/trust/identifiability.hpp"
#include "calib/trust/information.hpp"
#include "calib/trust/interval_advice.hpp"
#include "calib/trust/lack_of_fit.hpp"
#include "calib/trust/prediction_band.hpp"
#include "calib/trust/profile.hpp"
#include "calib/trust/symmetry.hpp"
#include "datasets/checks/record_warnings.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Condition;
using datasets::FittedValue;
using datasets::Record;
using datasets::Use;
using Clock = Evaluator::Clock;

/// Step budget of a later point, relative to what the start takes at a coarse tolerance: it may
/// have to be simulated to its end where the start soon becomes periodic.
constexpr long kStepsOverStart = 1000;
constexpr long kLeastSteps = 20'000;

std::vector<const Condition*> conditions_of(const Campaign& campaign, std::vector<Use> uses) {
  std::vector<const Condition*> result;
  for (const Condition& condition : campaign.conditions) {
    if (std::find(uses.begin(), uses.end(), condition.use) != uses.end())
      result.push_back(&condition);
  }
  return result;
}

void budget_steps(Problem& problem, const Evaluation& start) {
  if (!start.ok) return;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    problem.conditions[i].max_steps =
        std::max(kLeastSteps, kStepsOverStart * start.conditions[i].steps);
  }
}

std::vector<FittedValue> values_of(const std::vector<FittedParameter>& parameters) {
  std::vector<FittedValue> values;
  for (const FittedParameter& each : parameters) {
    if (each.fitted && !each.nuisance)
      values.push_back({each.index, each.scope, each.level, each.value});
  }
  return values;
}

void add_correlation(const Problem& problem, const Uncertainty& found, Fit& fit) {
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < found.standard_error.size(); ++j) {
    if (!found.standard_error[j]) continue;
    rows.push_back(static_cast<Eigen::Index>(j));
    fit.correlation_names.push_back(problem.name(j));
  }
  fit.correlation = found.correlation(rows, rows);
}

void warn_of_noise(const Problem& problem, const Uncertainty& found, Fit& fit) {
  const double chi = found.reduced_chi_square;
  const double freedom = std::max(1.0, static_cast<double>(fit.residual_count - found.rank));
  const double scatter = 5.0 * std::sqrt(2.0 / freedom);
  if (fit.residual_count <= found.rank) {
    fit.warnings.push_back(
        fmt::format("{} residuals for {} unknowns: nothing is left to tell the noise by",
                    fit.residual_count, problem.map.unknowns().size()));
  } else if (chi > 1.0 + std::max(0.1, scatter)) {
    fit.warnings.push_back(fmt::format(
        "the residuals are {:.3g} times as large as the noise (reduced chi-square {:.4g}): the "
        "model does not explain all of the records; standard errors are scaled up by that factor",
        std::sqrt(chi), chi));
  } else if (!problem.has_estimated_sd() && chi < 1.0 - std::max(0.5, scatter)) {
    fit.warnings.push_back(
        fmt::format("the residuals are only {:.3g} times as large as the noise (reduced chi-square "
                    "{:.4g}): the stated standard deviations are too large",
                    std::sqrt(chi), chi));
  }
}

/// A prior that the records contradict pulls the fit off both.
void warn_of_priors(const Problem& problem, const std::vector<FittedParameter>& parameters,
                    Fit& fit) {
  constexpr double kFar = 3.0;
  const auto warn = [&](const std::string& name, double value, const datasets::Prior& prior,
                        std::string_view unit, const char* what) {
    const double pull = std::abs(value - prior.mean) / prior.sd;
    if (pull <= kFar) return;
    fit.warnings.push_back(
        fmt::format("{}: {} {:.4g} {}, {:.2g} standard deviations of its prior from {:.4g} {}",
                    name, what, value, unit, pull, prior.mean, unit));
  };
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    if (const auto& prior = problem.map.unknowns()[j].prior) {
      warn(problem.name(j), parameters[j].value, *prior, problem.spec(j).unit,
           "records and prior disagree: the fit ends at");
    }
  }
  const auto table = model::parameter_table(problem.campaign->rig.plant);
  for (const auto& setting : problem.campaign->parameters) {
    if (!setting.prior || setting.fit) continue;
    const auto& spec = table[static_cast<std::size_t>(setting.index)];
    warn(std::string(spec.key), setting.value, *setting.prior, spec.unit, "known, and taken to be");
  }
}

/// Names in words what is not to be trusted about the parameters.
void warn_of_parameters(const Problem& problem, const std::vector<FittedParameter>& parameters,
                        Fit& fit) {
  std::vector<std::string> bounded;
  std::vector<std::string> loose;
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const FittedParameter& each = parameters[j];
    if (each.at_bound) bounded.push_back(problem.name(j));
    if (each.identifiability == Identifiability::not_identifiable && !each.nuisance)
      loose.push_back(problem.name(j));
    const bool says_something = each.at_bound || !each.standard_error ||
                                each.identifiability != Identifiability::identified;
    if (says_something) fit.warnings.push_back(fmt::format("{}: {}", problem.name(j), each.reason));
  }
  if (!bounded.empty()) fit.message += fmt::format("; at a bound: {}", fmt::join(bounded, ", "));
  if (!loose.empty()) fit.message += fmt::format("; not identifiable: {}", fmt::join(loose, ", "));
}

Budget budget_of(const Campaign& campaign, const FitOptions& options, Clock::time_point began) {
  const auto limit_s = options.max_seconds ? options.max_seconds : campaign.fit.max_seconds;
  return Budget(options.cancel, began, limit_s, options.max_evaluations);
}

/// What a search may take of what is left of the budget.
Evaluator::Options evaluator_options(const FitOptions& options, const Budget& budget) {
  return {options.threads, budget.cancel(), budget.deadline(), budget.evaluations_left()};
}

/// Akaike's and Schwarz's criteria. The noise is known, or was estimated from the residual: 2 cost
/// is -2 ln(likelihood) but for a constant, of which correlated residuals tell only their share.
void rate_model(const Uncertainty& spread, Fit& fit) {
  const double residuals = std::max(1.0, static_cast<double>(fit.residual_count));
  const double effective = spread.scatter.empty() ? residuals : spread.independent_residuals;
  const double weighed = 2.0 * fit.cost * std::min(1.0, effective / residuals);
  fit.aic = weighed + 2.0 * spread.rank;
  fit.bic = weighed + spread.rank * std::log(std::max(1.0, effective));
}

/// What the residuals say of the noise, and of the intervals that rest on it.
void judge_residuals(const Problem& problem, const OptimumCheck& check, const Uncertainty& spread,
                     Fit& fit) {
  fit.independent_residuals = spread.independent_residuals;
  fit.lack_of_fit = lack_of_fit(problem, spread);
  fit.misfit = misfit(fit.lack_of_fit);
  fit.interval_advice = interval_advice(problem, check, spread, fit.lack_of_fit);
  fit.between_repeats = between_repeats(problem, spread);
  if (fit.between_repeats && fit.between_repeats->differ)
    fit.warnings.push_back(between_repeats_warning(*fit.between_repeats));
  if (spread.noiseless > 0) fit.warnings.push_back(noiseless_warning(problem, spread));
  if (!spread.known.names.empty()) {
    fit.interval_advice += fmt::format("; the errors hold those of known values: {}",
                                       fmt::join(spread.known.names, ", "));
  }
  rate_model(spread, fit);
}

/// Says what would tell parameters that the records do not; the first few, since each is tried. Of
/// those that a symmetry leaves open its own words tell.
void add_remedies(const Problem& problem, const Evaluation& optimum,
                  const std::vector<std::size_t>& symmetric, const Uncertainty& spread,
                  std::vector<FittedParameter>& parameters) {
  constexpr int kMostTried = 4;
  int tried = 0;
  const Eigen::MatrixXd jacobian = linearise(problem, optimum).jacobian;
  for (std::size_t j = 0; j < parameters.size() && tried < kMostTried; ++j) {
    FittedParameter& each = parameters[j];
    if (each.nuisance || each.identifiability != Identifiability::not_identifiable) continue;
    if (std::find(symmetric.begin(), symmetric.end(), j) != symmetric.end()) continue;
    if (rests_on_known(problem, spread, optimum.z, j)) {
      each.reason += fmt::format(
          "; most of that is what is uncertain of {}: with fit = true there, and its prior, the "
          "records may tell more",
          fmt::join(spread.known.names, ", "));
      continue;
    }
    ++tried;
    const auto words = remedies(problem, optimum.z, jacobian, j);
    if (!words.empty())
      each.reason += fmt::format("; {} would make it identifiable", fmt::join(words, ", or "));
  }
}

/// What is fixed where single parameters are not, and what would tell them.
///
/// @return  the unknowns that a scaling symmetry leaves open
std::vector<std::size_t> judge_identifiability(const Problem& problem, const Evaluation& optimum,
                                               const Uncertainty& spread, int threads, Fit& fit) {
  const double sigma = std::sqrt(std::max(1.0, spread.reduced_chi_square));
  const auto symmetry = scaling_symmetry(problem, optimum.z, sigma, threads);
  const std::string symmetric = symmetry ? describe(problem, *symmetry) : "";
  if (symmetry) grade_symmetric(problem, *symmetry, fit.parameters);
  fit.combinations = name_combinations(problem, optimum.z, spread, fit.parameters);
  if (!symmetric.empty()) {
    // The other combinations are among the reasons of their parameters already.
    fit.combinations.insert(fit.combinations.begin(), symmetric);
    fit.warnings.push_back(symmetric);
  }
  const auto open = symmetry && symmetry->holds() ? symmetry->unknowns : std::vector<std::size_t>();
  add_remedies(problem, optimum, open, spread, fit.parameters);
  return open;
}

/// What every later look at a fit needs; the optimum is not ok where there is none.
struct Solved {
  Evaluation optimum;
  Uncertainty spread;
  std::vector<std::size_t> open;  ///< unknowns that a scaling symmetry leaves open
};

/// Solves a problem and describes what was found, all but the scores.
Solved solve_problem(Problem& problem, Evaluator& evaluator, const FitOptions& options, Fit& fit) {
  evaluator.set_fidelity(problem.of_starts());
  budget_steps(problem, evaluator.evaluate(problem.start()));
  MultiStart found = multi_start(problem, evaluator, options);
  if (found.optimum.ok && problem.has_estimated_sd())
    estimate_weights(problem, evaluator, options, found, fit.warnings);
  std::vector<ConditionRows> rows = verify_optimum(problem, evaluator, options, found);
  fit.status = found.result.status;
  fit.message = found.result.message;
  fit.starts = std::move(found.starts);
  const auto made = static_cast<int>(fit.starts.size());
  if (made < options.starts && fit.status == FitStatus::converged) {
    // Starts that were never made could have been better.
    fit.status = FitStatus::stopped;
    fit.message = fmt::format("stopped after {} of {} starts; the best of these {}", made,
                              options.starts, fit.message);
  }
  fit.best_start = found.best;
  fit.evaluations = evaluator.counters().evaluations;
  fit.failures = evaluator.counters().failures;
  fit.failure_count = evaluator.counters().failure_count;
  fit.residual_count = problem.residual_count();
  fit.tolerance = problem.tolerance;
  if (!found.optimum.ok) {
    if (fit.starts.size() > 1)
      fit.message = "no start could be simulated; of the first: " + fit.message;
    return {};
  }
  fit.cost = found.optimum.cost;
  Uncertainty spread = uncertainty(problem, found.optimum, std::move(rows), options.threads);
  fit.rank = spread.rank;
  fit.singular_values = spread.singular_values;
  fit.reduced_chi_square = spread.reduced_chi_square;
  fit.parameters = describe_unknowns(problem, found.optimum, found.result.check, spread);
  const double variance = std::max(1.0, fit.reduced_chi_square);
  fit.basins = basins(fit.starts, fit.parameters, variance);
  fit.agreement = agreement_of(fit.starts, fit.basins, variance);
  auto open = judge_identifiability(problem, found.optimum, spread, options.threads, fit);
  judge_residuals(problem, found.result.check, spread, fit);
  add_correlation(problem, spread, fit);
  warn_of_noise(problem, spread, fit);
  warn_of_parameters(problem, fit.parameters, fit);
  warn_of_priors(problem, fit.parameters, fit);
  return {std::move(found.optimum), std::move(spread), std::move(open)};
}

/// Solves a problem; where its only start ends at no minimum, goes on with further starts as a
/// multi-start would that had begun with that one.
Solved solve_from_starts(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                         Fit& fit) {
  if (options.starts > 1 || options.further_starts == 0)
    return solve_problem(problem, evaluator, options, fit);
  const Problem fresh = problem;
  const std::vector<std::string> warnings = fit.warnings;
  Solved first = solve_problem(problem, evaluator, options, fit);
  const bool lost = fit.status == FitStatus::failed && first.optimum.ok && !evaluator.aborted();
  if (!lost) return first;
  const Checkpoint checkpoint{fit.starts, fit.best_start, first.optimum.z, evaluator.counters()};
  FitOptions more = options;
  more.starts += options.further_starts;
  more.resume = &checkpoint;
  problem = fresh;  // the weights of a point that is no minimum are not those of the others
  evaluator.forget();
  const std::string why = fit.message;
  fit = {};
  fit.warnings = warnings;
  fit.warnings.push_back(
      fmt::format("the start of the campaign led to no minimum ({}): {} further starts were made, "
                  "as with --starts {}",
                  why, options.further_starts, more.starts));
  return solve_problem(problem, evaluator, more, fit);
}

bool asks_for_more(const FitOptions& options) {
  return options.bootstrap > 0 || options.profiles || options.cross_validate;
}

/// What was asked for beside the fit: bootstrap, profiles, cross-validation.
/// Where the budget ends it, what was made by then is kept.
void look_again(const Problem& problem, const Campaign& campaign,
                const std::vector<Record>& records, const Solved& solved, const FitOptions& options,
                Budget& budget, Fit& fit) {
  const auto note = [&](StoppedIn stage) {
    if (budget.spent() && fit.stopped_in == StoppedIn::nothing) fit.stopped_in = stage;
  };
  if (options.bootstrap > 0) {
    bootstrap(problem, solved.optimum, solved.spread, fit.conditions, options, fit, &budget);
    note(StoppedIn::bootstrap);
  }
  if (options.profiles) {
    profiles(problem, records, solved.optimum, options, fit, &budget);
    note(StoppedIn::profiles);
  }
  for (const std::size_t j : solved.open) {  // the smoothing of roots would bound them, no record
    fit.parameters[j].bootstrap.reset();
    fit.parameters[j].profile.reset();
  }
  const std::string compared = compare_intervals(problem, fit.parameters, solved.spread.known.names,
                                                 fit.misfit.value_or(false));
  if (!compared.empty()) fit.interval_advice += "; " + compared;
  if (options.cross_validate) {
    fit.cross_validation = cross_validate(campaign, records, fit, options, &budget);
    note(StoppedIn::cross_validation);
    fit.interval_advice += "; " + cross_validation_summary(fit.cross_validation);
    const auto words = cross_validation_words(fit.cross_validation);
    fit.warnings.insert(fit.warnings.end(), words.begin(), words.end());
  }
}

/// The lack of fit of every scored condition that is not among those fitted to.
void add_predictions(Fit& fit) {
  std::vector<LackOfFit> predictions;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& channel : score.channels) {
      const bool there =
          std::any_of(fit.lack_of_fit.begin(), fit.lack_of_fit.end(), [&](const LackOfFit& test) {
            return test.condition == score.id && test.channel == channel.channel;
          });
      if (channel.lack_of_fit && !there) predictions.push_back(*channel.lack_of_fit);
    }
  }
  judge_together(predictions);
  fit.lack_of_fit.insert(fit.lack_of_fit.end(), predictions.begin(), predictions.end());
}

/// Conditions that the values of a campaign are taken to be estimated from.
std::set<std::string> fitted_conditions(const Campaign& campaign) {
  std::set<std::string> ids;
  for (const Condition& condition : campaign.conditions) {
    if (condition.use == Use::fit) ids.insert(condition.id);
  }
  return ids;
}

/// What was found doubtful about the recordings, on with the result that rests on them: once for
/// all conditions of which the same is said.
void add_record_warnings(const std::vector<Record>& records, Fit& fit) {
  std::vector<const Record*> used;
  for (ConditionScore& score : fit.conditions) {
    const auto record = std::find_if(records.begin(), records.end(), [&](const Record& each) {
      return each.condition == score.id;
    });
    if (record == records.end()) continue;
    score.data_warnings = record->warnings;
    used.push_back(&*record);
  }
  for (const auto& each : datasets::gathered_warnings(used))
    fit.warnings.push_back(each.with_conditions());
}

/// Puts scores in the order of the campaign and judges them together.
///
/// @param origin  of the values where they are an earlier fit's
void finish(const Campaign& campaign, const std::vector<Record>& records, Clock::time_point began,
            const Origin* origin, Fit& fit) {
  std::stable_sort(fit.conditions.begin(), fit.conditions.end(), [&](const auto& a, const auto& b) {
    return campaign.find(a.id) < campaign.find(b.id);
  });
  add_predictions(fit);
  add_record_warnings(records, fit);
  fit.assessment = assess(campaign, fit,
                          origin != nullptr ? origin->estimated_from : fitted_conditions(campaign),
                          origin != nullptr ? &origin->parameters : nullptr);
  fit.verdict = verdict_of(fit.assessment);
  const auto words = overfitting_warnings(fit.conditions);
  fit.warnings.insert(fit.warnings.end(), words.begin(), words.end());
  for (const ConditionScore& score : fit.conditions) {
    if (!score.failure.empty()) {
      fit.warnings.push_back(
          fmt::format("condition \"{}\" could not be simulated: {}", score.id, score.failure));
    }
  }
  fit.wall_seconds = std::chrono::duration<double>(Clock::now() - began).count();
}

void warn_of_start(const Campaign& campaign, const std::vector<const Condition*>& conditions,
                   const std::vector<Record>& records, Fit& fit) {
  const std::string text = moving_start(campaign, conditions, records);
  if (!text.empty()) fit.warnings.push_back(text);
}

/// Scores conditions at known values, nuisance parameters estimated anew.
///
/// @param spread  of the values, for bands of prediction; null: none
Fit score_at(const Campaign& campaign, const std::vector<Record>& records,
             const std::vector<const Condition*>& conditions,
             const std::vector<FittedValue>* values, const FitOptions& options, Budget& budget,
             const EstimateSpread* spread = nullptr) {
  Fit fit;
  warn_of_start(campaign, conditions, records, fit);
  Problem problem = make_problem(campaign, records, conditions, true, values);
  Evaluator evaluator(problem, evaluator_options(options, budget));
  FitOptions once = options;
  once.starts = 1;
  once.resume = nullptr;
  once.checkpoint = nullptr;
  std::vector<double> z = problem.start();
  if (problem.map.unknowns().empty()) {
    fit.status = FitStatus::converged;
    fit.message = "scored at known values; nothing was estimated";
    fit.residual_count = problem.residual_count();
    fit.tolerance = problem.tolerance;
  } else {
    const Evaluation optimum = solve_problem(problem, evaluator, once, fit).optimum;
    if (optimum.ok) z = optimum.z;
    fit.message = "nuisance parameters: " + fit.message;
    budget.count(evaluator.counters().evaluations);
  }
  const auto known = describe_known(problem, values);
  fit.parameters.insert(fit.parameters.end(), known.begin(), known.end());
  if (fit.status == FitStatus::stopped) {
    fit.stopped_in = StoppedIn::validation;
    fit.conditions = unscored_conditions(problem, fit.message);
    return fit;
  }
  fit.conditions = score_conditions(problem, z, options.threads);
  if (spread != nullptr) add_prediction_sd(problem, z, *spread, options.threads, fit.conditions);
  if (problem.map.unknowns().empty() &&
      std::all_of(fit.conditions.begin(), fit.conditions.end(),
                  [](const ConditionScore& score) { return !score.failure.empty(); })) {
    fit.status = FitStatus::failed;
    fit.message = "no condition could be simulated";
  }
  return fit;
}

/// What was being made, in words.
std::string_view words(StoppedIn stage) {
  switch (stage) {
    case StoppedIn::nothing:
      break;
    case StoppedIn::starts:
      return "search";
    case StoppedIn::validation:
      return "estimation of the validation's nuisance parameters";
    case StoppedIn::bootstrap:
      return "bootstrap";
    case StoppedIn::profiles:
      return "profiles' computation";
    case StoppedIn::cross_validation:
      return "cross-validation";
  }
  return "";
}

/// Nuisance parameters and scores of the validate conditions join a fit.
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
  Problem problem = make_problem(campaign, records, fitted, false, nullptr);
  if (problem.map.unknowns().empty()) {
    throw InputError({campaign.file.string()},
                     "nothing is free in the conditions of the fit: expected `fit = true` at a "
                     "parameter, or --free");
  }
  // A leak level that only validation has must be told before the hours of a fit, not after.
  std::vector<FittedValue> starts;
  for (const Unknown& unknown : problem.map.unknowns()) {
    if (!unknown.nuisance)
      starts.push_back({unknown.index, unknown.scope, unknown.level, unknown.start});
  }
  for (const Condition* condition : validated) values_with(campaign, *condition, starts);

  Fit result;
  warn_of_start(campaign, fitted, records, result);
  Budget budget = budget_of(campaign, options, began);
  Evaluator evaluator(problem, evaluator_options(options, budget));
  const Solved solved = solve_from_starts(problem, evaluator, options, result);
  if (solved.optimum.ok) {
    result.conditions = score_conditions(problem, solved.optimum.z, options.threads);
    std::optional<EstimateSpread> spread;
    if (result.status == FitStatus::converged) {
      spread = estimate_spread(problem, solved.optimum.z, solved.spread);
      add_prediction_sd(problem, solved.optimum.z, *spread, options.threads, result.conditions);
    }
    budget.count(evaluator.counters().evaluations);
    // Before what may take hours, so that a stop there changes no score.
    std::optional<Fit> validation;
    if (!validated.empty()) {
      const auto values = values_of(result.parameters);
      FitOptions quiet = options;
      quiet.progress = nullptr;
      validation = score_at(campaign, records, validated, &values, quiet, budget,
                            spread ? &*spread : nullptr);
    }
    if (result.status == FitStatus::stopped) result.stopped_in = StoppedIn::starts;
    if (result.status == FitStatus::converged && validation)
      result.stopped_in = validation->stopped_in;
    if (result.status == FitStatus::converged) {
      look_again(problem, campaign, records, solved, options, budget, result);
    } else if (asks_for_more(options)) {
      result.message +=
          "; bootstrap, profiles and cross-validation are made of what converged only";
    }
    if (validation) add_validation(std::move(*validation), result);
    if (result.status == FitStatus::converged && result.stopped_in != StoppedIn::nothing) {
      result.status = FitStatus::stopped;
      result.message += fmt::format("; the {} was {}", words(result.stopped_in), budget.reason());
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
  Fit result = score_at(campaign, records, conditions, values, options, budget);
  finish(campaign, records, began, origin, result);
  return result;
}

}  // namespace rigcal::calib
