#include "datasets/read/mat/load_mat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <utility>

#include "common/error.hpp"
#include "common/file.hpp"
#include "datasets/read/confined_read.hpp"
#include "datasets/read/hdf5/load_hdf5.hpp"
#include "datasets/read/mat/mat_columns.hpp"
#include "datasets/read/mat/mat_hdf5.hpp"
#include "datasets/read/mat/mat_level5.hpp"

namespace rigcal::datasets {
namespace {

using Table = std::vector<std::vector<double>>;

constexpr std::size_t kSignatureBytes = 10;

/// Returns "MATLAB 5.0" or "MATLAB 7.3" for a MAT file, and other text for other files.
std::string signature_of(const std::filesystem::path& path) {
  std::string start(kSignatureBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

/// Whether a MAT file is of version 7.3 rather than 5.
///
/// @throws InputError  if it is of neither version
bool is_hdf5(const std::filesystem::path& path) {
  require_regular_file(path, "a MAT file");
  const std::string signature = signature_of(path);
  if (signature.size() < kSignatureBytes)
    throw InputError(
        {path.string()},
        "is shorter than the header of a MAT file: it is empty, truncated or not a MAT file");
  if (signature == "MATLAB 7.3") return true;
  if (signature == "MATLAB 5.0") return false;
  throw InputError({path.string()},
                   "is not a MAT file of version 5 or 7.3; expected one (load an older file in "
                   "MATLAB and save it with -v7)");
}

constexpr ConfinedReader kHdf5{"HDF5", "a MAT file", "copy or save it again, or save it with -v7"};

/// Reads columns, all of which must have the same length.
Table read_columns(MatSource& source, const std::vector<std::string>& columns) {
  Table table;
  for (const std::string& column : columns) {
    const std::size_t so_far = table.empty() ? 0 : table.size() * table.front().size();
    table.push_back(read_mat_column(source, column, so_far));
    if (table.back().size() != table.front().size())
      throw InputError(
          {source.name()},
          fmt::format("'{}' has {} elements, but '{}' has {}; expected the same number", column,
                      table.back().size(), columns.front(), table.front().size()));
  }
  return table;
}

/// Whether a file of version 7.3 is plain HDF5 after MATLAB's header, as Python packages write it:
/// matio recognises none of its arrays, and MATLAB's own object store is absent.
bool is_from_elsewhere(const MatSource& source, const std::filesystem::path& path) {
  const auto& arrays = source.variables();
  if (std::any_of(arrays.begin(), arrays.end(),
                  [](const MatArray& array) { return array.kind != MatKind::object; }))
    return false;
  const auto columns = list_hdf5_here(path);
  return !columns.empty() &&
         std::none_of(columns.begin(), columns.end(), [](const RecordColumn& column) {
           return column.name.starts_with("/#subsystem#");
         });
}

Table read_table(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  if (!is_hdf5(path)) {
    Level5Source source(path);
    return read_columns(source, columns);
  }
  const auto read = [&] {
    Hdf5Source source(path);
    if (is_from_elsewhere(source, path)) return read_hdf5_here(path, {columns, {}});
    return RecordTable{read_columns(source, columns), {}};
  };
  return load_confined(path, kHdf5, columns.size(), read).columns;
}

}  // namespace

bool is_mat_file(const FileStart& start) {
  const bool is_plain_hdf5 = start.bytes.starts_with("\x89HDF");
  return (start.extension == ".mat" && !is_plain_hdf5) || start.bytes.starts_with("MATLAB 5.0") ||
         start.bytes.starts_with("MATLAB 7.3");
}

RecordTable load_mat_record(const std::filesystem::path& path, const RecordRequest& request) {
  require_time_column(request);
  Table table = read_table(path, request.columns);
  const auto time = std::find(request.columns.begin(), request.columns.end(), request.time_column);
  if (time == request.columns.end()) return {std::move(table), {}};
  const auto& t = table[static_cast<std::size_t>(time - request.columns.begin())];
  for (std::size_t i = 1; i < t.size(); ++i)
    if (!(t[i] > t[i - 1]))
      throw InputError({path.string()},
                       fmt::format("time '{}' does not increase: element {} is {} after {}; "
                                   "expected a larger value in each",
                                   request.time_column, i + 1, t[i], t[i - 1]));
  return {std::move(table), {}};
}

std::vector<RecordColumn> mat_record_columns(const std::filesystem::path& path) {
  const auto described = [](const MatSource& source) {
    std::vector<RecordColumn> columns;
    for (std::string& name : list_mat_columns(source)) {
      const bool is_row = name.ends_with(",:)");
      columns.push_back({std::move(name), {}, false, is_row});
    }
    return columns;
  };
  if (!is_hdf5(path)) return described(Level5Source(path));
  return list_confined(path, kHdf5, [&] {
    const Hdf5Source source(path);
    return is_from_elsewhere(source, path) ? list_hdf5_here(path) : described(source);
  });
}

}  // namespace rigcal::datasets
