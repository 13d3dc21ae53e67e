#include "report/store/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>

#include "common/error.hpp"
#include "common/file.hpp"
#include "report/json/json_node.hpp"
#include "report/json/read_json.hpp"
#include "report/store/json.hpp"
#include "report/store/provenance.hpp"
#include "report/store/stored/stored_provenance.hpp"
#include "report/store/stored/stored_residual_tests.hpp"

namespace rigcal::report {
namespace {

namespace fs = std::filesystem;

/// Maximum number of files that are examined in a folder without a manifest.
constexpr std::size_t kMostFiles = 10'000;
/// Number of bytes at the beginning of a file that are searched.
constexpr std::size_t kHeadBytes = std::size_t{1} << 16;

constexpr std::array kResults{"fit",        "validation", "leak_table", "diagnosis", "parity",
                              "comparison", "batch",      "average",    "plan"};

/// Recognises a kind of result file by its content. `name` may be only an extension.
struct Look {
  std::string_view folder;
  std::string_view name;
  std::string_view has;   ///< must occur in the head
  std::string_view also;  ///< must occur in the head; for pages and archives anywhere
};

constexpr std::array kLooks{
    Look{"", "scorecard.csv", "condition,", ",rho2,"},
    Look{"", "parameters.csv", "name,key,symbol,unit,scope,level", ""},
    Look{"", "posterior.csv", "chain,draw,", ""},
    Look{"", "residual_tests.json", R"("rigcal.residual_tests/1")", ""},
    Look{"", "truth.json", R"("rigcal.truth/1")", ""},
    Look{"", "repeatability.csv", "condition,channel,unit,repeats,pooled_sd", ""},
    Look{"", "leak_table.csv", "waveform,frequency_hz,", ""},
    Look{"", "features.csv", "level,coefficient,servo_flow_l_per_min", ""},
    Look{"", "diagnosis.csv", "condition,repeat,signal,leakage_coefficient", ""},
    Look{"", "parity.csv", "condition,repeat,signal,leak_level,healthy", ""},
    Look{"", "batch.csv", "rig,name,exit_code,status", ""},
    Look{"", "fitted.toml", "# Written by rigcal ", ""},
    Look{"", "report.html", "<!doctype html>\n<html lang=\"en\">", "<p class=\"kind\">Report "},
    Look{"", "report.html", "<!doctype html>\n<html lang=\"en\">", "Program</th><td>rigcal "},
    Look{"", ".fmu", "PK", "modelDescription.xml"},
    Look{"", ".csv", "time_s,", ",work_flow_m3_per_s"},
    Look{"residuals", ".csv", "time_s,measured_", ""},
    Look{"averaged", ".csv", "time_s,", "_mean,"},
    Look{"levels", ".csv", "time_s,drive,", ""},
    Look{"parity", ".csv", "time_s,healthy_model_m", ""},
    Look{"overlay", ".csv", "time_s,measured_", ""},
    Look{"records", ".csv", "# synthetic: made by rigcal synthesize, seed ", ""},
    Look{"figures", ".svg", "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=", ""},
    Look{"figures", ".pdf", "%PDF-", "Haru"},
};

/// Whether a path is a regular file and not a link.
bool is_plain_file(const fs::path& path) {
  std::error_code unknown;
  return fs::is_regular_file(fs::symlink_status(path, unknown));
}

/// Lists the plain files in a folder, sorted by name. A folder that is a link counts as empty
/// unless `link_taken` is set.
std::vector<std::string> plain_files(const fs::path& folder, bool link_taken) {
  std::error_code error;
  std::vector<std::string> names;
  if (!link_taken && fs::is_symlink(folder, error)) return names;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_plain_file(entry.path())) names.push_back(entry.path().filename().string());
    if (names.size() == kMostFiles) break;
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string head_of(const fs::path& file, std::size_t bytes) {
  std::ifstream stream(file, std::ios::binary);
  std::string head(bytes, '\0');
  stream.read(head.data(), static_cast<std::streamsize>(bytes));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

bool looks_like(const Look& look, const fs::path& file) {
  const std::string head = head_of(file, kHeadBytes);
  // A page begins with its styles, so its text may come after the head.
  const bool far = look.name == "report.html" || look.name == ".fmu" || look.name == ".pdf";
  const std::string whole =
      far && !look.also.empty() ? read_file(file, JsonLimits().bytes, "a result") : head;
  return head.find(look.has) != std::string::npos && whole.find(look.also) != std::string::npos;
}

bool has_a_result_look(const fs::path& folder, const fs::path& path) {
  return std::any_of(kLooks.begin(), kLooks.end(), [&](const Look& look) {
    const bool by_extension = look.name.starts_with('.');
    const bool named = by_extension ? path.extension() == look.name : path.filename() == look.name;
    return named && path.parent_path() == look.folder && looks_like(look, folder / path);
  });
}

/// Reads the provenance of a JSON result; std::nullopt if the file is missing or not such a result.
std::optional<StoredProvenance> provenance_in(const fs::path& folder, const std::string& kind) {
  const fs::path file = folder / (kind + ".json");
  if (!is_plain_file(file)) return std::nullopt;
  try {
    const Json json = read_json(file, "a result of rigcal");
    if (!json.is_object()) return std::nullopt;
    const Json schema = json.value("schema", Json());
    if (schema != "rigcal." + kind + "/1" && !(kind == "fit" && schema == kFitSchema))
      return std::nullopt;
    StoredProvenance provenance;
    read_into(JsonNode(json, file.string(), "", kind + ".json")["provenance"], provenance);
    return provenance;
  } catch (const InputError&) {
    return std::nullopt;  // a file of another program
  }
}

bool stays_inside(const fs::path& path) {
  return !path.empty() && path.is_relative() && path == path.lexically_normal() &&
         path.has_filename() && *path.begin() != "..";
}

}  // namespace

std::string manifest_text(const std::vector<ManifestFile>& files) {
  StoredManifest manifest;
  manifest.version = version();
  manifest.files = files;
  // Threads add files in any order.
  std::stable_sort(manifest.files.begin(), manifest.files.end(),
                   [](const auto& a, const auto& b) { return a.path < b.path; });
  return json_text(json_of(manifest));
}

std::vector<ManifestFile> manifest_files(const fs::path& folder) {
  const fs::path file = folder / kManifestFile;
  std::error_code unknown;
  if (!fs::exists(fs::symlink_status(file, unknown))) return rigcal_files(folder);
  if (!is_plain_file(file))
    throw InputError({file.string()}, "is not a regular file; expected a manifest of rigcal");
  const Json json = read_json(file, "a manifest of rigcal");
  const JsonNode root(json, file.string(), "", kManifestFile);
  if (root["schema"].string() != kManifestSchema)
    root["schema"].fail(fmt::format("\"{}\"", kManifestSchema));
  StoredManifest manifest;
  read_into(root, manifest);
  for (const ManifestFile& each : manifest.files) {
    if (!stays_inside(each.path))
      throw InputError({file.string()},
                       fmt::format("found the path \"{}\", expected one inside the folder",
                                   each.path.substr(0, 80)));
  }
  return std::move(manifest.files);
}

std::vector<ManifestFile> rigcal_files(const fs::path& folder) {
  std::map<std::string, std::set<std::string>> named;  // hashes by path; results may share files
  std::vector<ManifestFile> files;
  for (const char* kind : kResults) {
    const auto provenance = provenance_in(folder, kind);
    if (!provenance) continue;
    const std::string file = std::string(kind) + ".json";
    files.push_back({file, sha256_of_file(folder / file), ""});
    if (!provenance->files) continue;
    for (const InputFile& each : *provenance->files) named[each.path].insert(each.sha256);
  }
  std::set<std::string_view> folders;
  for (const Look& look : kLooks) folders.insert(look.folder);
  for (const std::string_view inner : folders) {
    for (const std::string& name : plain_files(folder / inner, inner.empty())) {
      const std::string path = (fs::path(inner) / name).generic_string();
      const auto hashes = named.find(path);
      try {
        if (hashes == named.end() && !has_a_result_look(folder, path)) continue;
        const std::string hash = sha256_of_file(folder / path);
        if (hashes == named.end() || hashes->second.contains(hash))
          files.push_back({path, hash, ""});
      } catch (const InputError&) {
        // A file that cannot be read is not listed, so an attempt to replace it is refused.
      }
    }
  }
  return files;
}

}  // namespace rigcal::report
