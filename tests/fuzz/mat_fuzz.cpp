#include <cmath>

#include "common/error.hpp"
#include "datasets/read/mat/mat_columns.hpp"
#include "datasets/read/mat/mat_level5.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace rigcal;
using namespace rigcal::datasets;

/// A level-5 MAT file is either rejected, or every column that it claims to have is read as finite
/// values. (Other libraries read version 7.3, in a separate process.)
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = fuzz::scratch_file("record.mat", fuzz::text_of_bytes(data, size));
  try {
    Level5Source source(file, std::uint64_t{64} << 20);
    for (const std::string& column : list_mat_columns(source)) {
      try {
        for (const double value : read_mat_column(source, column, 0))
          fuzz::require(std::isfinite(value), "finite numbers");
      } catch (const InputError&) {
      }
    }
  } catch (const InputError&) {
  }
  return 0;
}
