#include <cmath>

#include "common/error.hpp"
#include "datasets/read/csv/load_csv.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;
using namespace rigcal::datasets;

/// A CSV file is either rejected, or all its columns are read as finite values and have equal
/// lengths.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::scratch_file("record.csv", fuzz::text_of_bytes(data, size));
  try {
    std::vector<std::string> names;
    for (const RecordColumn& column : csv_record_columns(file)) names.push_back(column.name);
    for (const bool has_time : {false, true}) {
      CsvRequest request;
      request.columns = names;
      if (has_time && !names.empty()) request.time_column = names.front();
      const CsvTable table = load_csv(file, request);
      fuzz::require(table.columns.size() == names.size(), "one column per name");
      for (const std::vector<double>& column : table.columns) {
        fuzz::require(column.size() == table.columns.front().size(), "columns of one length");
        for (const double value : column) fuzz::require(std::isfinite(value), "finite numbers");
      }
    }
  } catch (const InputError&) {
  }
  return 0;
}
