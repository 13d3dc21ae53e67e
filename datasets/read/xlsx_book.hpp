#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "datasets/read/xlsx_archive.hpp"

namespace rigcal::datasets {

/// What a cell holds. A formula is what it last gave.
enum class XlsxKind { number, date, text, truth, error, no_result };

struct XlsxCell {
  std::size_t row = 0;     ///< from 1
  std::size_t column = 0;  ///< from 1
  XlsxKind kind = XlsxKind::number;
  std::string text;  ///< as it is stored
};

/// Cells that are shown as one, of which only the first holds a value.
struct XlsxMerged {
  std::string range;  ///< "B2:B4"
  std::size_t first_row = 0, first_column = 0, last_row = 0, last_column = 0;
  bool holds(std::size_t row, std::size_t column) const {
    return row >= first_row && row <= last_row && column >= first_column && column <= last_column;
  }
};

/// "C17"; rows and columns count from 1.
std::string xlsx_address(std::size_t row, std::size_t column);

/// An .xlsx workbook (ECMA-376, SpreadsheetML), read strictly and without any setting of the
/// machine. Only to be used by run_confined(): it is as robust as the libraries that it rests on.
class XlsxBook {
 public:
  struct Sheet {
    std::string name;
    std::string part;
  };

  /// @throws InputError  no workbook, damaged, too large
  explicit XlsxBook(const std::filesystem::path& path);

  const std::string& name() const { return archive_.name(); }
  /// Worksheets in their order, at least one.
  const std::vector<Sheet>& sheets() const { return sheets_; }

  /// Hands over the cells of a sheet that hold something, row by row, until `take` returns false.
  ///
  /// @return merged cells, if it was read to its end
  /// @throws InputError  damaged, or cells that are not in their order
  std::vector<XlsxMerged> read(const Sheet& sheet,
                               const std::function<bool(const XlsxCell&)>& take) const;

 private:
  XlsxArchive archive_;
  std::vector<Sheet> sheets_;
  std::vector<std::string> texts_;  ///< that cells share
  std::vector<bool> shows_a_date_;  ///< by the number of a cell's style
};

}  // namespace rigcal::datasets
