#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "report/store/stored/stored_fit.hpp"

// Format of comparison.json, which docs/command-line.md documents. Lists marked shape (results)
// have one entry per result. All results are compared with the first, so in lists of differences
// the first entry is null.

namespace rigcal::report {

inline constexpr const char* kComparisonSchema = "rigcal.comparison/1";

struct StoredComparedResult {
  std::string name, file, schema;
  calib::FitStatus status = calib::FitStatus::failed;
  std::optional<calib::Verdict> verdict;
  std::string message, campaign;
  std::optional<model::PlantKind> model;
  bool synthetic = false;
  std::optional<double> cost;
  long residual_count = 0;
  std::optional<double> reduced_chi_square, independent_residuals;
  long conditions = 0;
  std::optional<std::array<std::string, 2>> dates;  ///< first and last date
  std::optional<Range> temperature_k;
  std::string version, revision, command;
  RIGCAL_DESCRIBE(name, file, schema, status, verdict, message, campaign, model, synthetic, cost,
                  residual_count, reduced_chi_square, independent_residuals, conditions, dates,
                  temperature_k, version, revision, command)
};

struct StoredEstimate {
  std::optional<double> value;
  bool fitted = false;
  std::optional<double> standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< degrees of freedom of the standard error
  std::optional<Range> ci95;
  std::optional<calib::Identifiability> identifiability;
  bool at_bound = false;
  Omittable<double> between_days_error;  ///< standard error due to day-to-day differences
  RIGCAL_DESCRIBE(value, fitted, standard_error, degrees_of_freedom, ci95, identifiability,
                  at_bound, between_days_error)
};

/// An estimate minus the estimate in the first result.
struct StoredDifference {
  std::optional<double> difference;
  std::optional<double> percent;  ///< null if the first value may be zero
  std::optional<double> standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< for this error (Welch-Satterthwaite)
  std::optional<double> p_value;                    ///< for this parameter only
  std::optional<double> p_value_of_all;             ///< adjusted for all parameters (Holm)
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why the difference was not tested
  Omittable<bool> of_other_dates;     ///< the error includes day-to-day differences
  /// Component of the error caused by small effects that both models leave out.
  Omittable<double> by_effects;
  RIGCAL_DESCRIBE(difference, percent, standard_error, degrees_of_freedom, p_value, p_value_of_all,
                  significant, reason, of_other_dates, by_effects)
};

struct StoredComparedParameter {
  std::string name, key, symbol, unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;
  std::vector<std::optional<StoredEstimate>> estimates;      ///< shape (results)
  std::vector<std::optional<StoredDifference>> differences;  ///< shape (results)
  RIGCAL_DESCRIBE(name, key, symbol, unit, scope, level, estimates, differences)
};

/// How many parameters were compared with the first result, were tested, and have changed.
struct StoredSignificance {
  int compared = 0, tested = 0, significant = 0;
  std::string text;
  RIGCAL_DESCRIBE(compared, tested, significant, text)
};

struct StoredComparedScore {
  datasets::Use use = datasets::Use::fit;
  long samples = 0;
  std::optional<std::string> date;
  std::optional<double> temperature_k;
  std::optional<calib::Verdict> verdict;
  std::optional<std::string> failure;
  std::optional<double> rho2, ccc, absolute_error_percent;
  RIGCAL_DESCRIBE(use, samples, date, temperature_k, verdict, failure, rho2, ccc,
                  absolute_error_percent)
};

struct StoredComparedCondition {
  std::string id, channel;
  std::optional<datasets::Waveform> waveform;
  std::optional<double> frequency_hz;
  std::optional<std::string> leak_level;
  std::vector<std::optional<StoredComparedScore>> scores;  ///< shape (results)
  RIGCAL_DESCRIBE(id, channel, waveform, frequency_hz, leak_level, scores)
};

/// Mean scores over the conditions that both results have, and the number of conditions in which
/// the other result is better or worse.
struct StoredMetricAgainst {
  int conditions = 0;
  double mean_of_first = 0.0, mean = 0.0;
  int better = 0, worse = 0;
  std::optional<double> p_value;
  std::optional<bool> significant;
  std::optional<std::string> reason;
  RIGCAL_DESCRIBE(conditions, mean_of_first, mean, better, worse, p_value, significant, reason)
};

struct StoredComparedMetric {
  std::string channel, metric;
  std::vector<std::optional<StoredMetricAgainst>> against_first;  ///< shape (results)
  RIGCAL_DESCRIBE(channel, metric, against_first)
};

/// Result of the model comparison: which model the records prefer.
struct StoredModelChoice {
  std::optional<double> delta_aic, delta_bic;
  std::optional<std::string> smaller, larger;  ///< names of the results, if models are nested
  std::optional<double> likelihood_ratio;
  std::optional<int> freedom;
  std::optional<double> p_value;
  std::optional<std::string> verdict;  ///< in words
  std::optional<std::string> reason;   ///< why there is no number
  RIGCAL_DESCRIBE(delta_aic, delta_bic, smaller, larger, likelihood_ratio, freedom, p_value,
                  verdict, reason)
};

struct StoredComparedRecord {
  std::string file, sha256;
  std::vector<bool> in;  ///< shape (results)
  RIGCAL_DESCRIBE(file, sha256, in)
};

/// An estimate in a series, with its date and temperature.
struct StoredTrendPoint {
  std::string result;
  std::optional<std::string> level;
  std::optional<double> day, temperature_k;
  std::optional<double> value, standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< degrees of freedom of the standard error
  std::optional<Range> ci95;
  Omittable<double> between_days_error;  ///< included in the standard error
  RIGCAL_DESCRIBE(result, level, day, temperature_k, value, standard_error, degrees_of_freedom,
                  ci95, between_days_error)
};

/// A line through the points, weighted by their errors.
struct StoredTrend {
  long points = 0;  ///< points that have both an error and a position
  std::optional<double> slope, intercept, standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< degrees of freedom of the slope's error
  Later<std::optional<double>> widened;  ///< factor on the slope's error for scatter about the line
  std::optional<Range> ci95;
  std::optional<double> p_value, reduced_chi_square;
  std::optional<bool> significant;
  std::optional<std::string> reason;  ///< why there is no line

