#include "report/store/provenance.hpp"

#include <fmt/format.h>
#include <sys/utsname.h>

#include <set>
#include <thread>

#include "common/file.hpp"

namespace rigcal::report {

std::string_view version() { return RIGCAL_VERSION; }
std::string_view revision() { return RIGCAL_REVISION; }

std::string machine() {
  utsname system{};
  if (uname(&system) != 0) return "unknown";
  return fmt::format("{} {} {}, {} processors", system.sysname, system.release, system.machine,
                     std::thread::hardware_concurrency());
}

std::vector<InputFile> hash_inputs(const datasets::Campaign& campaign,
                                   const std::vector<datasets::Record>& records,
                                   const std::vector<std::filesystem::path>& more) {
  std::vector<InputFile> inputs;
  std::set<std::string> known;
  const auto add = [&](const FileState& file) {
    if (known.insert(file.path).second) inputs.push_back({file.path, sha256_of_unchanged(file)});
  };
  add(campaign.file_state);
  for (const datasets::Record& record : records) {
    for (const FileState& file : record.files) add(file);
  }
  for (const std::filesystem::path& path : more) add(state_of_file(path));
  return inputs;
}

}  // namespace rigcal::report
