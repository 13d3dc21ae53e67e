#include "datasets/synthetic/synthesize.hpp"

#include <fmt/format.h>

#include <atomic>
#include <optional>

#include "common/parallel.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/time_holes.hpp"
#include "datasets/synthetic/synthetic_files.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"

namespace rigcal::datasets {
namespace {

/// Loads the record that provides the drive, if the waveform of the condition is recorded.
std::optional<Record> driving_record(const Campaign& campaign, const Condition& condition) {
  if (condition.waveform != Waveform::recorded) return std::nullopt;
  if (!condition.has_record())
    throw InputError(condition.where,
                     fmt::format("condition \"{}\" has a recorded waveform but no record; expected "
                                 "repeats, or another waveform",
                                 condition.id));
  Record record = load_record(campaign, condition);
  require_no_holes(campaign, record);
  return record;
}

}  // namespace

std::vector<std::filesystem::path> synthetic_file_names(const Campaign& campaign) {
  std::vector<std::filesystem::path> names{"campaign.toml", "truth.json"};
  if (!campaign.synthetic_settings) return names;
  for (const Condition& condition : campaign.conditions) {
    for (int repeat = 1; repeat <= campaign.synthetic_settings->repeats; ++repeat)
      names.emplace_back(synthetic_record_path(condition.id, repeat));
  }
  return names;
}

SynthesisReport synthesize(const Campaign& campaign, std::uint64_t seed,
                           const std::filesystem::path& out, int threads, const WriteText& write) {
  if (!campaign.synthetic_settings)
    throw InputError(
        {campaign.file.string()},
        "no table [synthetic]: expected one that states the disturbances of the records");
  if (campaign.time_column.empty())
    throw InputError({campaign.file.string()},
                     "recording.channels.time is missing: expected the column and unit of the time "
                     "that records are written with");
  const Campaign truth = true_campaign(campaign);
  std::vector<std::vector<RepeatFate>> fates(truth.conditions.size());
  std::atomic<long> samples{0};
  parallel_for(truth.conditions.size(), threads, [&](std::size_t c) {
    const Condition& condition = truth.conditions[c];
    const auto record = driving_record(campaign, condition);
    for (const SyntheticRepeat& repeat :
         synthetic_repeats(truth, condition, record ? &*record : nullptr, seed)) {
      write(out / repeat.record.source, synthetic_csv(campaign, repeat.record, seed));
      fates[c].push_back(repeat.fate);
      samples += static_cast<long>(repeat.record.time_s.size());
    }
  });
  // The campaign file comes last: without it, the output of an interrupted run is not a campaign.
  write(out / "truth.json", truth_json(truth, seed, fates));
  SynthesisReport report;
  report.campaign_file = out / "campaign.toml";
  write(report.campaign_file, synthetic_campaign_text(campaign, seed));
  for (const auto& repeats : fates) report.files += static_cast<int>(repeats.size());
  report.samples = samples;
  return report;
}

}  // namespace rigcal::datasets
