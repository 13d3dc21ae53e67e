#include "datasets/read/dat/load_dat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "common/error.hpp"
#include "common/file.hpp"
#include "common/suggest.hpp"
#include "datasets/read/csv/csv_text.hpp"

namespace rigcal::datasets {
namespace {

std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

/// The text, of which the header has been taken.
struct DatFile {
  explicit DatFile(const std::filesystem::path& path)
      : name(path.string()), text(read_file(path, std::size_t{64} << 20, "a .dat file")) {
    std::string line;
    std::getline(text, line);
    columns = words_of(line.starts_with('#') ? line.substr(1) : std::string());
    if (columns.empty())
      throw InputError({name, 1, 1},
                       "expected '#' and the names of the columns, such as # t_s x_mm");
  }

  std::string name;
  std::istringstream text;
  std::vector<std::string> columns;
};

}  // namespace

bool is_dat_file(const FileStart& start) { return start.extension == ".dat"; }

std::vector<RecordColumn> dat_columns(const std::filesystem::path& path) {
  std::vector<RecordColumn> columns;
  for (const std::string& name : DatFile(path).columns) columns.push_back({name, {}, false, false});
  return columns;
}

RecordTable load_dat(const std::filesystem::path& path, const RecordRequest& request) {
  require_time_column(request);
  DatFile file(path);
  std::vector<std::size_t> places;
  for (const std::string& column : request.columns) {
    const auto found = std::find(file.columns.begin(), file.columns.end(), column);
    if (found == file.columns.end())
      throw InputError({file.name, 1, 1}, unknown_name_message("column", column, file.columns));
    places.push_back(static_cast<std::size_t>(found - file.columns.begin()));
  }
  RecordTable table{std::vector<std::vector<double>>(places.size()), {}};
  long number = 1;
  for (std::string line; std::getline(file.text, line);) {
    const Location where{file.name, ++number, 1};
    const std::vector<std::string> words = words_of(line);
    if (words.size() != file.columns.size())
      throw InputError(where, fmt::format("{} numbers; expected {} as in the header", words.size(),
                                          file.columns.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto value = csv_number(words[places[i]], false);
      if (!value)
        throw InputError(where, fmt::format("'{}' in column '{}' is not a finite number",
                                            shown(words[places[i]]), request.columns[i]));
      std::vector<double>& column = table.columns[i];
      if (request.columns[i] == request.time_column && !column.empty() && !(*value > column.back()))
        throw InputError(where, fmt::format("time '{}' does not increase", request.time_column));
      column.push_back(*value);
    }
  }
  if (number == 1) throw InputError({file.name}, "no rows below the header; expected at least one");
  return table;
}

}  // namespace rigcal::datasets
