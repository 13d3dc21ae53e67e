#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/score/groups.hpp"
#include "calib/score/validity.hpp"
#include "calib/score/worst.hpp"
#include "metrics/metric_table.hpp"
#include "metrics/significance.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"
#include "report/store/result.hpp"
#include "report/store/stored/stored_provenance.hpp"
#include "report/store/stored/stored_record.hpp"
#include "report/store/stored/stored_residual_tests.hpp"

// fit.json and validation.json (docs/command-line.md). Values are in SI units, and names end in the
// unit. A value that does not exist is null, and the reason, problem or message next to it says
// why.

namespace rigcal::report {

template <>
inline std::vector<model::PlantKind> every() {
  std::vector<model::PlantKind> all;
  for (const std::string& name : model::plant_names()) all.push_back(*model::plant_from_name(name));
  return all;
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

/// Converts parameters from an earlier schema to the current one: the earlier `ci95` becomes
/// `ci95_if_exact`.
void as_of_now(std::string_view schema, std::vector<calib::FittedParameter>& parameters);

/// Returns the error behind ci95_if_exact with its degrees of freedom. If an older file lacks them,
/// they are computed from the interval's half width in units of the error. Without an interval a
/// large number is assumed.
std::optional<metrics::EstimateError> interval_error(const calib::FittedParameter& parameter);
/// Returns the larger of standard and robust error.
std::optional<double> error_of(const calib::FittedParameter& parameter);
using calib::parameter_label;
/// Returns the key of a parameter with its level.
inline std::string parameter_label(const calib::FittedParameter& p) {
  return parameter_label(p.key, p.scope, p.level);
}

/// Divisor that weights the residuals of a channel.
struct StoredWeight {
  std::string condition, channel;
  long samples = 0;
  std::optional<double> sd, rms;
  RIGCAL_DESCRIBE(condition, channel, samples, sd, rms)
};

struct StoredCondition {
  std::string id;
  Later<std::optional<datasets::Waveform>> waveform;
  Later<std::optional<double>> frequency_hz, amplitude_m;
  Omittable<std::optional<double>> amplitude_v;  ///< open loop only
  Omittable<double> amplitude_n, amplitude_pa, amplitude_m_per_s2,
      amplitude_rad;  ///< in other loops
  Later<std::optional<std::string>> leak_level;
  datasets::Use use = datasets::Use::fit;
  Omittable<double> temperature_k;
  Omittable<std::string> date;
  long samples = 0;
  Later<std::vector<std::string>> record_sha256;  ///< files that the record is made from
  Omittable<std::vector<Range>> windows_s;        ///< empty: the whole record
  Omittable<std::vector<std::string>> notes;
  Omittable<std::vector<datasets::AcceptanceLimit>>
      acceptance;                                  ///< limits that replace the campaign's
  Omittable<std::vector<std::string>> not_judged;  ///< in addition to those of the campaign
  Later<std::vector<std::string>> warnings;
  Later<std::optional<std::string>> not_scored;
  std::optional<std::string> failure;
  Keyed<calib::ChannelMetrics> metrics;  ///< by channel, as are the next five
  Keyed<std::optional<metrics::NoiseFloor>> noise_floor;
  /// One-sided, for each score; used as the guard band of its limit.
  Omittable<Keyed<std::optional<metrics::Agreement>>> expanded_uncertainty;
  Omittable<Keyed<std::optional<metrics::Agreement>>> two_sided_uncertainty;  ///< printed after +-
  /// Contributions to the two-sided uncertainty, by channel and metric. Channels whose uncertainty
  /// is unknown are left out.
  Omittable<Keyed<Keyed<calib::Budget95>>> score_budgets;
  Keyed<std::optional<metrics::ResidualTests>, datasets::Channel> residual_tests;
  Later<std::vector<calib::LimitCheck>> limit_checks;
  Later<Keyed<calib::Verdict>> channel_verdicts;
  std::optional<calib::Verdict> verdict;
  std::vector<std::string> reasons;
  RIGCAL_DESCRIBE(id, waveform, frequency_hz, amplitude_m, amplitude_v, amplitude_n, amplitude_pa,
                  amplitude_m_per_s2, amplitude_rad, leak_level, use, temperature_k, date, samples,
                  record_sha256, windows_s, notes, acceptance, not_judged, warnings, not_scored,
                  failure, metrics, noise_floor, expanded_uncertainty, two_sided_uncertainty,
                  score_budgets, residual_tests, limit_checks, channel_verdicts, verdict, reasons)

  /// Returns the verdict on a channel; std::nullopt without a limit.
  std::optional<calib::Verdict> verdict_of(const std::string& channel) const;

  /// Returns the two-sided expanded uncertainty of each score of a channel, which is what a page
  /// prints after "±" and "U"; null if unknown. Files from earlier versions only have the one-sided
  /// uncertainty, which is returned instead.
  const metrics::Agreement* printed_uncertainty_of(const std::string& channel) const;
};

struct StoredFit {
  calib::FitStatus status = calib::FitStatus::failed;
  Later<std::optional<calib::StoppedIn>> stopped_in;
  std::string schema = kFitSchema;
  std::optional<calib::Verdict> verdict;
  Later<std::optional<calib::Assessment>> assessment;
  std::string message, campaign;
  bool synthetic = false;
  Json report;  ///< identity_json()
  Later<std::optional<model::PlantKind>> model;
  std::optional<double> cost;  ///< null if nothing was estimated or the fit failed
  long residual_count = 0;
  long evaluations = 0;
  std::optional<double> wall_seconds, simulation_tolerance;
  std::vector<calib::FittedParameter> parameters;
  calib::Correlation correlation;
  int rank = 0;
  std::vector<double> singular_values;
  std::optional<double> reduced_chi_square;
  Omittable<std::optional<double>> independent_residuals;  ///< null if unknown
  Later<std::string> interval_advice;
  Later<std::vector<std::string>> combinations;
  Later<std::optional<calib::LackOfFitTests>> lack_of_fit;
  Later<std::optional<calib::BetweenRepeats>> between_repeats;
  Omittable<calib::Considered> considered;
  Omittable<std::vector<calib::StabilityCheck>> stability;
  Later<std::vector<calib::Basin>> basins;
  Later<std::string> agreement;  ///< agreement of the starts, in words
  Omittable<calib::BootstrapRun> bootstrap;
  Omittable<calib::Posterior> posterior;
  Omittable<std::vector<calib::HeldOut>> cross_validation;
  Later<std::optional<double>> aic, bic;
  Omittable<std::vector<StoredWeight>> weights;
  calib::Validity validity;
  Omittable<calib::Validity> validated;  ///< ranges of the conditions that were not fitted
  Omittable<datasets::DecisionRule> decision;
  std::vector<datasets::AcceptanceLimit> acceptance;
  Omittable<std::vector<std::string>> not_judged;  ///< channels that need no limit
  std::vector<StoredCondition> conditions;
  std::vector<calib::Group> groups;
  std::vector<calib::StartReport> starts;
  int best_start = 0;
  long failure_count = 0;
  std::vector<calib::SimulationFailure> failures;
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

/// @param channel  empty: the whole condition
calib::Badness badness(const StoredCondition& condition, const std::string& channel = {});

/// Returns the drive frequency of a condition, if its drive is periodic.
std::optional<double> periodic_frequency(const StoredCondition& condition);

/// Converts a fit or validation to its stored form.
StoredFit stored(const Result& result);

}  // namespace rigcal::report
