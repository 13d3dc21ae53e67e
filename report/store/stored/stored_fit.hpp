#pragma once

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

struct StoredFit : Inlined<calib::Findings>, Inlined<calib::SearchOutcome> {
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
  Omittable<std::vector<StoredWeight>> weights;
  calib::Validity validity;
  Omittable<calib::Validity> validated;  ///< ranges of the conditions that were not fitted
  Omittable<datasets::DecisionRule> decision;
  std::vector<datasets::AcceptanceLimit> acceptance;
  Omittable<std::vector<std::string>> not_judged;  ///< channels that need no limit
  std::vector<calib::ConditionResult> conditions;
  std::vector<calib::Group> groups;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, stopped_in, schema, verdict, assessment, message, campaign, synthetic,
                  report, model, cost, residual_count, evaluations, wall_seconds,
                  simulation_tolerance, findings(), weights, validity, validated, decision,
                  acceptance, not_judged, conditions, groups, search(), warnings, provenance)

  Inlined<calib::Findings>& findings() { return *this; }
  const Inlined<calib::Findings>& findings() const { return *this; }
  Inlined<calib::SearchOutcome>& search() { return *this; }
  const Inlined<calib::SearchOutcome>& search() const { return *this; }
  const calib::ConditionResult* find(const std::string& condition) const;
};

/// Returns the drive frequency of a condition, if its drive is periodic.
std::optional<double> periodic_frequency(const calib::ConditionResult& condition);

/// Converts a fit or validation to its stored form.
StoredFit stored(const Result& result);

}  // namespace rigcal::report
