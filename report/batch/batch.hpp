#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/batch/batch_rigs.hpp"
#include "report/comparison/comparison.hpp"
#include "report/json/described.hpp"

// Format of batch.json: one row for each rig of `batch`. docs/command-line.md documents it.

namespace rigcal::report {

inline constexpr const char* kBatchSchema = "rigcal.batch/1";

/// Agreement between measurement and simulation for one channel of one condition.
struct StoredRigScore {
  std::string condition;
  std::string channel;
  datasets::Use use = datasets::Use::fit;
  std::optional<calib::Verdict> verdict;
  std::optional<double> rho2;
  std::optional<double> absolute_error_percent;
  std::string failure;
  RIGCAL_DESCRIBE(condition, channel, use, verdict, rho2, absolute_error_percent, failure)
};

/// An estimated parameter in SI units.
struct StoredRigEstimate {
  std::string key;
  std::string name;
  std::string unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;
  double value = 0.0;
  std::optional<Range> ci95;
  std::optional<calib::Identifiability> identifiability;
  RIGCAL_DESCRIBE(key, name, unit, scope, level, value, ci95, identifiability)
};

/// Trend of one estimate over the earlier results and this one.
struct StoredRigTrend {
  std::string key;
  std::string unit;
  StoredSeries series;
  RIGCAL_DESCRIBE(key, unit, series)
};

struct StoredRig {
  std::string rig;       ///< folder of the rig, relative to the batch folder
  std::string campaign;  ///< path of the campaign file
  std::string folder;    ///< folder with its results, relative to the batch's results folder
  std::optional<std::string> name;
  int exit_code = 0;
  bool unchanged = false;  ///< the result existed before this run and was reused
  double seconds = 0.0;
  std::optional<calib::FitStatus> status;
  std::optional<calib::Verdict> verdict;
  std::string message;  ///< message from the fit, or the error that prevented a result
  bool synthetic = false;
  bool has_report = false;
  std::vector<std::string> reasons;  ///< why the verdict is not PASS, in words
  std::vector<StoredRigScore> worst_scores;
  std::vector<StoredRigEstimate> parameters;
  std::vector<std::string> warnings;
  std::vector<StoredRigTrend> trends;
  RIGCAL_DESCRIBE(rig, campaign, folder, name, exit_code, unchanged, seconds, status, verdict,
                  message, synthetic, has_report, reasons, worst_scores, parameters, warnings,
                  trends)
};

struct StoredBatch {
  std::string status = "done";  ///< "done", or "stopped" if some rigs have not been run
  std::string schema = kBatchSchema;
  std::string folder;  ///< folder that contains the rigs
  int exit_code = 0;   ///< the highest exit code of any rig
  std::vector<StoredRig> rigs;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, folder, exit_code, rigs, provenance)
};

/// How the run of one rig ended.
struct RigRun : BatchRig, RigEnd {
  std::optional<Compared> result{};   ///< contents of its fit.json; absent if this run left none
  std::vector<Compared> earlier{};    ///< earlier results for the same rig, in any order
  std::vector<std::string> unread{};  ///< why some earlier results were left out
};

StoredRig rig_row(const RigRun& run);

/// Writes batch.csv with one line for each rig. Every parameter that any rig estimates gets its own
/// columns, such as `mass_kg` and `mass_kg_ci95_low`.
std::string batch_csv(const StoredBatch& batch);

inline std::string parameter_label(const StoredRigEstimate& each) {
  return parameter_label(each.key, each.scope, each.level);
}
inline bool has_converged(const StoredRig& rig) {
  return rig.status == calib::FitStatus::converged;
}

/// Formats a trend: "leakage_coefficient: +0.000966 per day (0.000694 to 0.00124): significant
/// trend."
std::string trend_sentence(const StoredRigTrend& trend);
bool is_significant(const StoredRigTrend& trend);
/// Returns the display name of a series: "mass_kg of rig".
std::string trend_name(const StoredRigTrend& trend);

/// Summarises the outcomes: "3 of 4 rigs: PASS 1, WARN 1, FAIL 1; 1 without a result".
std::string batch_sentence(const StoredBatch& batch);

}  // namespace rigcal::report
