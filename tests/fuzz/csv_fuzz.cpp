#include <cmath>

#include "common/error.hpp"
#include "datasets/read/csv/load_csv.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;
using namespace rigcal::datasets;

namespace {

void read_all(const std::filesystem::path& file, const std::vector<std::string>& names,
              bool has_time, bool leaves_out_rows) {
  RecordRequest request;
  request.columns = names;
  if (has_time && !names.empty()) request.time_column = names.front();
  request.leaves_out_rows = leaves_out_rows;
  const RecordTable table = load_csv_record(file, request);
  fuzz::require(table.columns.size() == names.size(), "one column per name");
  for (const std::vector<double>& column : table.columns) {
    fuzz::require(column.size() == table.columns.front().size(), "columns of one length");
    for (const double value : column) fuzz::require(std::isfinite(value), "finite numbers");
  }
}

}  // namespace

/// A CSV file is either rejected, or all its columns are read as finite values and have equal
/// lengths, whether rows without a number are refused or left out.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::scratch_file("record.csv", fuzz::text_of_bytes(data, size));
  for (const bool leaves_out_rows : {false, true}) try {
      std::vector<std::string> names;
      for (const RecordColumn& column : csv_record_columns(file)) names.push_back(column.name);
      for (const bool has_time : {false, true}) read_all(file, names, has_time, leaves_out_rows);
    } catch (const InputError&) {
    }
  return 0;
}
