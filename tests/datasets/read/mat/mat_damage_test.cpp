#include <sys/resource.h>

#include <array>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/read/mat/load_mat.hpp"
#include "tests/datasets/mat_fixture.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {
namespace {

namespace fs = std::filesystem;
using datasets::load_mat_record;

/// A small file with everything that a MAT file may contain: vector, matrix, integers, nested
/// struct, text.
std::string small_mat(const TemporaryFolder& folder, MatFormat format) {
  write_mat(folder / "small.mat", format,
            {mat_array("t", Numbers{0.0, 0.5, 1.25}),
             mat_array("n", std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6}, {3, 2}),
             mat_struct("log", {{mat_struct("signals", {{mat_array("values", Numbers{1, 2, 3}),
                                                         mat_text("label", "position")}}),
                                 mat_array("time", Numbers{0.0, 0.1, 0.2})}})});
  return text_of(folder / "small.mat");
}

Ending mat_ending(const fs::path& path, bool all_columns) {
  return ending_of(path, [&] {
    const auto columns = datasets::mat_record_columns(path);
    bool finite = true;
    for (std::size_t i = 0; all_columns && i < columns.size(); ++i)
      finite = all_finite(load_mat_record(path, {{columns[i].name}, ""}).columns) && finite;
    load_mat_record(path, {{"t", "n(:,2)", "log.signals.values", "log.time"}, "t"});
    return finite;
  });
}

long megabytes_of(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  return usage.ru_maxrss / 1024;
}

}  // namespace

TEST_CASE("damaged MAT: any byte of version 5, changed in several ways", "[datasets]") {
  const auto format = GENERATE(MatFormat::v6, MatFormat::v7);
  const TemporaryFolder folder;
  const std::string whole = small_mat(folder, format);
  REQUIRE(mat_ending(folder / "small.mat", true) == Ending::values);
  const long megabytes_before = megabytes_of(RUSAGE_SELF);
  const std::vector<unsigned char> changes =
      kSanitized ? std::vector<unsigned char>{0x02, 0x80, 0xFF}
                 : std::vector<unsigned char>{0x01, 0x02, 0x08, 0x80, 0xFF};
  const Endings count = damage(folder, "damaged.mat", whole, 1, changes,
                               [](const fs::path& file) { return mat_ending(file, true); });
  const std::size_t each = changes.size();
  CHECK(count.values + count.refused == each * whole.size());
  // Compressed data have a checksum. In the rest, the numbers and the text of the header have none.
  CHECK(count.values >= each * 110);
  CHECK(count.refused > each * 250);
  // AddressSanitizer keeps 256 MB of freed memory.
  CHECK(megabytes_of(RUSAGE_SELF) - megabytes_before < (kSanitized ? 400 : 50));
}

TEST_CASE("damaged MAT: version 7.3, byte by byte", "[datasets]") {
  const TemporaryFolder folder;
  const std::string whole = small_mat(folder, MatFormat::v73);
  REQUIRE(mat_ending(folder / "small.mat", true) == Ending::values);
  const Endings count = damage(folder, "damaged.mat", whole, kSanitized ? 397 : 61, {0x80, 0xFF},
                               [](const fs::path& file) { return mat_ending(file, false); });
  CHECK(count.refused > 0);
  CHECK(count.values > 0);
  // Damages an address in the HDF5 heap that contains the field names.
  std::string damaged = whole;
  const std::size_t heap = whole.find("GCOL");
  REQUIRE(heap != std::string::npos);
  damaged[heap + 26] = static_cast<char>(damaged[heap + 26] ^ 0x80);
  CHECK(mat_ending(folder.write("heap.mat", damaged), false) == Ending::refused);
  CHECK(megabytes_of(RUSAGE_CHILDREN) < (kSanitized ? 4096 : 1024));
}

}  // namespace rigcal::test
