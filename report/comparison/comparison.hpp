#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "calib/score/comparison.hpp"
#include "report/store/stored.hpp"
#include "report/store/stored/stored_fit.hpp"

// comparison.json (docs/command-line.md). Lists of differences have one entry per result. The first
// entry is null, because the other results are compared with the first.

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
  std::optional<std::array<std::string, 2>> dates;  ///< first and last
  std::optional<Range> temperature_k;
  std::string version, revision, command;
  RIGCAL_DESCRIBE(name, file, schema, status, verdict, message, campaign, model, synthetic, cost,
                  residual_count, reduced_chi_square, independent_residuals, conditions, dates,
                  temperature_k, version, revision, command)
};

struct StoredComparedParameter {
  std::string name, key, symbol, unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;
  std::vector<std::optional<calib::ComparedEstimate>> estimates;      ///< shape (results)
  std::vector<std::optional<calib::EstimateDifference>> differences;  ///< shape (results)
  RIGCAL_DESCRIBE(name, key, symbol, unit, scope, level, estimates, differences)
};

/// Numbers of parameters that were compared with the first result, tested, and found significantly
/// different.
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

struct StoredComparedMetric {
  std::string channel, metric;
  std::vector<std::optional<calib::ScoreDifference>> against_first;  ///< shape (results)
  RIGCAL_DESCRIBE(channel, metric, against_first)
};

/// Evidence of which model the records prefer.
struct StoredModelChoice {
  std::optional<double> delta_aic, delta_bic;
  std::optional<std::string> smaller, larger;  ///< the results, if one model contains the other
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

/// One estimate in a series, with its date and temperature.
struct StoredTrendPoint {
  std::string result;
  std::optional<std::string> level;
  std::optional<double> day, temperature_k;
  std::optional<double> value, standard_error;
  Later<std::optional<double>> degrees_of_freedom;  ///< for the error
  std::optional<Range> ci95;
  Omittable<double> between_days_error;  ///< included in the standard error
  RIGCAL_DESCRIBE(result, level, day, temperature_k, value, standard_error, degrees_of_freedom,
                  ci95, between_days_error)
};

/// Describes a line through the points. The key of the slope includes its unit.
template <typename Self, typename Visit>
void describe_trend(Self& self, const Visit& visit, const char* slope_name) {
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
struct StoredTrendPerDay : calib::EstimateTrend {
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    describe_trend(self, visit, "slope_per_day");
  }
};
struct StoredTrendPerKelvin : calib::EstimateTrend {
  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    describe_trend(self, visit, "slope_per_k");
  }
};

/// Estimates of one parameter over dates and temperatures.
struct StoredSeries {
  std::string of;  ///< "rig" or a leak level
  std::vector<StoredTrendPoint> points;
  StoredTrendPerDay along_date;
  StoredTrendPerKelvin along_temperature;
  RIGCAL_DESCRIBE(of, points, along_date, along_temperature)
};

struct StoredComparison {
  std::string status = "done";  ///< or "failed": fewer than two usable results
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

/// A fit or validation to be compared with others.
struct Compared {
  std::string name;            ///< shortest path that is unique among the results
  std::filesystem::path file;  ///< fit.json, or validation.json if there is no fit
  StoredFit result;
  bool of_tables = false;                      ///< a fit to published tables, without records
  std::vector<std::string> published_numbers;  ///< the published tables used in the fit, by number
};

/// Prepares a parsed fit.json or validation.json for a comparison.
///
/// @throws InputError  if the file does not have the format of this version
Compared compared_of(const Json& json, const std::filesystem::path& file, const std::string& name);

/// Reads one fit.json or validation.json.
///
/// @param name         name of the result in the comparison
///
/// @throws InputError  if the file is missing, is not JSON or does not have the format of this
///                     version
Compared load_compared_file(const std::filesystem::path& file, const std::string& name);

/// Reads the fit in each folder, or the validation if there is no fit.
///
/// @throws InputError  if a folder contains neither, or a file is not JSON or does not have the
///                     format of this version
std::vector<Compared> load_compared(const std::vector<std::filesystem::path>& folders);

/// Compares estimates, scores and records. Each difference from the first result is given with its
/// significance. Leak estimates are also followed over dates and temperatures.
///
/// @param results      two or more; the others are compared with the first
///
/// @throws InputError  if a result contains impossible counts
StoredComparison compared(const std::vector<Compared>& results, const Provenance& provenance);

/// Reads the comparison.json in a folder.
///
/// @throws InputError  if the file is missing or not a comparison.json, or if a list does not have
///                     one entry per result
StoredComparison load_comparison(const ReadFile& read, const std::string& where);

}  // namespace rigcal::report
