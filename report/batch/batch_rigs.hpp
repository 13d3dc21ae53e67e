#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace rigcal::report {

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

/// End of `fit` or `diagnose` for one rig.
struct VerbEnd {
  ExitCode code = ExitCode::internal;
  std::string error;  ///< on one line; empty if there was none
  double seconds = 0.0;
};
/// The verbs that `batch` runs, which write into the folder of the rig's results.
struct RigVerbs {
  std::function<VerbEnd(const BatchRig&)> fit;
  std::function<VerbEnd(const BatchRig&)> diagnose;  ///< may be empty: not asked for
};

/// Fits a rig, and diagnoses its records if requested.
///
/// @param out  folder of the batch
RigEnd run_rig(const BatchRig& rig, const std::filesystem::path& out, const RigVerbs& verbs,
               const std::atomic<bool>& cancel);

}  // namespace rigcal::report
