#include "datasets/load_mat.hpp"

#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "common/error.hpp"
#include "common/suggest.hpp"
#include "datasets/limits.hpp"
#include "datasets/mat_integrity.hpp"
#include "datasets/mat_path.hpp"

namespace rigcal::datasets {
namespace {

constexpr std::size_t kMostListedColumns = 100;
constexpr int kDeepestListing = 8;

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatPtr = std::unique_ptr<mat_t, CloseMat>;
using VariablePtr = std::unique_ptr<matvar_t, FreeVariable>;

/// One open file; only one at a time in the whole process.
struct MatFile {
  explicit MatFile(const std::filesystem::path& path) : name(path.string()), lock(hdf5_mutex()) {
    require_intact_mat_file(path);
    file.reset(Mat_Open(name.c_str(), MAT_ACC_RDONLY));
    if (!file) fail("cannot be read as a MAT file");
  }

  static std::mutex& hdf5_mutex() {
    static std::mutex mutex;
    return mutex;
  }

  [[noreturn]] void fail(const std::string& message) const { throw InputError({name}, message); }

  /// Every variable with its name and dimensions; no data.
  std::vector<VariablePtr> variables() const {
    Mat_Rewind(file.get());
    std::vector<VariablePtr> all;
    while (matvar_t* next = Mat_VarReadNextInfo(file.get())) all.emplace_back(next);
    return all;
  }

  std::string name;
  std::unique_lock<std::mutex> lock;
  QuietHdf5 quiet;
  MatPtr file;
};

// ---- What a variable is --------------------------------------------------------------------

bool is_number_class(matio_classes type) { return type >= MAT_C_DOUBLE && type <= MAT_C_UINT64; }

std::size_t element_count(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) count *= variable.dims[i];
  return count;
}

std::string size_text(const matvar_t& variable) {
  std::string text;
  for (int i = 0; i < variable.rank; ++i)
    text += fmt::format("{}{}", i == 0 ? "" : " x ", variable.dims[i]);
  return text;
}

/// How to save what matio cannot read.
constexpr const char* kHowToSave =
    "of a timeseries save its numbers: t = ts.Time; x = squeeze(ts.Data); save file.mat t x; or "
    "log to a \"Structure With Time\"";

std::string class_text(const matvar_t& variable) {
  switch (variable.class_type) {
    case MAT_C_CELL:
      return "a cell array";
    case MAT_C_STRUCT:
      return "a struct";
    case MAT_C_CHAR:
      return "a text";
    case MAT_C_SPARSE:
      return "a sparse matrix";
    case MAT_C_FUNCTION:
      return "a function";
    case MAT_C_EMPTY:
    case MAT_C_OBJECT:
    case MAT_C_OPAQUE:
      return fmt::format(
          "an object, such as a timeseries, a table or a string, which only MATLAB can read ({})",
          kHowToSave);
    default:
      return "a number";
  }
}

std::vector<std::string> field_names(const matvar_t& variable) {
  const unsigned count = Mat_VarGetNumberOfFields(const_cast<matvar_t*>(&variable));
  char* const* names = Mat_VarGetStructFieldnames(&variable);
  return names == nullptr ? std::vector<std::string>{}
                          : std::vector<std::string>(names, names + count);
}

// ---- From a path to numbers ----------------------------------------------------------------

/// Elements of an array, in its own order.
struct Selection {
  std::size_t start = 0;
  std::size_t stride = 1;
  std::size_t count = 0;
};

/// Reads the columns of one file.
class ColumnReader {
 public:
  explicit ColumnReader(const std::filesystem::path& path) : mat_(path) {}

  std::vector<double> read(const std::string& column, std::size_t values_so_far) {
    std::vector<MatStep> steps;
    try {
      steps = parse_mat_path(column);
    } catch (const std::invalid_argument& error) {
      mat_.fail(error.what());
    }
    const VariablePtr root(Mat_VarReadInfo(mat_.file.get(), steps.front().name.c_str()));
    if (!root) fail_unknown(steps.front().name);
    matvar_t* leaf = root.get();
    std::string path = steps.front().name;
    for (std::size_t i = 1; i < steps.size(); ++i) {
      leaf = field(*leaf, steps[i - 1], steps[i].name, path);
      path += "." + steps[i].name;
    }
    return numbers(*leaf, steps.back(), column, values_so_far);
  }

 private:
  [[noreturn]] void fail_unknown(const std::string& name) const {
    std::vector<std::string> known;
    bool nameless = false;
    for (const VariablePtr& variable : mat_.variables()) {
      if (variable->name != nullptr) known.emplace_back(variable->name);
      nameless = nameless || variable->class_type == MAT_C_OPAQUE;
    }
    std::string message = unknown_name_message("variable", name, known);
    if (nameless)
      message += fmt::format(
          "; the file also holds objects, such as a timeseries, a table or a string, which only "
          "MATLAB can read: {}",
          kHowToSave);
    mat_.fail(message);
  }

