#include "datasets/read/confined_read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/confined.hpp"
#include "common/error.hpp"

namespace rigcal::datasets {
namespace {

constexpr char kDone = 'd';
constexpr char kRefused = 'r';
constexpr char kNoMemory = 'm';

/// Returns the text that `read` produces in the separate process.
std::string read_confined(const std::filesystem::path& path, const ConfinedReader& reader,
                          const std::function<std::string()>& read) {
  const std::string name = path.string();
  const auto work = [&]() -> std::string {
    try {
      return kDone + read();
    } catch (const InputError& error) {
      return kRefused + std::string(error.what()).substr(name.size() + 2);
    } catch (const std::bad_alloc&) {
      return {kNoMemory};
    }
  };
  std::string text;
  std::error_code unknown;  // `read` reports a file that has disappeared
  const std::uintmax_t bytes = std::filesystem::file_size(path, unknown);
  const Confinement confinement = Confinement::of_file(unknown ? 0 : bytes);
  try {
    text = run_confined(work, confinement);
  } catch (const ConfinedFailure& failure) {
    throw InputError({name}, fmt::format("cannot be read by {} ({}): the file is damaged; {}",
                                         reader.library, failure.what(), reader.advice));
  }
  if (text.empty()) throw InputError({name}, fmt::format("cannot be read by {}", reader.library));
  if (text.front() == kNoMemory && confinement.memory_is_short())
    throw NoResources(
        fmt::format("{}: out of memory while reading it: memory is limited (ulimit -v)", name));
  if (text.front() == kNoMemory)
    throw InputError({name}, fmt::format("needs more memory than {} may use", reader.format));
  if (text.front() != kDone) throw InputError({name}, text.substr(1));
  return text.substr(1);
}

/// Removes the text before the next NUL from the front, and returns it.
std::string next_text(std::string_view& text) {
  const std::size_t end = std::min(text.find('\0'), text.size());
  std::string part(text.substr(0, end));
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

/// Packs the labels as NUL-terminated texts, followed by the numbers.
std::string packed(RecordTable table) {
  table.labels.resize(table.columns.size());
  std::string text;
  for (const ColumnLabel& label : table.labels)
    text += label.name + '\0' + label.unit + '\0' + label.place + '\0';
  const std::size_t rows = table.columns.empty() ? 0 : table.columns.front().size();
  text.reserve(text.size() + table.columns.size() * rows * sizeof(double));
  for (const std::vector<double>& column : table.columns)
    text.append(reinterpret_cast<const char*>(column.data()), column.size() * sizeof(double));
  return text;
}

RecordTable unpacked(std::string_view text, std::size_t columns) {
  RecordTable table;
  for (std::size_t i = 0; i < columns; ++i)
    table.labels.push_back({next_text(text), next_text(text), next_text(text), 0});
  const std::size_t rows = columns == 0 ? 0 : text.size() / sizeof(double) / columns;
  table.columns.assign(columns, std::vector<double>(rows));
  for (std::size_t i = 0; i < columns && rows > 0; ++i)
    std::memcpy(table.columns[i].data(), text.data() + i * rows * sizeof(double),
                rows * sizeof(double));
  return table;
}

/// Joins NUL-terminated texts for each column: name, unit, and the format's remarks about the
/// column.
std::string joined(const std::vector<RecordColumn>& columns) {
  std::string text;
  for (const RecordColumn& column : columns) {
    text += column.name + '\0' + column.unit + '\0';
    text += std::string(column.is_time ? "t" : "") + (column.is_matrix_line ? "r" : "") + '\0';
  }
  return text;
}

std::vector<RecordColumn> split(std::string_view text) {
  std::vector<RecordColumn> columns;
  while (!text.empty()) {
    RecordColumn column{next_text(text), next_text(text)};
    const std::string marks = next_text(text);
    column.is_time = marks.find('t') != std::string::npos;
    column.is_matrix_line = marks.find('r') != std::string::npos;
    columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace

RecordTable load_confined(const std::filesystem::path& path, const ConfinedReader& reader,
                          std::size_t columns, const std::function<RecordTable()>& read) {
  return unpacked(read_confined(path, reader, [&] { return packed(read()); }), columns);
}

std::vector<RecordColumn> list_confined(const std::filesystem::path& path,
                                        const ConfinedReader& reader,
                                        const std::function<std::vector<RecordColumn>()>& list) {
  return split(read_confined(path, reader, [&] { return joined(list()); }));
}

}  // namespace rigcal::datasets
