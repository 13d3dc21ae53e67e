#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/result/estimate_spread.hpp"
#include "metrics/metric_table.hpp"
#include "metrics/significance.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/result.hpp"
#include "report/store/stored/stored_provenance.hpp"
#include "report/store/stored/stored_record.hpp"
#include "report/store/stored/stored_residual_tests.hpp"

// fit.json and validation.json, as docs/command-line.md describes them. SI; a name ends in its
// unit. A value that does not exist is null, and a reason, problem or message beside it says why.

namespace rigcal::report {

template <>
inline std::vector<model::PlantKind> every() {
  std::vector<model::PlantKind> all;
  for (const std::string& name : model::plant_names()) all.push_back(*model::plant_from_name(name));
  return all;
}
template <>
inline std::vector<datasets::DecisionRule> every() {
  return {datasets::DecisionRule::simple, datasets::DecisionRule::guard_band};
}
template <>
inline std::vector<calib::StoppedIn> every() {  // except `nothing`, which is null
  using calib::StoppedIn;
  return {StoppedIn::starts,   StoppedIn::validation, StoppedIn::bootstrap,
          StoppedIn::profiles, StoppedIn::posterior,  StoppedIn::cross_validation};
}
template <>
inline std::vector<calib::Verdict> every() {
  return {calib::Verdict::pass, calib::Verdict::warn, calib::Verdict::fail};
}
template <>
inline std::vector<calib::AspectState> every() {
  using calib::AspectState;
  return {AspectState::pass, AspectState::reservation, AspectState::fail, AspectState::not_assessed,
          AspectState::note};
}
template <>
inline std::vector<calib::Identifiability> every() {
  using calib::Identifiability;
  return {Identifiability::identified, Identifiability::weak, Identifiability::bounded,
          Identifiability::not_identifiable};
}
template <>
inline std::vector<calib::IntervalSource> every() {  // but for `none`, which is null
  return {calib::IntervalSource::standard_error, calib::IntervalSource::robust_standard_error};
}

struct StoredReason {
  std::string code;
  calib::AspectState state = calib::AspectState::pass;
  std::optional<std::string> subject;
  Keyed<double> numbers;
  std::string words;
  RIGCAL_DESCRIBE(code, state, subject, numbers, words)
};

struct StoredAspect {
  calib::AspectState state = calib::AspectState::not_assessed;
  std::vector<StoredReason> reasons;
  RIGCAL_DESCRIBE(state, reasons)
};

struct StoredAssessment {
  StoredAspect agreement, validation, adequacy, parameters;
  RIGCAL_DESCRIBE(agreement, validation, adequacy, parameters)
};

struct StoredBootstrap {
  double standard_error = 0.0, bias = 0.0, freedom = 0.0;
  std::optional<Range> ci95;
  RIGCAL_DESCRIBE(standard_error, bias, freedom, ci95)
};

/// One parameter over the draws of the posterior, SI.
struct StoredPosteriorSpread {
  double median = 0.0, sd = 0.0;
  std::optional<Range> ci95;
  std::optional<double> r_hat, bulk_draws, tail_draws;
  RIGCAL_DESCRIBE(median, sd, ci95, r_hat, bulk_draws, tail_draws)
};

struct StoredProfileEnd {
  std::optional<double> value, reached;
  Later<std::optional<bool>> lost;
  RIGCAL_DESCRIBE(value, reached, lost)
};

struct StoredProfile {
  StoredProfileEnd low, high;
  std::vector<double> values, rises;
  RIGCAL_DESCRIBE(low, high, values, rises)
};

/// One contribution to the uncertainty of an estimate, SI.
struct StoredBudgetLine {
  std::string source, kind;
  double uncertainty = 0.0;
  Omittable<double> sensitivity;  ///< change of the estimate per unit of an effect's size
  RIGCAL_DESCRIBE(source, kind, uncertainty, sensitivity)
};

/// Uncertainty budget of an estimate: the squares of the lines add up to that of the combined
/// standard uncertainty, SI.
struct StoredBudget {
  std::vector<StoredBudgetLine> lines;
  double combined = 0.0, degrees_of_freedom = 0.0, coverage_factor = 0.0, expanded = 0.0,
         shift = 0.0;
  RIGCAL_DESCRIBE(lines, combined, degrees_of_freedom, coverage_factor, expanded, shift)
};
/// What the lines of a kind contribute together: the root of the sum of their squares.
double contribution(const StoredBudget& budget, std::string_view kind);
/// The line of an effect that contributes most; null where there is none.
const StoredBudgetLine* largest_effect(const StoredBudget& budget);

/// A small effect that the model leaves out, SI.
struct StoredEffect {
  std::string key, meaning, unit, size_from;
  double size = 0.0;
  bool one_sided = false;
  std::optional<std::string> problem;
  std::optional<double> estimate, standard_error;
  std::optional<double> alone, alone_half_width, p_value, p_of_all;
  double explains = 0.0;
  RIGCAL_DESCRIBE(key, meaning, unit, size_from, size, one_sided, problem, estimate, standard_error,
                  alone, alone_half_width, p_value, p_of_all, explains)
};

/// An estimate made once more from the validation records alone, SI.
struct StoredStability {
  std::string key, unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;
  double value = 0.0, difference = 0.0, expanded = 0.0;
  bool differs = false;
  RIGCAL_DESCRIBE(key, unit, scope, level, value, difference, expanded, differs)
};

/// The fit made again with effects as further unknowns, SI.
struct StoredRefit {
  std::vector<std::string> effects;  ///< none: the model as it is
  std::vector<double> sizes;
  double fall = 0.0;  ///< of the sum of the squared residuals
  /// The same where each condition is predicted from the others; null with one condition.
  std::optional<double> held_out_fall;
  double weight = 0.0;  ///< by which it counts in the averaged estimates
  RIGCAL_DESCRIBE(effects, sizes, fall, held_out_fall, weight)
};

struct StoredConsidered {
  std::vector<StoredEffect> effects;
  std::vector<std::string> left_out;
  std::vector<std::string> missing;  ///< that the residuals ask for, the best explanation first
  Later<std::vector<StoredRefit>> refitted;
  /// Correlations of the sizes by prior and records, of the effects in their order; shorter where
  /// the last could not be considered.
  Later<std::vector<std::vector<double>>> correlation;
  RIGCAL_DESCRIBE(effects, left_out, missing, refitted, correlation)
};

/// An estimate over the models that were refitted, each with its weight, SI.
struct StoredAveraged {
  double value = 0.0, standard_error = 0.0;
  RIGCAL_DESCRIBE(value, standard_error)
};

/// The effects that a fit considered, beside some of its estimates.
///
/// @param budgets  of the estimates; null: none
calib::EffectSpread effect_spread_of(const StoredConsidered& considered,
                                     const std::vector<const StoredBudget*>& budgets);

/// A parameter, fitted or known.
struct StoredParameter {
  std::string name;  ///< that of results: "mass_kg"
  std::string key;   ///< key in campaign files
  std::string symbol, unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;  ///< leak level or condition
  std::optional<double> value, start, lower, upper;
  bool fitted = false;
  bool nuisance = false;
  std::optional<double> standard_error, robust_standard_error;
  std::optional<Range> ci95;                              ///< interval of the rig
  Later<std::optional<Range>> ci95_if_exact;              ///< if the model were exact
  Later<std::optional<calib::IntervalSource>> ci95_from;  ///< basis of ci95_if_exact
  Later<std::optional<double>> degrees_of_freedom;  ///< of the error that ci95_if_exact rests on
  Omittable<StoredBudget> budget;
  Omittable<StoredAveraged> averaged;    ///< where the residuals ask for an effect
  Omittable<double> between_days_error;  ///< standard error by what differs between days
  Omittable<StoredBootstrap> bootstrap;
  Omittable<StoredProfile> profile;
  Omittable<StoredPosteriorSpread> posterior;
  bool at_bound = false;
  std::optional<calib::Identifiability> identifiability;
  std::string reason;
  RIGCAL_DESCRIBE(name, key, symbol, unit, scope, level, value, start, lower, upper, fitted,
                  nuisance, standard_error, robust_standard_error, ci95, ci95_if_exact, ci95_from,
                  degrees_of_freedom, budget, averaged, between_days_error, bootstrap, profile,
                  posterior, at_bound, identifiability, reason)
};

/// What the parameters of a result of an earlier schema say today.
void as_of_now(std::string_view schema, std::vector<StoredParameter>& parameters);

/// The error that ci95_if_exact rests on, and its degrees of freedom. A file of a version that does
/// not tell these has them by the half width of that interval in errors, else many.
std::optional<metrics::EstimateError> interval_error(const StoredParameter& parameter);
/// The larger of standard and robust error.
std::optional<double> error_of(const StoredParameter& parameter);
/// "leakage_coefficient (leak level 33 %)": a parameter with whose it is.
std::string parameter_label(const std::string& key, datasets::Scope scope,
                            const std::optional<std::string>& level);
inline std::string parameter_label(const StoredParameter& p) {
  return parameter_label(p.key, p.scope, p.level);
}

struct StoredCorrelation {
  std::vector<std::string> names;
  std::vector<std::vector<double>> matrix;  ///< shape (names)^2
  RIGCAL_DESCRIBE(names, matrix)
};

struct StoredLackOfFitTest {
  std::string condition, channel;
  std::string against;  ///< "repeats" or "sd"
  double ratio = 0.0, freedom = 0.0, pure_error_freedom = 0.0, p = 0.0;
  metrics::TestOutcome outcome = metrics::TestOutcome::not_judged;
  std::optional<std::string> reason;
  RIGCAL_DESCRIBE(condition, channel, against, ratio, freedom, pure_error_freedom, p, outcome,
                  reason)
};

struct StoredLackOfFit {
  std::optional<bool> misfit;
  std::vector<StoredLackOfFitTest> tests;
  RIGCAL_DESCRIBE(misfit, tests)
};

struct StoredBetweenRepeats {
  bool differ = false;
  double p = 1.0, ratio = 0.0;
  std::vector<std::string> parameters;
  std::optional<std::string> cause;
  std::optional<double> cause_sd, cause_explains;
  RIGCAL_DESCRIBE(differ, p, ratio, parameters, cause, cause_sd, cause_explains)
};

struct StoredBasin {
  double cost = 0.0;
  std::vector<int> starts;
  std::vector<double> values;
  RIGCAL_DESCRIBE(cost, starts, values)
};

struct StoredBootstrapRun {
  int replicates = 0;
  std::string message;
  RIGCAL_DESCRIBE(replicates, message)
};

struct StoredKeptLimit {
  std::string condition, channel, metric;
  double limit = 0.0, probability = 0.0;
  std::optional<double> median;
  RIGCAL_DESCRIBE(condition, channel, metric, limit, probability, median)
};

/// Draws for pictures of pairs of parameters: every so-many-th of all, SI.
struct StoredPairs {
  std::vector<std::string> names;
  int every = 1;
  std::vector<std::vector<double>> values;  ///< shape (names, draws that are kept)
  RIGCAL_DESCRIBE(names, every, values)
};

/// The sampling of the posterior; all draws are in posterior.csv.
struct StoredPosterior {
  int chains = 0, warm_up = 0, draws = 0, asked = 0;
  long evaluations = 0;
  int diverged = 0, longest = 0;
  std::optional<double> energy_fraction, r_hat, least_draws;
  std::optional<std::string> worst;
  double noise_variance = 1.0;
  bool effects = false;  ///< whether small effects that the model leaves out were sampled
  int simulated = 0;
  std::vector<StoredKeptLimit> limits;
  StoredPairs pairs;
  std::string message;
  RIGCAL_DESCRIBE(chains, warm_up, draws, asked, evaluations, diverged, longest, energy_fraction,
                  r_hat, least_draws, worst, noise_variance, effects, simulated, limits, pairs,
                  message)
};

struct StoredHeldOut {
  std::string condition;
  std::optional<std::string> problem;
  Keyed<double> rmse, fitted_rmse;  ///< by channel
  std::optional<double> largest_shift;
  std::optional<std::string> shifted;
  RIGCAL_DESCRIBE(condition, problem, rmse, fitted_rmse, largest_shift, shifted)
};

/// Divisor of the residuals of a channel.
struct StoredWeight {
  std::string condition, channel;
  long samples = 0;
  std::optional<double> sd, rms;
  RIGCAL_DESCRIBE(condition, channel, samples, sd, rms)
};

struct StoredValidity {
  std::optional<Range> frequency_hz, amplitude_m, amplitude_v, supply_pressure_pa,
      leakage_coefficient;
  std::vector<std::string> leak_levels;
  Omittable<Range> amplitude_n, amplitude_pa, amplitude_m_per_s2;  ///< in other loops
  RIGCAL_DESCRIBE(frequency_hz, amplitude_m, amplitude_v, supply_pressure_pa, leakage_coefficient,
                  leak_levels, amplitude_n, amplitude_pa, amplitude_m_per_s2)
};

struct StoredLimit {
  std::string channel, metric;
  std::optional<double> limit, warn;
  RIGCAL_DESCRIBE(channel, metric, limit, warn)
};

struct StoredLimitCheck {
  std::string channel, metric;
  std::optional<double> value, limit, warn, tolerance_used;
  Omittable<double> expanded_uncertainty;
  calib::Verdict verdict = calib::Verdict::pass;
  RIGCAL_DESCRIBE(channel, metric, value, limit, warn, tolerance_used, expanded_uncertainty,
                  verdict)
};

/// Every metric of metrics/metric_table.hpp by its name; NaN where it does not exist.
struct StoredAgreement : metrics::Agreement {
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    for (const metrics::MetricSpec& metric : metrics::kMetrics)
      visit(metric.name.data(), self.*metric.value);
  }
};