  /// A field of an element of a struct array.
  matvar_t* field(matvar_t& parent, const MatStep& step, const std::string& name,
                  const std::string& path) const {
    if (parent.class_type != MAT_C_STRUCT)
      mat_.fail(fmt::format("'{}' is {} and has no field '{}'; expected a struct", path,
                            class_text(parent), name));
    const std::size_t index = element_index(parent, step, path);
    matvar_t* found = Mat_VarGetStructFieldByName(&parent, name.c_str(), index);
    if (found == nullptr)
      mat_.fail(
          fmt::format("'{}': {}", path, unknown_name_message("field", name, field_names(parent))));
    return found;
  }

  std::size_t element_index(const matvar_t& parent, const MatStep& step,
                            const std::string& path) const {
    const std::size_t count = element_count(parent);
    if (step.subscripts.empty()) {
      if (count == 1) return 0;
      mat_.fail(fmt::format("'{0}' is a struct of {1}; expected one element, such as {0}(1)", path,
                            size_text(parent)));
    }
    std::size_t index = 0;
    std::size_t stride = 1;
    for (std::size_t k = 0; k < step.subscripts.size(); ++k) {
      index += step.subscripts[k].value() * stride;
      stride *= k < static_cast<std::size_t>(parent.rank) ? parent.dims[k] : 1;
    }
    if (index >= count)
      mat_.fail(fmt::format("'{}' is a struct of {}, and element {} is asked for", path,
                            size_text(parent), index + 1));
    return index;
  }

