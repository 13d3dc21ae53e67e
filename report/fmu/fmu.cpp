#include "report/fmu/fmu.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/file.hpp"
#include "model/fmi/equations.hpp"
#include "report/fmu/built_in.hpp"
#include "report/fmu/documentation.hpp"
#include "report/fmu/model_description.hpp"

// The bytes of the library, embedded by fmu_library.S.
extern "C" const char rigcal_fmu_library_begin[];
extern "C" const char rigcal_fmu_library_end[];

namespace rigcal::report {
namespace {

// Folder in which an importer looks for the library. FMI 2.0 only names folders for Intel
// processors; for other processors the FMI 3.0 name is used.
#if defined(__x86_64__)
constexpr const char* kPlatform = "linux64";
#elif defined(__i386__)
constexpr const char* kPlatform = "linux32";
#elif defined(__aarch64__)
constexpr const char* kPlatform = "aarch64-linux";
#else
constexpr const char* kPlatform = "other-linux";
#endif

std::vector<std::string> files_to_compile() {
  std::vector<std::string> names;
  for (const auto& [name, content] : fmu_sources()) {
    if (name.ends_with(".cpp")) names.emplace_back(name);
  }
  return names;
}

/// Derives the GUID from the content, so that changing any byte changes the GUID.
std::string guid_of(const std::vector<FmuFile>& files) {
  std::string all;
  for (const FmuFile& file : files) all += file.path + ":" + sha256_of_text(file.content) + "\n";
  const std::string hash = sha256_of_text(all);
  return fmt::format("{{{}-{}-{}-{}-{}}}", hash.substr(0, 8), hash.substr(8, 4), hash.substr(12, 4),
                     hash.substr(16, 4), hash.substr(20, 12));
}

}  // namespace

std::string_view fmu_library() {
  return {rigcal_fmu_library_begin,
          static_cast<std::size_t>(rigcal_fmu_library_end - rigcal_fmu_library_begin)};
}

std::vector<FmuFile> fmu_files(FmuRequest request) {
  const auto equations = model::make_equations(request.rig);
  const auto variables = fmu_variables(request.rig, equations->layout());
  equations->set(request.rig.values, {}, 1.0);
  const std::vector<double> state(static_cast<std::size_t>(equations->layout().states), 0.0);
  const std::size_t indicators = equations->indicators(state).size();
  const std::vector<std::string> sources = files_to_compile();
  const std::string compile =
      fmt::format("cd sources && g++ -std=c++20 -O2 -fPIC -shared -I. -o {}.so \\\n  {}",
                  request.identifier, fmt::join(sources, " \\\n  "));
  std::vector<FmuFile> files{
      {"documentation/index.html", fmu_documentation(request, variables, compile)}};
  files.push_back({fmt::format("binaries/{}/", kPlatform) + request.identifier + ".so",
                   std::string(fmu_library())});
  for (const auto& [name, content] : fmu_sources())
    files.push_back({"sources/" + std::string(name), std::string(content)});
  const auto add_described = [&](std::vector<FmuFile>& to) {
    to.push_back(
        {"modelDescription.xml", model_description(request, variables, indicators, sources)});
    to.push_back({std::string("resources/") + model::kRigFile, exported_rig_text(request.rig)});
  };
  request.rig.guid.clear();
  std::vector<FmuFile> without_guid = files;
  add_described(without_guid);
  request.rig.guid = guid_of(without_guid);
  add_described(files);
  return files;
}

std::string fmu_identifier(const std::string& name) {
  std::string identifier;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain) {
      identifier += c;
    } else if (!identifier.empty() && identifier.back() != '_') {
      identifier += '_';
    }
  }
  if (!identifier.empty() && identifier.back() == '_') identifier.pop_back();
  const bool starts_well = !identifier.empty() && !(identifier[0] >= '0' && identifier[0] <= '9');
  return starts_well ? identifier : "rig" + identifier;
}

}  // namespace rigcal::report
