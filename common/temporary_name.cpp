#include "common/temporary_name.hpp"

#include <fmt/format.h>
#include <sys/types.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <climits>
#include <csignal>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

namespace rigcal {
namespace {

namespace fs = std::filesystem;

/// Target name and process ID in a name made by temporary_name().
struct Temporary {
  std::string_view name;
  pid_t process = 0;
};

/// Removes ".NUMBER" from the end and returns the number; nullopt if the text does not end like
/// this.
std::optional<unsigned long> take_number(std::string_view& text) {
  const std::size_t dot = text.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string_view digits = text.substr(dot + 1);
  unsigned long number = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || rest != digits.data() + digits.size()) return std::nullopt;
  text.remove_suffix(digits.size() + 1);
  return number;
}

std::optional<Temporary> temporary(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(".tmp")) return std::nullopt;
  name.remove_prefix(1);
  name.remove_suffix(4);
  if (!take_number(name)) return std::nullopt;
  const auto process = take_number(name);
  if (!process || *process == 0 || *process > static_cast<unsigned long>(INT_MAX))
    return std::nullopt;
  return Temporary{name, static_cast<pid_t>(*process)};
}

/// Whether another process with this ID is running.
bool lives(pid_t process) {
  return process != ::getpid() && (::kill(process, 0) == 0 || errno == EPERM);
}

}  // namespace

fs::path temporary_name(const fs::path& target) {
  static std::atomic<unsigned> running_number{0};
  return target.parent_path() /
         fmt::format(".{}.{}.{}.tmp", target.filename().string(), ::getpid(), running_number++);
}

void remove_left_behind(const fs::path& folder, const std::set<std::string>& names) {
  std::error_code unread;  // a folder that cannot be read is left alone
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, unread)) {
    const std::string name = entry.path().filename().string();
    const auto found = temporary(name);
    if (found && names.contains(std::string(found->name)) && !lives(found->process))
      left.push_back(entry.path());
  }
  for (const fs::path& path : left) ::unlink(path.c_str());  // a failure is harmless
}

}  // namespace rigcal
