#pragma once

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/task_farm.hpp"

namespace rigcal::app {

/// A rig that `batch` found.
struct BatchRig {
  std::string rig;                 ///< its folder, relative to that of the batch: "lab/bench_2"
  std::filesystem::path campaign;  ///< its campaign.toml
  std::string folder;              ///< folder for its results, relative to --out
};

/// Every campaign.toml beneath `folder`, sorted by the name of its folder; links are not followed,
/// and `out` is skipped. One in `folder` itself has the name of that folder.
///
/// @throws UsageError  there is none, or two would have the same folder of results
std::vector<BatchRig> find_rigs(const std::filesystem::path& folder,
                                const std::filesystem::path& out);

/// Work on each rig.
struct RigTask {
  std::filesystem::path out;
  std::filesystem::path root;  ///< no file outside this folder is read; empty: no restriction
  std::vector<std::string> fit_arguments;
  int threads = 1;
  bool resume = false;
  bool diagnose = false;
  bool force = false;
};

/// Result of the work on a rig.
struct RigEnd {
  ExitCode code = ExitCode::internal;
  bool left_result = false;  ///< the fit.json in its folder is of this run
  bool unchanged = false;    ///< and was there before it
  double seconds = 0.0;
  std::string error;
};

/// To bytes for a TaskFarm, and back.
std::string bytes_of(const RigEnd& end);
RigEnd rig_end_of(const std::string& bytes);

/// Fits a rig, and diagnoses its records if requested, each in a separate process.
RigEnd run_rig(const BatchRig& rig, const RigTask& task, const std::atomic<bool>& cancel);

}  // namespace rigcal::app
