#include "datasets/draft/recordings_in.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "common/error.hpp"
#include "common/file.hpp"
#include "datasets/read/record_reader.hpp"

namespace rigcal::datasets {

std::vector<std::filesystem::path> recordings_in(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::filesystem::path> files;
  std::error_code error;  // a link may be broken
  for (const auto& path : paths) {
    if (!std::filesystem::is_directory(path, error)) {
      require_regular_file(path, fmt::format("a recording ({})", record_format_names()));
      files.push_back(path);
      continue;
    }
    const std::size_t before = files.size();
    const std::filesystem::directory_iterator entries(path, error);
    if (error)
      throw InputError(
          {path.string()},
          fmt::format("cannot be opened: {}; expected a folder of recordings", error.message()));
    std::vector<std::filesystem::path> unread;
    for (const auto& entry : entries) {
      if (!entry.is_regular_file(error)) continue;
      if (may_be_recording(entry.path())) files.push_back(entry.path());
      if (has_other_format_name(entry.path())) unread.push_back(entry.path());
    }
    // The readers for these formats explain what to do with such files.
    if (files.size() == before) files.insert(files.end(), unread.begin(), unread.end());
    if (files.size() == before) {
      throw UsageError(fmt::format("{}: this folder has no {} file; expected recordings",
                                   path.string(), record_extensions()));
    }
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
  }
  return files;
}

}  // namespace rigcal::datasets
