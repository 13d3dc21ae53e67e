#include "report/run/synthesis.hpp"

#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "common/file.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/synthetic/synthetic_files.hpp"

namespace rigcal::report {
namespace {

/// Lists the campaign file and the recordings whose drive is used. Their hashes are not needed.
std::vector<InputFile> inputs_of(const datasets::Campaign& campaign) {
  std::vector<InputFile> inputs{{campaign.file.string(), ""}};
  for (const datasets::Condition& condition : campaign.conditions) {
    if (condition.waveform != datasets::Waveform::recorded || !condition.has_record()) continue;
    for (const FileState& file : datasets::load_record(campaign, condition).files)
      inputs.push_back({file.path, ""});
  }
  return inputs;
}

}  // namespace

datasets::SynthesisReport write_synthesis(HeldFolder& held, const datasets::Campaign& campaign,
                                          std::uint64_t seed, int threads) {
  const PlannedFiles planned{datasets::synthetic_file_names(campaign), {"records"}};
  const std::vector<InputFile> inputs = inputs_of(campaign);
  require_inputs_kept(held.path(), planned.files, inputs);
  // Results of versions without a manifest do not show whether a campaign file was edited.
  if (campaign.synthetic_settings) {
    const std::string text = datasets::synthetic_campaign_text(campaign, seed);
    held.require_replaceable({{"campaign.toml", "", sha256_of_text(text)}});
  }
  held.plan(planned);
  ResultsInWriting writing(held, inputs);
  std::mutex one_at_a_time;
  const auto made =
      datasets::synthesize(campaign, seed, held.path(), threads,
                           [&](const std::filesystem::path& path, std::string_view text) {
                             const std::lock_guard lock(one_at_a_time);
                             writing.add({path.lexically_relative(held.path()), std::string(text)});
                           });
  writing.move_into_place();
  return made;
}

}  // namespace rigcal::report
