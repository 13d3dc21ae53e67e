#include "datasets/campaign/reading_root.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "common/error.hpp"

namespace rigcal::datasets {

namespace fs = std::filesystem;

bool lies_within(const fs::path& folder, const fs::path& path) {
  std::error_code error;
  const fs::path outer = fs::canonical(folder.empty() ? "." : folder, error);
  if (error) return false;
  const fs::path inner = fs::weakly_canonical(path.empty() ? "." : path, error);
  if (error) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

void require_within(const fs::path& root, const fs::path& path) {
  if (root.empty()) return;
  std::error_code error;
  if (!fs::is_directory(root, error))
    throw InputError({root.string()}, "is not a folder; expected a folder for --root");
  if (!lies_within(root, path))
    throw InputError({path.string()},
                     fmt::format("leads out of '{}', the folder of --root; expected a file in it",
                                 root.string()));
}

}  // namespace rigcal::datasets
