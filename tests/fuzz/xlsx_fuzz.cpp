#include <cmath>
#include <string>

#include "common/error.hpp"
#include "datasets/read/xlsx/xlsx_columns.hpp"
#include "tests/datasets/xlsx_fixture.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;
using namespace rigcal::datasets;

/// A workbook whose sheet has this XML is either rejected, or all its columns are read as finite
/// values and have equal lengths. (The archive is left to libzip, whose authors fuzz it; a changed
/// byte in an archive mostly results in a wrong checksum.)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::scratch_folder() / "record.xlsx";
  test::write_zip(file, test::xlsx_parts({{"Log", std::string(fuzz::text_of_bytes(data, size))}}),
                  false);
  try {
    for (const RecordColumn& column : list_xlsx_columns(file)) {
      for (const bool is_time : {false, true}) {
        try {
          const auto columns =
              read_xlsx_columns(file, {{column.name}, is_time ? column.name : std::string()})
                  .columns;
          fuzz::require(columns.size() == 1 && !columns.front().empty(), "one column of numbers");
          for (const double value : columns.front())
            fuzz::require(std::isfinite(value), "finite numbers");
        } catch (const InputError&) {
        }
      }
    }
  } catch (const InputError&) {
  }
  return 0;
}