  Selection selection(const matvar_t& leaf, const MatStep& step, const std::string& column) const {
    const auto rank = static_cast<std::size_t>(leaf.rank);
    if (step.subscripts.empty()) {
      const auto long_dimensions =
          std::count_if(leaf.dims, leaf.dims + rank, [](std::size_t n) { return n != 1; });
      if (long_dimensions > 1)
        mat_.fail(
            fmt::format("'{0}' has {1} elements; expected a vector, or one line of it, such "
                        "as {0}({2})",
                        column, size_text(leaf), rank == 2 ? ":,1" : "1,1,:"));
      return {0, 1, element_count(leaf)};
    }
    Selection chosen{0, 1, 1};
    std::size_t stride = 1;
    for (std::size_t k = 0; k < std::max(rank, step.subscripts.size()); ++k) {
      const std::size_t size = k < rank ? leaf.dims[k] : 1;
      const bool given = k < step.subscripts.size();
      if (given ? step.subscripts[k].value_or(0) >= std::max<std::size_t>(size, 1) : size != 1)
        mat_.fail(fmt::format("'{}' is outside of '{}', which has {} elements", column, step.name,
                              size_text(leaf)));
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

  std::vector<double> numbers(matvar_t& leaf, const MatStep& step, const std::string& column,
                              std::size_t values_so_far) const {
    if (!is_number_class(leaf.class_type))
      mat_.fail(fmt::format("'{}' is {}; expected real numbers", column, class_text(leaf)));
    if (leaf.isComplex != 0)
      mat_.fail(fmt::format("'{}' is complex; expected real numbers", column));
    if (leaf.rank < 1 || leaf.dims == nullptr || element_count(leaf) == 0)
      mat_.fail(fmt::format("'{}' is empty; expected numbers", column));
    const Selection chosen = selection(leaf, step, column);
    if (chosen.count > kMostValues - std::min(kMostValues, values_so_far))
      mat_.fail(
          fmt::format("'{}' has {} elements, which with the {} of other columns are more "
                      "than {}, the limit of one file; decimate the record, or split it",
                      column, chosen.count, values_so_far, kMostValues));
    switch (leaf.class_type) {
      case MAT_C_SINGLE:
        return converted<float>(leaf, chosen, column);
      case MAT_C_INT8:
        return converted<std::int8_t>(leaf, chosen, column);
      case MAT_C_UINT8:
        return converted<std::uint8_t>(leaf, chosen, column);
      case MAT_C_INT16:
        return converted<std::int16_t>(leaf, chosen, column);
      case MAT_C_UINT16:
        return converted<std::uint16_t>(leaf, chosen, column);
      case MAT_C_INT32:
        return converted<std::int32_t>(leaf, chosen, column);
      case MAT_C_UINT32:
        return converted<std::uint32_t>(leaf, chosen, column);
      case MAT_C_INT64:
        return converted<std::int64_t>(leaf, chosen, column);
      case MAT_C_UINT64:
        return converted<std::uint64_t>(leaf, chosen, column);
      default:
        return converted<double>(leaf, chosen, column);
    }
  }

  template <typename Number>
  std::vector<double> converted(matvar_t& leaf, const Selection& chosen,
                                const std::string& column) const {
    std::vector<Number> raw(chosen.count);
    const int error =
        Mat_VarReadDataLinear(mat_.file.get(), &leaf, raw.data(), static_cast<int>(chosen.start),
                              static_cast<int>(chosen.stride), static_cast<int>(chosen.count));
    if (error != 0)
      mat_.fail(
          fmt::format("'{}' cannot be read (matio: error {}): the file is damaged", column, error));
    if constexpr (std::is_same_v<Number, double>) {
      require_finite(raw, column);
      return raw;
    } else {
      std::vector<double> values(raw.begin(), raw.end());
      if constexpr (sizeof(Number) == 8) {
        for (std::size_t i = 0; i < raw.size(); ++i) {
          constexpr double kExact = 9007199254740992.0;  // 2^53
          if (std::abs(values[i]) > kExact)
            mat_.fail(fmt::format("element {} of '{}' is {}, more than a double can hold exactly",
                                  i + 1, column, raw[i]));
        }
      }
      require_finite(values, column);
      return values;
    }
  }

  void require_finite(const std::vector<double>& values, const std::string& column) const {
    const auto bad =
        std::find_if(values.begin(), values.end(), [](double v) { return !std::isfinite(v); });
    if (bad != values.end())
      mat_.fail(fmt::format("element {} of '{}' is {}; expected a finite number",
                            bad - values.begin() + 1, column, *bad));
  }

  MatFile mat_;
};

// ---- Listing -------------------------------------------------------------------------------

/// Adds what load_mat() could read of a variable.
void list(matvar_t& variable, const std::string& path, int depth,
          std::vector<std::string>& columns) {
  if (variable.dims == nullptr || depth > kDeepestListing) return;
  const std::size_t count = element_count(variable);
  if (is_number_class(variable.class_type) && variable.isComplex == 0 && count > 1) {
    const auto long_dimensions = std::count_if(variable.dims, variable.dims + variable.rank,
                                               [](std::size_t n) { return n != 1; });
    if (long_dimensions == 1) columns.push_back(path);
    if (long_dimensions != 2 || variable.rank != 2) return;
    const bool in_rows = variable.dims[0] < variable.dims[1];
    const std::size_t lines = variable.dims[in_rows ? 0 : 1];
    for (std::size_t k = 1; k <= std::min(lines, kMostListedColumns); ++k)
      columns.push_back(in_rows ? fmt::format("{}({},:)", path, k)
                                : fmt::format("{}(:,{})", path, k));
  }
  if (variable.class_type != MAT_C_STRUCT) return;
  for (std::size_t element = 0; element < std::min(count, kMostListedColumns); ++element) {
    const std::string own = count == 1 ? path : fmt::format("{}({})", path, element + 1);
    for (const std::string& name : field_names(variable)) {
      matvar_t* field = Mat_VarGetStructFieldByName(&variable, name.c_str(), element);
      if (field != nullptr) list(*field, fmt::format("{}.{}", own, name), depth + 1, columns);
    }
  }
}

}  // namespace

bool is_mat_file(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".mat") return true;
  std::string start(10, '\0');
  std::ifstream file(path, std::ios::binary);
  return file.read(start.data(), static_cast<std::streamsize>(start.size())) &&
         (start == "MATLAB 5.0" || start == "MATLAB 7.3");
}

std::vector<std::vector<double>> load_mat(const std::filesystem::path& path,
                                          const MatRequest& request) {
  const auto time = std::find(request.columns.begin(), request.columns.end(), request.time_column);
  if (!request.time_column.empty() && time == request.columns.end())
    throw std::invalid_argument("load_mat: time_column '" + request.time_column +
                                "' is not among the columns");
  ColumnReader reader(path);
  std::vector<std::vector<double>> table;
  for (const std::string& column : request.columns) {
    table.push_back(reader.read(column, table.empty() ? 0 : table.size() * table[0].size()));
    if (table.back().size() != table.front().size())
      throw InputError(
          {path.string()},
          fmt::format("'{}' has {} elements, but '{}' has {}; expected as many", column,
                      table.back().size(), request.columns.front(), table.front().size()));
  }
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
  const MatFile mat(path);
  std::vector<std::string> columns;
  for (const VariablePtr& variable : mat.variables())
    if (variable->name != nullptr) list(*variable, variable->name, 0, columns);
  return columns;
}

}  // namespace rigcal::datasets