 protected:
  template <typename Self, typename Visit>
  static void describe_with(Self& self, const Visit& visit, const char* slope_name) {
    visit("points", self.points);
    visit(slope_name, self.slope);
    visit("intercept", self.intercept);
    visit("standard_error", self.standard_error);
    visit("degrees_of_freedom", self.degrees_of_freedom);
    visit("widened", self.widened);
    visit("ci95", self.ci95);
    visit("p_value", self.p_value);
    visit("reduced_chi_square", self.reduced_chi_square);
    visit("significant", self.significant);
    visit("reason", self.reason);
  }
};
struct StoredTrendPerDay : StoredTrend {
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    describe_with(self, visit, "slope_per_day");
  }
};
struct StoredTrendPerKelvin : StoredTrend {
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    describe_with(self, visit, "slope_per_k");
  }
};

/// Estimates of one quantity over dates and temperatures.
struct StoredSeries {
  std::string of;  ///< "rig" or a leak level
  std::vector<StoredTrendPoint> points;
  StoredTrendPerDay along_date;
  StoredTrendPerKelvin along_temperature;
  RIGCAL_DESCRIBE(of, points, along_date, along_temperature)
};

struct StoredComparison {
  std::string status = "done";  ///< "failed" if fewer than two results are usable
  std::string schema = kComparisonSchema;
  std::vector<StoredComparedResult> results;
  std::vector<StoredComparedParameter> parameters;
  std::vector<std::optional<StoredSignificance>> significance;  ///< shape (results)
  std::vector<StoredComparedCondition> conditions;
  std::vector<StoredComparedMetric> metrics;
  std::vector<std::optional<StoredModelChoice>> models;  ///< shape (results)
  std::vector<StoredComparedRecord> records;
  std::vector<StoredSeries> leak_trends;
  std::vector<std::string> warnings;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, results, parameters, significance, conditions, metrics, models,
                  records, leak_trends, warnings, provenance)
};

}  // namespace rigcal::report