/// The same for one channel of a condition, with the response at its fundamental.
struct StoredScore : StoredAgreement {
  std::optional<double> gain_ratio, phase_deg, delay_s;
  std::optional<std::string> problem;
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    StoredAgreement::describe(self, visit);
    visit("gain_ratio", self.gain_ratio);
    visit("phase_deg", self.phase_deg);
    visit("delay_s", self.delay_s);
    visit("problem", self.problem);
  }
};

struct StoredCondition {
  std::string id;
  Later<std::optional<datasets::Waveform>> waveform;
  Later<std::optional<double>> frequency_hz, amplitude_m;
  Omittable<std::optional<double>> amplitude_v;                     ///< in an open loop
  Omittable<double> amplitude_n, amplitude_pa, amplitude_m_per_s2;  ///< in other loops
  Later<std::optional<std::string>> leak_level;
  datasets::Use use = datasets::Use::fit;
  Omittable<double> temperature_k;
  Omittable<std::string> date;
  long samples = 0;
  Later<std::vector<std::string>> record_sha256;  ///< files that the record is made from
  Omittable<std::vector<Range>> windows_s;        ///< empty: the whole record
  Omittable<std::vector<std::string>> notes;
  Omittable<std::vector<StoredLimit>> acceptance;  ///< its own, in place of the campaign's
  Omittable<std::vector<std::string>> not_judged;  ///< in addition to those of the campaign
  Later<std::vector<std::string>> warnings;
  Later<std::optional<std::string>> not_scored;
  std::optional<std::string> failure;
  Keyed<StoredScore> metrics;  ///< by channel, like the three below
  Keyed<std::optional<StoredNoiseFloor>> noise_floor;
  /// Per score, one-sided: the guard band of its limit.
  Omittable<Keyed<std::optional<StoredAgreement>>> expanded_uncertainty;
  Omittable<Keyed<std::optional<StoredAgreement>>> two_sided_uncertainty;  ///< per score, of +-
  Keyed<std::optional<StoredResidualTests>> residual_tests;
  Later<std::vector<StoredLimitCheck>> limit_checks;
  Later<Keyed<calib::Verdict>> channel_verdicts;
  std::optional<calib::Verdict> verdict;
  std::vector<std::string> reasons;
  RIGCAL_DESCRIBE(id, waveform, frequency_hz, amplitude_m, amplitude_v, amplitude_n, amplitude_pa,
                  amplitude_m_per_s2, leak_level, use, temperature_k, date, samples, record_sha256,
                  windows_s, notes, acceptance, not_judged, warnings, not_scored, failure, metrics,
                  noise_floor, expanded_uncertainty, two_sided_uncertainty, residual_tests,
                  limit_checks, channel_verdicts, verdict, reasons)

