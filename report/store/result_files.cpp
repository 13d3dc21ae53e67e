#include "report/store/result_files.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/file.hpp"

namespace rigcal::report {
namespace {

/// The SHA-256 that a result names for a file; empty where it names none.
std::string named_hash(const Json& result, const std::string& path) {
  const auto provenance = result.find("provenance");
  if (provenance == result.end()) return {};
  const auto files = provenance->find("files");
  if (files == provenance->end()) return {};
  for (const Json& each : *files) {
    if (each.at("path").get<std::string>() == path) return each.at("sha256").get<std::string>();
  }
  return {};
}

}  // namespace

void name_files(const std::vector<ResultFile>& files, Json& result) {
  Json& named = result["provenance"]["files"] = Json::array();
  for (const ResultFile& file : files)
    named.push_back(
        {{"path", file.path.generic_string()}, {"sha256", sha256_of_text(file.content)}});
}

ReadFile files_of_run(const ReadFile& read, const Json& result, const std::string& where,
                      const std::string& file) {
  return [&read, &result, where, file](const std::filesystem::path& path) {
    auto text = read(path);
    const std::string hash = named_hash(result, path.generic_string());
    if (text && !hash.empty() && sha256_of_text(*text) != hash)
      throw InputError(
          {(std::filesystem::path(where) / path).string()},
          fmt::format("is not the file that {} was written with: it is of another run, "
                      "or was changed; make the result again",
                      file));
    return text;
  };
}

}  // namespace rigcal::report
