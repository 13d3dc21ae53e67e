#include "datasets/read/mat/mat_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "common/error.hpp"
#include "common/suggest.hpp"
#include "datasets/read/limits.hpp"

namespace rigcal::datasets {
namespace {

/// One step of a path into a MAT file: a variable or field, and the element selected in it.
struct MatStep {
  std::string name;
  /// Subscripts from 0, nullopt for a colon. Empty if there are no subscripts.
  std::vector<std::optional<std::size_t>> subscripts;

  bool operator==(const MatStep&) const = default;
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_name_character(char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; }

[[noreturn]] void fail(const std::string& text, const std::string& message) {
  throw std::invalid_argument(
      fmt::format("'{}' {}; expected a variable as MATLAB names it, such as x, log.time, "
                  "log.signals(2).values or data(:,3)",
                  text, message));
}

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text), rest_(text) {}

  std::vector<MatStep> parse() {
    std::vector<MatStep> steps{step()};
    while (take('.')) steps.push_back(step());
    skip_blanks();
    if (!rest_.empty()) fail(text_, fmt::format("continues with '{}'", rest_));
    for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
      const auto& subscripts = steps[i].subscripts;
      if (std::count(subscripts.begin(), subscripts.end(), std::nullopt) > 0)
        fail(text_, fmt::format("selects all elements of '{}', which is a struct", steps[i].name));
    }
    const auto& last = steps.back().subscripts;
    if (!last.empty() && std::count(last.begin(), last.end(), std::nullopt) != 1)
      fail(text_, "does not name a whole row or column: expected one colon in its last brackets");
    return steps;
  }

 private:
  void skip_blanks() {
    while (!rest_.empty() && rest_.front() == ' ') rest_.remove_prefix(1);
  }

  bool take(char c) {
    skip_blanks();
    if (rest_.empty() || rest_.front() != c) return false;
    rest_.remove_prefix(1);
    return true;
  }

  MatStep step() {
    skip_blanks();
    const auto end = std::find_if_not(rest_.begin(), rest_.end(), is_name_character);
    const auto length = static_cast<std::size_t>(end - rest_.begin());
    if (length == 0 || !is_letter(rest_.front())) fail(text_, "lacks the name of a variable");
    MatStep result{std::string(rest_.substr(0, length)), {}};
    rest_.remove_prefix(length);
    if (!take('(')) return result;
    do {
      result.subscripts.push_back(subscript());
    } while (take(','));
    if (!take(')')) fail(text_, "lacks a closing bracket");
    return result;
  }

  std::optional<std::size_t> subscript() {
    if (take(':')) return std::nullopt;
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc{} || value == 0)
      fail(text_, "has a subscript that is not a number from 1");
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return value - 1;
  }

  const std::string& text_;
  std::string_view rest_;
};

/// Parses the name of a column in MATLAB's notation: "x", "log.time", "log.signals(2).values(:,1)".
/// Subscripts count from 1. Only the last step may have a colon, and only one.
///
/// @throws std::invalid_argument  if the text is not such a name; what() describes the problem
std::vector<MatStep> parse_mat_path(const std::string& text) { return Parser(text).parse(); }

constexpr std::size_t kMostListedColumns = 100;
constexpr int kDeepestListing = 8;

std::string size_text(const MatArray& array) {
  std::string text;
  for (const std::size_t n : array.dims) text += fmt::format("{}{}", text.empty() ? "" : " x ", n);
  return text;
}

std::size_t long_dimensions(const MatArray& array) {
  return static_cast<std::size_t>(
      std::count_if(array.dims.begin(), array.dims.end(), [](std::size_t n) { return n != 1; }));
}

std::string kind_text(const MatArray& array) {
  switch (array.kind) {
    case MatKind::cell:
      return "a cell array";
    case MatKind::structure:
      return "a struct";
    case MatKind::text:
      return "text";
    case MatKind::sparse:
      return "a sparse matrix";
    case MatKind::function:
      return "a function";
    case MatKind::empty:
      return "empty";
    case MatKind::object:
      return fmt::format(
          "an object, such as a timeseries, a table or a string, which only MATLAB can read ({})",
          kHowToSaveMat);
    case MatKind::number:
      break;
  }
  return "a number";
}

class ColumnOfMat {
 public:
  ColumnOfMat(MatSource& source, const std::string& column) : source_(source), column_(column) {}

  std::vector<double> read(std::size_t values_so_far) {
    const std::vector<MatStep> steps = parsed_steps();
    const MatArray* array = &variable(steps.front().name);
    std::string path = steps.front().name;
    for (std::size_t i = 1; i < steps.size(); ++i) {
      array = &field(*array, steps[i - 1], steps[i].name, path);
      path += "." + steps[i].name;
    }
    return numbers(*array, steps.back(), values_so_far);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError({source_.name()}, message);
  }

