#include "datasets/read/load_mat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string_view>

#include "common/confined.hpp"
#include "common/error.hpp"
#include "common/file.hpp"
#include "datasets/read/mat_columns.hpp"
#include "datasets/read/mat_hdf5.hpp"
#include "datasets/read/mat_level5.hpp"

namespace rigcal::datasets {
namespace {

using Table = std::vector<std::vector<double>>;

constexpr std::size_t kSignatureBytes = 10;

/// "MATLAB 5.0", "MATLAB 7.3", or something else.
std::string signature_of(const std::filesystem::path& path) {
  std::string start(kSignatureBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  return start;
}

/// Whether it is of version 7.3, not 5.
///
/// @throws InputError  neither
bool is_hdf5(const std::filesystem::path& path) {
  require_regular_file(path, "a MAT file");
  const std::string signature = signature_of(path);
  if (signature.size() < kSignatureBytes)
    throw InputError({path.string()},
                     "is shorter than the header of a MAT file: it is empty, truncated or no MAT "
                     "file");
  if (signature == "MATLAB 7.3") return true;
  if (signature == "MATLAB 5.0") return false;
  throw InputError({path.string()},
                   "is no MAT file of version 5 or 7.3; expected one (of an older version: load it "
                   "and save it with -v7)");
}

// ---- Out of the confined process -----------------------------------------------------------

constexpr char kDone = 'd';
constexpr char kRefused = 'r';

/// What `read` makes of the file, as text, in a process of its own.
template <typename Read>
std::string read_confined(const std::filesystem::path& path, Read read) {
  const std::string name = path.string();
  const auto work = [&]() -> std::string {
    try {
      Hdf5Source source(path);
      return kDone + read(source);
    } catch (const InputError& error) {
      return kRefused + std::string(error.what()).substr(name.size() + 2);
    } catch (const std::bad_alloc&) {
      return kRefused + std::string("needs more memory than a MAT file may");
    }
  };
  std::string text;
  try {
    text = run_confined(work, {});
  } catch (const ConfinedFailure& failure) {
    throw InputError({name}, fmt::format("cannot be read by HDF5 ({}): the file is damaged; copy "
                                         "or save it again, or save it with -v7",
                                         failure.what()));
  }
  if (text.empty() || text.front() != kDone)
    throw InputError({name}, text.empty() ? "cannot be read by HDF5" : text.substr(1));
  return text.substr(1);
}

std::string packed(const Table& table) {
  std::string text;
  for (const std::vector<double>& column : table)
    text.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(double));
  return text;
}

Table unpacked(const std::string& text, std::size_t columns) {
  const std::size_t rows = columns == 0 ? 0 : text.size() / sizeof(double) / columns;
  Table table(columns, std::vector<double>(rows));
  for (std::size_t i = 0; i < columns && rows > 0; ++i)
    std::memcpy(table[i].data(), text.data() + i * rows * sizeof(double), rows * sizeof(double));
  return table;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += name + '\0';
  return text;
}

std::vector<std::string> split_at_nul(std::string_view text) {
  std::vector<std::string> names;
  for (std::size_t end = text.find('\0'); end != std::string_view::npos; end = text.find('\0')) {
    names.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  return names;
}

// --------------------------------------------------------------------------------------------

/// Columns of the same length.
Table read_columns(MatSource& source, const std::vector<std::string>& columns) {
  Table table;
  for (const std::string& column : columns) {
    const std::size_t so_far = table.empty() ? 0 : table.size() * table.front().size();
    table.push_back(read_mat_column(source, column, so_far));
    if (table.back().size() != table.front().size())
      throw InputError(
          {source.name()},
          fmt::format("'{}' has {} elements, but '{}' has {}; expected as many", column,
                      table.back().size(), columns.front(), table.front().size()));
  }
  return table;
}

Table read_table(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  if (!is_hdf5(path)) {
    Level5Source source(path);
    return read_columns(source, columns);
  }
  const auto read = [&](MatSource& source) { return packed(read_columns(source, columns)); };
  return unpacked(read_confined(path, read), columns.size());
}

}  // namespace

bool is_mat_file(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".mat") return true;
  const std::string signature = signature_of(path);
  return signature == "MATLAB 5.0" || signature == "MATLAB 7.3";
}

Table load_mat(const std::filesystem::path& path, const MatRequest& request) {
  const auto time = std::find(request.columns.begin(), request.columns.end(), request.time_column);
  if (!request.time_column.empty() && time == request.columns.end())
    throw std::invalid_argument("load_mat: time_column '" + request.time_column +
                                "' is not among the columns");
  Table table = read_table(path, request.columns);
  if (request.time_column.empty()) return table;
  const auto& t = table[static_cast<std::size_t>(time - request.columns.begin())];
  for (std::size_t i = 1; i < t.size(); ++i)
    if (!(t[i] > t[i - 1]))
      throw InputError({path.string()},
                       fmt::format("time '{}' does not increase: element {} is {} after {}; "
                                   "expected a larger value in each",
                                   request.time_column, i + 1, t[i], t[i - 1]));
  return table;
}

std::vector<std::string> mat_columns(const std::filesystem::path& path) {
  if (!is_hdf5(path)) return list_mat_columns(Level5Source(path));
  const auto read = [](const MatSource& source) { return joined(list_mat_columns(source)); };
  return split_at_nul(read_confined(path, read));
}

}  // namespace rigcal::datasets
