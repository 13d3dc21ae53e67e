#include "datasets/read/hdf5/load_hdf5.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "common/error.hpp"
#include "common/file.hpp"
#include "common/suggest.hpp"
#include "datasets/read/confined_read.hpp"
#include "datasets/read/hdf5/hdf5_file.hpp"
#include "datasets/read/limits.hpp"

namespace rigcal::datasets {
namespace {

using Table = std::vector<std::vector<double>>;

constexpr ConfinedReader kHdf5Library{"HDF5", "an HDF5 file", "copy or save it again"};
constexpr std::size_t kMostLines = 100;
constexpr std::string_view kSignature("\x89HDF\r\n\x1a\n", 8);

std::string size_text(const Hdf5Series& series) {
  std::string text;
  for (const std::size_t n : series.dims) text += fmt::format("{}{}", text.empty() ? "" : " x ", n);
  return text;
}

std::size_t long_dimensions(const Hdf5Series& series) {
  return static_cast<std::size_t>(
      std::count_if(series.dims.begin(), series.dims.end(), [](std::size_t n) { return n != 1; }));
}

/// Parses subscripts such as "(:,3)". Returns them counted from 0, with nullopt for a colon;
/// nullopt for any other text.
std::optional<std::vector<std::optional<std::size_t>>> parsed_subscripts(std::string_view text) {
  std::vector<std::optional<std::size_t>> subscripts;
  if (text.size() < 3 || text.front() != '(' || text.back() != ')') return std::nullopt;
  for (text.remove_prefix(1); !text.empty();) {
    const std::size_t end = text.find_first_of(",)");
    std::string_view part = text.substr(0, end);
    while (part.starts_with(' ')) part.remove_prefix(1);
    while (part.ends_with(' ')) part.remove_suffix(1);
    std::size_t value = 0;
    const auto [last, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    if (part == ":")
      subscripts.emplace_back(std::nullopt);
    else if (error == std::errc{} && last == part.data() + part.size() && value > 0)
      subscripts.emplace_back(value - 1);
    else
      return std::nullopt;
    text.remove_prefix(end + 1);
  }
  return subscripts;
}

/// Reads the columns named in a request.
class Hdf5Columns {
 public:
  explicit Hdf5Columns(const std::filesystem::path& path) : file_(path) {}

  RecordTable read(const RecordRequest& request) {
    Table table(request.columns.size());
    std::vector<ColumnLabel> labels(table.size());
    std::size_t rows = 0;
    std::string first;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const std::string& column = request.columns[i];
      if (find_clock(column) != nullptr) continue;
      table[i] = numbers(column, so_far_, labels[i]);
      so_far_ += table[i].size();
      if (first.empty()) {
        first = column;
        rows = table[i].size();
      }
      if (table[i].size() != rows)
        fail(fmt::format("'{}' has {} rows, but '{}' has {}; expected the same number", column,
                         table[i].size(), first, rows));
    }
    for (std::size_t i = 0; i < table.size(); ++i) {
      const Hdf5Clock* clock = find_clock(request.columns[i]);
      if (clock == nullptr) continue;
      labels[i] = {clock->path, "s", {}, 0};
      table[i] = samples_of(*clock, first.empty() ? std::nullopt : std::optional(rows), first);
      so_far_ += table[i].size();
      if (first.empty()) {
        first = request.columns[i];
        rows = table[i].size();
      }
    }
    if (!request.time_column.empty()) check_time(request, table);
    return {std::move(table), {}, std::move(labels)};
  }

  std::vector<RecordColumn> list() const {
    std::vector<RecordColumn> columns;
    for (const Hdf5Series& series : file_.series())
      if (series.kind.empty()) list_lines(series, columns);
    if (columns.empty()) return columns;
    for (const Hdf5Clock& clock : file_.clocks()) columns.push_back({clock.path, "s", true, false});
    return columns;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({file_.name()}, message);
  }

  static std::string with_slash(const std::string& column) {
    return column.starts_with('/') ? column : "/" + column;
  }

  const Hdf5Clock* find_clock(const std::string& column) const {
    const std::string wanted = with_slash(column);
    for (const Hdf5Clock& clock : file_.clocks())
      if (with_slash(clock.path) == wanted) return &clock;
    return nullptr;
  }

  /// Returns the series with the longest path at the start of the column name. Subscripts may
  /// follow the path.
  const Hdf5Series& series_of(const std::string& wanted, const std::string& column) const {
    const Hdf5Series* found = nullptr;
    for (const Hdf5Series& series : file_.series()) {
      if (!wanted.starts_with(series.path)) continue;
      const std::string_view rest = std::string_view(wanted).substr(series.path.size());
      if (!rest.empty() && rest.front() != '(') continue;
      if (found == nullptr || series.path.size() > found->path.size()) found = &series;
    }
    if (found != nullptr) return *found;
    std::vector<std::string> known;
    for (const RecordColumn& each : list()) known.push_back(each.name);
    if (known.empty()) fail(fmt::format("contains no numbers; {}", kHowToSaveHdf5));
    constexpr std::size_t kMostNamed = 40;
    if (known.size() > kMostNamed) known.resize(kMostNamed);
    fail(unknown_name_message("dataset", column, known));
  }

  std::vector<double> numbers(const std::string& column, std::size_t so_far,
                              ColumnLabel& label) const {
    const std::string wanted = with_slash(column);
    const Hdf5Series& series = series_of(wanted, column);
    if (series.kind == "a table")
      fail(fmt::format("'{}' is a table; expected one of its columns, such as '{}'", column,
                       first_member_of(series)));
    if (!series.kind.empty())
      fail(fmt::format("'{}' is {}; expected numbers", column, series.kind));
    if (series.element_count() == 0) fail(fmt::format("'{}' is empty; expected numbers", column));
    const Hdf5Line line = line_of(series, wanted.substr(series.path.size()), column);
    label = {wanted, unit_of(series, line), {}, 0};
    if (!label.unit.empty()) label.place = "attribute of its unit";
    const std::size_t count = series.dims.empty() ? 1 : series.dims[line.along];
    if (count > kMostValues - std::min(kMostValues, so_far))
      fail(
          fmt::format("'{}' has {} rows; with the {} numbers of other columns they exceed {}, the "
                      "limit of one file; decimate the record, or split it",
                      column, count, so_far, kMostValues));
    std::vector<double> values = file_.numbers(series, line, column);
    const auto bad =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad != values.end())
      fail(fmt::format("row {} of '{}' is {}; expected a finite number", bad - values.begin() + 1,
                       column, *bad));
    return values;
  }

