#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/read/xlsx/xlsx_archive.hpp"

namespace rigcal::datasets {

/// Kind of content in a cell. A formula counts as its last result. Its kind is no_result if the
/// program that wrote the workbook did not compute it. The cell then has no value, an empty one
/// (openpyxl), or 0 in a workbook that is to be computed on opening (`fullCalcOnLoad`; XlsxWriter).
enum class XlsxKind { number, date, text, truth, error, no_result };

struct XlsxCell {
  std::size_t row = 0;     ///< from 1
  std::size_t column = 0;  ///< from 1
  XlsxKind kind = XlsxKind::number;
  std::string text;  ///< as stored
};

/// Cells displayed as one; only the first has a value.
struct XlsxMerged {
  std::string range;  ///< "B2:B4"
  std::size_t first_row = 0, first_column = 0, last_row = 0, last_column = 0;
  bool holds(std::size_t row, std::size_t column) const {
    return row >= first_row && row <= last_row && column >= first_column && column <= last_column;
  }
};

/// Returns the address of a cell, such as "C17". Rows and columns count from 1.
std::string xlsx_address(std::size_t row, std::size_t column);

/// An .xlsx workbook (ECMA-376, SpreadsheetML), read strictly, whatever the locale. Use it only
/// within run_confined(), because damaged files may crash the underlying libraries.
class XlsxBook {
 public:
  struct Sheet {
    std::string name;
    std::string part;
  };

  /// @throws InputError  if the file is not a workbook, is damaged, or is too large
  explicit XlsxBook(const std::filesystem::path& path);

  const std::string& name() const { return archive_.name(); }
  /// Worksheets in workbook order, at least one.
  const std::vector<Sheet>& sheets() const { return sheets_; }

  /// Passes every cell with content to `take`, row by row, until `take` returns false.
  ///
  /// @return merged cells, if the sheet was read to its end
  /// @throws InputError  if the sheet is damaged, or if its cells are out of order
  std::vector<XlsxMerged> read(const Sheet& sheet,
                               const std::function<bool(const XlsxCell&)>& take) const;

 private:
  XlsxArchive archive_;
  std::vector<Sheet> sheets_;
  std::vector<std::string> texts_;  ///< texts that several cells share
  bool is_to_be_computed_ = false;  ///< whether to compute on opening (`fullCalcOnLoad`)
  std::vector<bool> shows_a_date_;  ///< indexed by the style of a cell
};

}  // namespace rigcal::datasets
