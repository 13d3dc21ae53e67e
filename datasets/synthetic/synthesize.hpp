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

/// Records of a known rig. Simulates every condition of the campaign at its true values
/// ([synthetic]), adds the noise that [synthetic] states, and writes `campaign.toml`,
/// `records/*.csv` and `truth.json` into `out`, each labelled as synthetic. The same seed gives the
/// same bytes on any machine and for any number of threads; every repeat and channel has its own
/// random stream.
///
/// @param write  receives the path of each file below `out` and its text, from several threads at a
///               time and the campaign file last
/// @throws InputError     no [synthetic] section, or a condition without duration and sample rate
/// @throws NoResultError  a condition could not be simulated
SynthesisReport synthesize(const Campaign& campaign, std::uint64_t seed,
                           const std::filesystem::path& out, int threads,
                           const WriteText& write = write_file_atomically);

/// Names of the files that synthesize() writes for a campaign, relative to its folder.
std::vector<std::filesystem::path> synthetic_file_names(const Campaign& campaign);

}  // namespace rigcal::datasets