  /// Verdict on a channel; nothing without a limit.
  std::optional<calib::Verdict> verdict_of(const std::string& channel) const;
};

struct StoredGroupScore {
  int conditions = 0;
  StoredAgreement mean, worst;
  RIGCAL_DESCRIBE(conditions, mean, worst)
};

struct StoredGroup {
  std::string by, label;
  std::vector<std::string> conditions;
  Keyed<StoredGroupScore> metrics;  ///< by channel
  RIGCAL_DESCRIBE(by, label, conditions, metrics)
};

struct StoredStart {
  int number = 1;
  calib::FitStatus status = calib::FitStatus::failed;
  std::string message;
  std::vector<double> start_values, end_values;
  std::optional<double> initial_cost, final_cost;
  int iterations = 0;
  RIGCAL_DESCRIBE(number, status, message, start_values, end_values, initial_cost, final_cost,
                  iterations)
};

struct StoredFailure {
  std::string condition;
  int start = 1;
  double time_s = 0.0;
  std::string reason;
  Keyed<double> parameters;
  RIGCAL_DESCRIBE(condition, start, time_s, reason, parameters)
};

struct StoredFit {
  calib::FitStatus status = calib::FitStatus::failed;
  Later<std::optional<calib::StoppedIn>> stopped_in;
  std::string schema = kFitSchema;
  std::optional<calib::Verdict> verdict;
  Later<std::optional<StoredAssessment>> assessment;
  std::string message, campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  Later<std::optional<model::PlantKind>> model;
  std::optional<double> cost;  ///< null if nothing was estimated, or the fit failed
  long residual_count = 0;
  long evaluations = 0;
  std::optional<double> wall_seconds, simulation_tolerance;
  std::vector<StoredParameter> parameters;
  StoredCorrelation correlation;
  int rank = 0;
  std::vector<double> singular_values;
  std::optional<double> reduced_chi_square;
  Omittable<std::optional<double>> independent_residuals;  ///< null: not known
  Later<std::string> interval_advice;
  Later<std::vector<std::string>> combinations;
  Later<std::optional<StoredLackOfFit>> lack_of_fit;
  Later<std::optional<StoredBetweenRepeats>> between_repeats;
  Omittable<StoredConsidered> considered;
  Omittable<std::vector<StoredStability>> stability;
  Later<std::vector<StoredBasin>> basins;
  Later<std::string> agreement;  ///< agreement of the starts, in words
  Omittable<StoredBootstrapRun> bootstrap;
  Omittable<StoredPosterior> posterior;
  Omittable<std::vector<StoredHeldOut>> cross_validation;
  Later<std::optional<double>> aic, bic;
  Omittable<std::vector<StoredWeight>> weights;
  StoredValidity validity;
  Omittable<StoredValidity> validated;  ///< ranges of the conditions that were not fitted
  Omittable<datasets::DecisionRule> decision;
  std::vector<StoredLimit> acceptance;
  Omittable<std::vector<std::string>> not_judged;  ///< channels that need no limit
  std::vector<StoredCondition> conditions;
  std::vector<StoredGroup> groups;
  std::vector<StoredStart> starts;
  int best_start = 0;
  long failure_count = 0;
  std::vector<StoredFailure> failures;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, stopped_in, schema, verdict, assessment, message, campaign, synthetic,
                  report, model, cost, residual_count, evaluations, wall_seconds,
                  simulation_tolerance, parameters, correlation, rank, singular_values,
                  reduced_chi_square, independent_residuals, interval_advice, combinations,
                  lack_of_fit, between_repeats, considered, stability, basins, agreement, bootstrap,
                  posterior, cross_validation, aic, bic, weights, validity, validated, decision,
                  acceptance, not_judged, conditions, groups, starts, best_start, failure_count,
                  failures, warnings, provenance)

  const StoredCondition* find(const std::string& condition) const;
};

/// Stored form of a fit or validation.
StoredFit stored(const Result& result);

}  // namespace rigcal::report
