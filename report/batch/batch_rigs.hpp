#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace rigcal::report {

/// A rig found by `batch`.
struct BatchRig {
  std::string rig;                 ///< folder, relative to the batch folder: "lab/bench_2"
  std::filesystem::path campaign;  ///< path of its campaign.toml
  std::string folder;              ///< folder for its results, relative to --out
};

/// Finds every campaign.toml below `folder` and sorts them by folder name. Links are not followed,
/// and `out` is skipped. A campaign.toml directly in `folder` takes the name of that folder.
///
/// @throws UsageError  if no campaign is found, or two would share a results folder
std::vector<BatchRig> find_rigs(const std::filesystem::path& folder,
                                const std::filesystem::path& out);

/// Outcome of running one rig.
struct RigEnd {
  ExitCode code = ExitCode::internal;
  bool left_result = false;  ///< this run wrote fit.json, or found it up to date
  bool unchanged = false;    ///< the fit.json already existed before this run
  double seconds = 0.0;
  std::string error;
};

/// Converts a RigEnd to bytes for a TaskFarm, and back.
std::string bytes_of(const RigEnd& end);
RigEnd rig_end_of(const std::string& bytes);

/// Outcome of `fit` or `diagnose` for one rig.
struct VerbEnd {
  ExitCode code = ExitCode::internal;
  std::string error;  ///< error message on one line; empty if there was no error
  double seconds = 0.0;
};
/// The verbs that `batch` runs. Both write into the results folder of the rig.
struct RigVerbs {
  std::function<VerbEnd(const BatchRig&)> fit;
  std::function<VerbEnd(const BatchRig&)> diagnose;  ///< empty if no diagnosis was requested
};

/// Fits a rig, and diagnoses its records if requested.
///
/// @param out  results folder of the batch
RigEnd run_rig(const BatchRig& rig, const std::filesystem::path& out, const RigVerbs& verbs,
               const std::atomic<bool>& cancel);

}  // namespace rigcal::report
