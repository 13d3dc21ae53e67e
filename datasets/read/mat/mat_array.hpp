#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace rigcal::datasets {

enum class MatKind { number, text, cell, structure, sparse, function, object, empty };

/// Description of an array in a MAT file. Its numbers remain in the file.
struct MatArray {
  std::string name;
  MatKind kind = MatKind::empty;
  bool is_complex = false;
  std::vector<std::size_t> dims;
  std::vector<std::string> field_names;  ///< for a structure
  /// For a structure, shape (elements x field names). The fields of an element are adjacent.
  std::vector<MatArray> fields;

  /// Location of the numbers; the meaning depends on the reader.
  std::uint64_t place = 0;
  std::uint32_t storage = 0;
  std::size_t variable = 0;

  /// Cannot overflow, because readers check the dimensions.
  std::size_t element_count() const {
    std::size_t count = 1;
    for (const std::size_t n : dims) count *= n;
    return count;
  }
};

/// Elements of an array in file order, column by column: start, start + stride, ...
struct MatSelection {
  std::size_t start = 0;
  std::size_t stride = 1;
  std::size_t count = 0;
};

/// An open MAT file.
class MatSource {
 public:
  MatSource() = default;
  MatSource(const MatSource&) = delete;
  MatSource& operator=(const MatSource&) = delete;
  virtual ~MatSource() = default;

  virtual const std::string& name() const = 0;
  virtual const std::vector<MatArray>& variables() const = 0;

  /// Returns the selected numbers of an array.
  ///
  /// @param array   one of variables(), with real numbers; it contains the selection
  /// @param column  name of the column, for messages
  /// @throws InputError  if the file is damaged, or if a double cannot represent an integer
  virtual std::vector<double> numbers(const MatArray& array, const MatSelection& selection,
                                      const std::string& column) = 0;
};

/// Whether a double is certain to represent a number exactly; false for 64-bit integers beyond
/// 2^53.
template <typename Number>
bool is_exact_as_double(Number number) {
  if constexpr (std::is_integral_v<Number> && sizeof(Number) == 8) {
    constexpr Number kMost = Number{1} << 53;
    if (number > kMost) return false;
    if constexpr (std::is_signed_v<Number>) return number >= -kMost;
  }
  return true;
}

}  // namespace rigcal::datasets