  /// Returns the unit from the attributes: the one for the whole dataset, or the one for this line
  /// of a matrix.
  static std::string unit_of(const Hdf5Series& series, const Hdf5Line& line) {
    if (series.units.size() == 1) return series.units[0];
    if (series.dims.size() != 2) return {};
    const std::size_t across = 1 - line.along;
    const bool one_each = series.units.size() == series.dims[across];
    return one_each ? series.units[line.fixed[across]] : std::string();
  }

  std::string first_member_of(const Hdf5Series& table) const {
    for (const Hdf5Series& series : file_.series())
      if (series.dataset == table.dataset && !series.member.empty()) return series.path;
    return table.path + ".position";
  }

  Hdf5Line line_of(const Hdf5Series& series, const std::string& brackets,
                   const std::string& column) const {
    const std::size_t rank = series.dims.size();
    Hdf5Line line{0, std::vector<std::size_t>(rank, 0)};
    if (brackets.empty()) {
      if (long_dimensions(series) > 1)
        fail(
            fmt::format("'{0}' has {1} elements; expected a vector, or one line of it, such as "
                        "{0}({2})",
                        column, size_text(series), rank == 2 ? ":,1" : ":,1,1"));
      const auto along = std::find_if(series.dims.begin(), series.dims.end(),
                                      [](std::size_t n) { return n != 1; });
      if (along != series.dims.end())
        line.along = static_cast<std::size_t>(along - series.dims.begin());
      return line;
    }
    const auto subscripts = parsed_subscripts(brackets);
    if (!subscripts || std::count(subscripts->begin(), subscripts->end(), std::nullopt) != 1)
      fail(
          fmt::format("'{}' does not end in one row or column; expected brackets with one colon "
                      "and numbers from 1, such as {}(:,1)",
                      column, series.path));
    if (subscripts->size() != rank)
      fail(fmt::format("'{}' has {} elements; expected {} entries between the brackets", column,
                       size_text(series), rank));
    for (std::size_t k = 0; k < rank; ++k) {
      const auto& subscript = (*subscripts)[k];
      if (!subscript) line.along = k;
      if (subscript && *subscript >= series.dims[k])
        fail(fmt::format("'{}' is outside of '{}', which has {} elements", column, series.path,
                         size_text(series)));
      line.fixed[k] = subscript.value_or(0);
    }
    return line;
  }

