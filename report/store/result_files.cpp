#include "report/store/result_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/error.hpp"
#include "common/file.hpp"

namespace rigcal::report {
namespace {

std::vector<InputFile> hashed(const std::vector<ResultFile>& files) {
  std::vector<InputFile> named;
  for (const ResultFile& file : files)
    named.push_back({file.path.generic_string(), sha256_of_text(file.content)});
  return named;
}

}  // namespace

void name_files(std::vector<InputFile> named, const std::vector<ResultFile>& files,
                StoredProvenance& provenance) {
  for (InputFile& file : hashed(files)) named.push_back(std::move(file));
  provenance.files = std::move(named);
}

void name_files(const std::vector<ResultFile>& files, StoredProvenance& provenance) {
  name_files({}, files, provenance);
}

ReadFile files_of_run(const ReadFile& read, const StoredProvenance& provenance,
                      const std::string& where, const std::string& file) {
  return [&read, named = provenance.files.value_or(std::vector<InputFile>()), where,
          file](const std::filesystem::path& path) {
    auto text = read(path);
    const auto found = std::find_if(named.begin(), named.end(), [&](const InputFile& each) {
      return each.path == path.generic_string();
    });
    if (text && found != named.end() && sha256_of_text(*text) != found->sha256)
      throw InputError(
          {(std::filesystem::path(where) / path).string()},
          fmt::format("is not the file that {} was written with: it is of another run, "
                      "or was changed; make the result again",
                      file));
    return text;
  };
}

}  // namespace rigcal::report
