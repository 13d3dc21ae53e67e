#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "report/json/described.hpp"

namespace rigcal::report {

/// "0.1.0"
std::string_view version();
/// Git revision of the sources, or "unknown" where they were no git checkout.
std::string_view revision();

/// Operating system, processor family and number of processors.
std::string machine();

/// A file that a result depends on.
struct InputFile {
  std::string path;  ///< path used to open it
  std::string sha256;
  RIGCAL_DESCRIBE(path, sha256)
};

/// Origin of a result: enough to make it again.
struct Provenance {
  std::string command;  ///< the command line
  std::uint64_t seed = 1;
  std::vector<std::pair<std::string, std::string>> options;  ///< those that change numbers
  std::vector<InputFile> inputs;
};

/// Hashes of the campaign file, of every record file once, in the order of reading, and of `more`.
///
/// @throws InputError  a file cannot be read
std::vector<InputFile> hash_inputs(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& records,
                                   const std::vector<std::filesystem::path>& more = {});

}  // namespace rigcal::report
