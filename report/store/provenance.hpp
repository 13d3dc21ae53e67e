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

/// Returns the version of rigcal, such as "0.1.0".
std::string_view version();
/// Returns the Git revision of the sources; "unknown" if they were not built in a git checkout.
std::string_view revision();

/// Returns the operating system, processor family and number of processors.
std::string machine();

/// A file that a result depends on.
struct InputFile {
  std::string path;  ///< path used to open it
  std::string sha256;
  RIGCAL_DESCRIBE(path, sha256)
};

/// Origin of a result, with all that is needed to reproduce it.
struct Provenance {
  std::string command;  ///< the command line
  std::uint64_t seed = 1;
  std::vector<std::pair<std::string, std::string>> options;  ///< options that change numbers
  std::vector<InputFile> inputs;
};

/// Hashes the campaign file, every record file (once, in the order of reading), and the files in
/// `more`.
///
/// @throws InputError  if a file cannot be read
std::vector<InputFile> hash_inputs(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& records,
                                   const std::vector<std::filesystem::path>& more = {});

}  // namespace rigcal::report
