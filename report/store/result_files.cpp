#include "report/store/result_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "common/error.hpp"
#include "report/json/read_json.hpp"

namespace rigcal::report {
namespace {

/// Maximum size of a table, enough for about two million rows of 20 columns.
constexpr std::size_t kMostTableBytes = std::size_t{512} << 20;

}  // namespace

ReadFile files_in(const std::filesystem::path& folder) {
  return [folder](const std::filesystem::path& path) -> std::shared_ptr<const ResultFile> {
    std::error_code error;
    if (!std::filesystem::exists(folder / path, error)) return nullptr;
    const std::size_t most = path.extension() == ".json" ? JsonLimits().bytes : kMostTableBytes;
    return std::make_shared<const ResultFile>(
        ResultFile{path, read_file(folder / path, most, "a result of rigcal")});
  };
}

ReadFile files_in(const std::vector<ResultFile>& files) {
  return [&files](const std::filesystem::path& path) -> std::shared_ptr<const ResultFile> {
    for (const ResultFile& file : files)
      if (file.path == path) return {std::shared_ptr<const void>(), &file};
    return nullptr;
  };
}

ReadFile either(ReadFile first, ReadFile second) {
  return [first = std::move(first), second = std::move(second)](const auto& path) {
    auto file = first(path);
    return file ? file : second(path);
  };
}

ResultFile table_file(std::filesystem::path path, Table table) {
  ResultFile file{std::move(path), csv_of(table)};
  file.object = std::make_shared<const Table>(std::move(table));
  return file;
}

void name_files(std::vector<ResultFile>& files, StoredProvenance& provenance,
                std::vector<InputFile> named) {
  for (ResultFile& file : files) {
    file.sha256 = sha256_of(file);
    named.push_back({file.path.generic_string(), file.sha256});
  }
  provenance.files = std::move(named);
}

ReadFile files_of_run(const ReadFile& read, const StoredProvenance& provenance,
                      const std::string& where, const std::string& file) {
  return [read, named = provenance.files.value_or(std::vector<InputFile>()), where,
          file](const std::filesystem::path& path) {
    auto found = read(path);
    if (!found || (found->object.has_value() && found->sha256.empty())) return found;
    const auto listed = std::find_if(named.begin(), named.end(), [&](const InputFile& each) {
      return each.path == path.generic_string();
    });
    if (listed != named.end() && sha256_of(*found) != listed->sha256)
      throw InputError({(std::filesystem::path(where) / path).string()},
                       fmt::format("is not the file that {} was written with: it belongs to "
                                   "another run, or was changed; make the result again",
                                   file));
    return found;
  };
}

std::shared_ptr<const Table> table_in(const ReadFile& read, const std::string& where,
                                      const std::string& name) {
  const auto file = read(name);
  if (!file) return nullptr;
  if (auto table = made<Table>(file)) return table;
  return std::make_shared<const Table>(
      parse_table(file->content, (std::filesystem::path(where) / name).string()));
}

}  // namespace rigcal::report
