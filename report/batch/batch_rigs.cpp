#include "report/batch/batch_rigs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "common/file.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCampaignFile = "campaign.toml";

/// Returns the current hash of a file, or std::nullopt if the file cannot be read.
std::optional<std::string> hash_of(const fs::path& file) {
  try {
    return sha256_of_file(file);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<BatchRig> find_rigs(const fs::path& folder, const fs::path& out) {
  std::vector<BatchRig> rigs;
  std::error_code none;  // errors are ignored: --out may not exist yet, and a link may be broken
  auto entry =
      fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied);
  for (; entry != fs::recursive_directory_iterator(); ++entry) {
    if (entry->is_directory(none) && fs::equivalent(entry->path(), out, none)) {
      entry.disable_recursion_pending();
      continue;
    }
    if (entry->path().filename() != kCampaignFile || !entry->is_regular_file(none)) continue;
    const fs::path parent = entry->path().parent_path();
    std::string name = parent.lexically_relative(folder).generic_string();
    if (name.empty() || name == ".") name = fs::canonical(folder).filename().generic_string();
    rigs.push_back({name, entry->path(), name});
  }
  std::sort(rigs.begin(), rigs.end(),
            [](const BatchRig& a, const BatchRig& b) { return a.rig < b.rig; });
  if (rigs.empty())
    throw UsageError(fmt::format("batch: found no {} beneath {}; expected one for each rig",
                                 kCampaignFile, folder.string()));
  const auto twice =
      std::adjacent_find(rigs.begin(), rigs.end(),
                         [](const BatchRig& a, const BatchRig& b) { return a.folder == b.folder; });
  if (twice != rigs.end())
    throw UsageError(fmt::format(
        "batch: the results of {} and {} would go to the same folder {}; expected the rigs in "
        "folders of their own",
        twice->campaign.string(), std::next(twice)->campaign.string(), twice->folder));
  return rigs;
}

std::string bytes_of(const RigEnd& end) {
  const nlohmann::json json{{"code", static_cast<int>(end.code)},
                            {"left_result", end.left_result},
                            {"unchanged", end.unchanged},
                            {"seconds", end.seconds},
                            {"error", end.error}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

RigEnd rig_end_of(const std::string& bytes) {
  const auto json = nlohmann::json::parse(bytes);
  RigEnd end;
  end.code = static_cast<ExitCode>(json.at("code").get<int>());
  end.left_result = json.at("left_result").get<bool>();
  end.unchanged = json.at("unchanged").get<bool>();
  end.seconds = json.at("seconds").get<double>();
  end.error = json.at("error").get<std::string>();
  return end;
}

RigEnd run_rig(const BatchRig& rig, const fs::path& out, const RigVerbs& verbs,
               const std::atomic<bool>& cancel) {
  RigEnd end;
  if (cancel) {
    end.code = ExitCode::stopped;
    end.error = "not started: stopped by a signal";
    return end;
  }
  const fs::path result = out / rig.folder / "fit.json";
  const auto before = hash_of(result);
  const VerbEnd fit = verbs.fit(rig);
  const auto after = hash_of(result);
  const bool same = before == after;
  const bool whole = fit.code == ExitCode::done || fit.code == ExitCode::verdict_fail ||
                     fit.code == ExitCode::no_result;
  // A run that was stopped before it wrote a result must not claim the file of an earlier run.
  end.left_result = after && (whole || (fit.code == ExitCode::stopped && !same));
  end.unchanged = whole && same;
  end.code = fit.code;
  end.error = fit.error;
  end.seconds = fit.seconds;
  const bool usable = fit.code == ExitCode::done || fit.code == ExitCode::verdict_fail;
  if (!verbs.diagnose || !usable || cancel) return end;
  const VerbEnd diagnosis = verbs.diagnose(rig);
  end.seconds += diagnosis.seconds;
  end.code = std::max(end.code, diagnosis.code);
  if (!diagnosis.error.empty()) end.error = "diagnose: " + diagnosis.error;
  return end;
}

}  // namespace rigcal::report
