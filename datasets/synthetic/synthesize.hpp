#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string_view>
#include <vector>

#include "common/file.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::datasets {

using WriteText = std::function<void(const std::filesystem::path&, std::string_view)>;

/// Files that `synthesize` wrote.
struct SynthesisReport {
  std::filesystem::path campaign_file;
  int files = 0;
  long samples = 0;
};

/// Creates records of a known rig. Simulates every condition of the campaign with its true values
/// from [synthetic], adds the noise stated there, and writes `campaign.toml`, `records/*.csv` and
/// `truth.json` to `out`, each labelled as synthetic. The same seed gives the same bytes on any
/// machine and for any number of threads, because every repeat and channel has its own random
/// stream.
///
/// @param write  receives the path of each file below `out` and its text; called from several
///               threads at a time, with the campaign file last
/// @throws InputError     if there is no [synthetic] section, or if a condition has no duration and
///                        sample rate
/// @throws NoResultError  if a condition could not be simulated
SynthesisReport synthesize(const Campaign& campaign, std::uint64_t seed,
                           const std::filesystem::path& out, int threads,
                           const WriteText& write = write_file_atomically);

/// Returns the names of the files that synthesize() writes for a campaign, relative to its output
/// folder.
std::vector<std::filesystem::path> synthetic_file_names(const Campaign& campaign);

}  // namespace rigcal::datasets