  std::vector<MatStep> parsed_steps() const {
    try {
      return parse_mat_path(column_);
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
  }

  const MatArray& variable(const std::string& name) const {
    std::vector<std::string> known;
    bool holds_objects = false;
    for (const MatArray& each : source_.variables()) {
      if (each.name == name) return each;
      if (!each.name.empty()) known.push_back(each.name);
      holds_objects = holds_objects || each.kind == MatKind::object;
    }
    std::string message = unknown_name_message("variable", name, known);
    if (holds_objects)
      message += fmt::format(
          "; the file also contains objects, such as a timeseries, a table or a string, which only "
          "MATLAB can read: {}",
          kHowToSaveMat);
    fail(message);
  }

  /// Returns a field from an element of a struct array.
  const MatArray& field(const MatArray& parent, const MatStep& step, const std::string& name,
                        const std::string& path) const {
    if (parent.kind != MatKind::structure)
      fail(fmt::format("'{}' is {} and has no field '{}'; expected a struct", path,
                       kind_text(parent), name));
    const std::size_t element = element_index(parent, step, path);
    const auto found = std::find(parent.field_names.begin(), parent.field_names.end(), name);
    if (found == parent.field_names.end())
      fail(fmt::format("'{}': {}", path, unknown_name_message("field", name, parent.field_names)));
    const auto place = static_cast<std::size_t>(found - parent.field_names.begin());
    return parent.fields.at(element * parent.field_names.size() + place);
  }

  std::size_t element_index(const MatArray& parent, const MatStep& step,
                            const std::string& path) const {
    const std::size_t count = parent.element_count();
    if (step.subscripts.empty()) {
      if (count == 1) return 0;
      fail(fmt::format("'{0}' is a struct of {1}; expected one element, such as {0}(1)", path,
                       size_text(parent)));
    }
    std::size_t index = 0;
    std::size_t stride = 1;
    for (std::size_t k = 0; k < step.subscripts.size(); ++k) {
      const std::size_t subscript = step.subscripts[k].value();
      // A single subscript counts through all elements. Each of several subscripts counts along its
      // own dimension.
      const std::size_t size = step.subscripts.size() == 1 ? count
                               : k < parent.dims.size()    ? parent.dims[k]
                                                           : 1;
      if (subscript >= size)
        fail(fmt::format("'{}' is a struct of {}, which has no element {}", path, size_text(parent),
                         subscript + 1));
      index += subscript * stride;
      stride *= size;
    }
    if (index >= count)
      fail(fmt::format("'{}' is a struct of {}, which has no element {}", path, size_text(parent),
                       index + 1));
    return index;
  }

  MatSelection selection(const MatArray& array, const MatStep& step) const {
    const std::size_t rank = array.dims.size();
    if (step.subscripts.empty()) {
      if (long_dimensions(array) > 1)
        fail(
            fmt::format("'{0}' has {1} elements; expected a vector, or one line of it, such "
                        "as {0}({2})",
                        column_, size_text(array), rank == 2 ? ":,1" : "1,1,:"));
      return {0, 1, array.element_count()};
    }
    MatSelection chosen{0, 1, 1};
    std::size_t stride = 1;
    for (std::size_t k = 0; k < std::max(rank, step.subscripts.size()); ++k) {
      const std::size_t size = k < rank ? array.dims[k] : 1;
      const bool given = k < step.subscripts.size();
      if (given ? step.subscripts[k].value_or(0) >= std::max<std::size_t>(size, 1) : size != 1)
        fail(fmt::format("'{}' is outside of '{}', which has {} elements", column_, step.name,
                         size_text(array)));
      if (given && !step.subscripts[k]) {
        chosen.stride = stride;
        chosen.count = size;
      } else if (given) {
        chosen.start += *step.subscripts[k] * stride;
      }
      stride *= size;
    }
    return chosen;
  }

  std::vector<double> numbers(const MatArray& array, const MatStep& step,
                              std::size_t values_so_far) {
    if (array.kind != MatKind::number)
      fail(fmt::format("'{}' is {}; expected real numbers", column_, kind_text(array)));
    if (array.is_complex) fail(fmt::format("'{}' is complex; expected real numbers", column_));
    if (array.element_count() == 0) fail(fmt::format("'{}' is empty; expected numbers", column_));
    const MatSelection chosen = selection(array, step);
    if (chosen.count > kMostValues - std::min(kMostValues, values_so_far))
      fail(
          fmt::format("'{}' has {} elements; with the {} of other columns they exceed {}, the "
                      "limit of one file; decimate the record, or split it",
                      column_, chosen.count, values_so_far, kMostValues));
    std::vector<double> values = source_.numbers(array, chosen, column_);
    const auto bad =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad != values.end())
      fail(fmt::format("element {} of '{}' is {}; expected a finite number",
                       bad - values.begin() + 1, column_, *bad));
    return values;
  }

  MatSource& source_;
  const std::string& column_;
};

/// Appends the readable columns of an array.
void list_columns_of(const MatArray& array, const std::string& path, int depth,
                     std::vector<std::string>& columns) {
  if (depth > kDeepestListing) return;
  const std::size_t count = array.element_count();
  if (array.kind == MatKind::number && !array.is_complex && count > 1) {
    if (long_dimensions(array) == 1) columns.push_back(path);
    if (long_dimensions(array) != 2 || array.dims.size() != 2) return;
    const bool in_rows = array.dims[0] < array.dims[1];
    const std::size_t lines = array.dims[in_rows ? 0 : 1];
    for (std::size_t k = 1; k <= std::min(lines, kMostListedColumns); ++k)
      columns.push_back(in_rows ? fmt::format("{}({},:)", path, k)
                                : fmt::format("{}(:,{})", path, k));
  }
  if (array.kind != MatKind::structure) return;
  const std::size_t names = array.field_names.size();
  for (std::size_t element = 0; element < std::min(count, kMostListedColumns); ++element) {
    const std::string own = count == 1 ? path : fmt::format("{}({})", path, element + 1);
    for (std::size_t k = 0; k < names; ++k)
      list_columns_of(array.fields.at(element * names + k),
                      fmt::format("{}.{}", own, array.field_names[k]), depth + 1, columns);
  }
}

}  // namespace

std::vector<double> read_mat_column(MatSource& source, const std::string& column,
                                    std::size_t values_so_far) {
  return ColumnOfMat(source, column).read(values_so_far);
}

std::vector<std::string> list_mat_columns(const MatSource& source) {
  std::vector<std::string> columns;
  for (const MatArray& variable : source.variables())
    if (!variable.name.empty()) list_columns_of(variable, variable.name, 0, columns);
  return columns;
}

}  // namespace rigcal::datasets
