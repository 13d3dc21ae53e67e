#include "common/installed_file.hpp"

#include <system_error>

namespace rigcal {

std::optional<std::filesystem::path> installed_file(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return std::nullopt;
  std::filesystem::path file = program.parent_path().parent_path() / "share" / path;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  return file;
}

}  // namespace rigcal