  std::vector<double> samples_of(const Hdf5Clock& clock, std::optional<std::size_t> rows,
                                 const std::string& of) const {
    std::size_t count = rows.value_or(0);
    for (const Hdf5Series& series : file_.series())
      if (series.path == clock.series && !clock.series.empty()) count = series.element_count();
    if (!rows && clock.series.empty())
      fail(fmt::format(
          "'{}' is a sample interval, but no dataset is read with it; expected another column",
          clock.path));
    if (rows && count != *rows)
      fail(
          fmt::format("'{}' applies to the {} samples of its dataset, but '{}' has {}; expected "
                      "the same number",
                      clock.path, count, of, *rows));
    if (count > kMostValues - std::min(kMostValues, so_far_))
      fail(fmt::format("'{}' has {} samples, more than {} numbers in all, the limit of one file",
                       clock.path, count, kMostValues));
    std::vector<double> time_s(count);
    for (std::size_t k = 0; k < count; ++k) {
      const auto number = static_cast<double>(k);
      time_s[k] =
          clock.step_s > 0.0 ? clock.start_s + number * clock.step_s : number / clock.rate_hz;
    }
    return time_s;
  }

  void check_time(const RecordRequest& request, const Table& table) const {
    const auto time =
        std::find(request.columns.begin(), request.columns.end(), request.time_column);
    const auto& t = table[static_cast<std::size_t>(time - request.columns.begin())];
    for (std::size_t i = 1; i < t.size(); ++i)
      if (!(t[i] > t[i - 1]))
        fail(
            fmt::format("time '{}' does not increase: row {} is {} after {}; expected a larger "
                        "value in each",
                        request.time_column, i + 1, t[i], t[i - 1]));
  }

  static void list_lines(const Hdf5Series& series, std::vector<RecordColumn>& columns) {
    const auto unit = [&](std::size_t line, std::size_t lines) {
      if (series.units.size() == 1) return series.units[0];
      return series.units.size() == lines ? series.units[line] : std::string();
    };
    if (series.element_count() < 2) return;
    if (long_dimensions(series) == 1) columns.push_back({series.path, unit(0, 1), false, false});
    if (series.dims.size() != 2 || long_dimensions(series) != 2) return;
    const bool in_rows = series.dims[0] < series.dims[1];
    const std::size_t lines = series.dims[in_rows ? 0 : 1];
    for (std::size_t k = 0; k < std::min(lines, kMostLines); ++k)
      columns.push_back(
          {fmt::format(fmt::runtime(in_rows ? "{}({},:)" : "{}(:,{})"), series.path, k + 1),
           unit(k, lines), false, true});
  }

  Hdf5File file_;
  std::size_t so_far_ = 0;
};

}  // namespace

bool is_hdf5_file(const FileStart& start) {
  if (start.extension == ".h5" || start.extension == ".hdf5") return true;
  constexpr std::array<std::size_t, 4> kPlaces{0, 512, 1024, 2048};
  return std::any_of(kPlaces.begin(), kPlaces.end(), [&](std::size_t at) {
    return start.bytes.size() >= at &&
           std::string_view(start.bytes).substr(at).starts_with(kSignature);
  });
}

std::vector<RecordColumn> hdf5_record_columns(const std::filesystem::path& path) {
  require_regular_file(path, "an HDF5 file");
  return list_confined(path, kHdf5Library, [&] { return list_hdf5_here(path); });
}

std::vector<RecordColumn> list_hdf5_here(const std::filesystem::path& path) {
  return Hdf5Columns(path).list();
}

RecordTable read_hdf5_here(const std::filesystem::path& path, const RecordRequest& request) {
  return Hdf5Columns(path).read(request);
}

RecordTable load_hdf5_record(const std::filesystem::path& path, const RecordRequest& request) {
  require_time_column(request);
  require_regular_file(path, "an HDF5 file");
  return load_confined(path, kHdf5Library, request.columns.size(),
                       [&] { return read_hdf5_here(path, request); });
}

}  // namespace rigcal::datasets
