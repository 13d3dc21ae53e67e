#include "report/store/result_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/error.hpp"
#include "common/file.hpp"

namespace rigcal::report {

void name_files(std::vector<InputFile> named, std::vector<ResultFile>& files,
                StoredProvenance& provenance) {
  for (ResultFile& file : files) {
    file.sha256 = sha256_of_text(file.content);
    named.push_back({file.path.generic_string(), file.sha256});
  }
  provenance.files = std::move(named);
}

void name_files(std::vector<ResultFile>& files, StoredProvenance& provenance) {
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
