#include "common/temporary_name.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>

namespace rigcal {

std::filesystem::path temporary_name(const std::filesystem::path& target) {
  static std::atomic<unsigned> running_number{0};
  return target.parent_path() /
         fmt::format(".{}.{}.{}.tmp", target.filename().string(), ::getpid(), running_number++);
}

}  // namespace rigcal
