#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "report/comparison/comparison.hpp"
#include "report/json/described.hpp"

// batch.json, as docs/command-line.md describes it: one row for each rig of `batch`.

namespace rigcal::report {

inline constexpr const char* kBatchSchema = "rigcal.batch/1";

/// Agreement of one channel of one condition.
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

/// An estimate, SI.
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

/// Course of an estimate over the earlier results and this one.
struct StoredRigTrend {
  std::string key;
  std::string unit;
  StoredSeries series;
  RIGCAL_DESCRIBE(key, unit, series)
};

struct StoredRig {
  std::string rig;       ///< its folder, relative to that of the batch
  std::string campaign;  ///< the campaign file
  std::string folder;    ///< folder of its results, relative to that of the batch's
  std::optional<std::string> name;
  int exit_code = 0;
  bool unchanged = false;  ///< its result was there already
  double seconds = 0.0;
  std::optional<calib::FitStatus> status;
  std::optional<calib::Verdict> verdict;
  std::string message;  ///< message of the fit; or the error that left no result
  bool synthetic = false;
  bool has_report = false;
  std::vector<std::string> reasons;  ///< why it is no PASS, in words
  std::vector<StoredRigScore> worst_scores;
  std::vector<StoredRigEstimate> parameters;
  std::vector<std::string> warnings;
  std::vector<StoredRigTrend> trends;
  RIGCAL_DESCRIBE(rig, campaign, folder, name, exit_code, unchanged, seconds, status, verdict,
                  message, synthetic, has_report, reasons, worst_scores, parameters, warnings,
                  trends)
};

struct StoredBatch {
  std::string status = "done";  ///< or "stopped": rigs are left
  std::string schema = kBatchSchema;
  std::string folder;  ///< folder of these rigs
  int exit_code = 0;   ///< the highest of the rigs
  std::vector<StoredRig> rigs;
  StoredProvenance provenance;
  RIGCAL_DESCRIBE(status, schema, folder, exit_code, rigs, provenance)
};

/// End of the run of one rig.
struct RigRun {
  std::string rig;
  std::filesystem::path campaign;
  std::string folder;
  ExitCode code = ExitCode::internal;
  bool unchanged = false;
  double seconds = 0.0;
  std::string error;
  std::optional<Compared> result;   ///< its fit.json; empty where this run left none
  std::vector<Compared> earlier;    ///< earlier results of the same rig, in any order
  std::vector<std::string> unread;  ///< why earlier ones are left out
};

/// The row of one rig.
StoredRig rig_row(const RigRun& run);

/// batch.csv: a line for each rig; `parameter_ci95_low` and so on of every estimate that one has.
std::string batch_csv(const StoredBatch& batch);

inline std::string parameter_label(const StoredRigEstimate& each) {
  return parameter_label(each.key, each.scope, each.level);
}
/// The fit converged.
inline bool has_converged(const StoredRig& rig) {
  return rig.status == calib::FitStatus::converged;
}

/// "leakage_coefficient: +0.000966 per day (0.000694 to 0.00124): significant trend."
std::string trend_sentence(const StoredRigTrend& trend);
bool is_significant(const StoredRigTrend& trend);
/// Name of a series: "mass_kg of rig".
std::string trend_name(const StoredRigTrend& trend);

/// "3 of 4 rigs: PASS 1, WARN 1, FAIL 1; 1 without a result".
std::string batch_sentence(const StoredBatch& batch);

}  // namespace rigcal::report
