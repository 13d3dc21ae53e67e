#include <sys/resource.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/read/load_mat.hpp"
#include "tests/datasets/mat_fixture.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {
namespace {

namespace fs = std::filesystem;
using datasets::load_mat;
using datasets::mat_columns;
using Numbers = std::vector<double>;

/// A small file with all that a MAT file has: vector, matrix, integers, struct in a struct, text.
std::string small_mat(const TemporaryFolder& folder, MatFormat format) {
  write_mat(folder / "small.mat", format,
            {mat_array("t", Numbers{0.0, 0.5, 1.25}),
             mat_array("n", std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6}, {3, 2}),
             mat_struct("log", {{mat_struct("signals", {{mat_array("values", Numbers{1, 2, 3}),
                                                         mat_text("label", "position")}}),
                                 mat_array("time", Numbers{0.0, 0.1, 0.2})}})});
  return text_of(folder / "small.mat");
}

/// What became of a damaged file.
enum class Ending { values, refused, other };

Ending ending_of(const fs::path& path, bool all_columns) {
  try {
    const std::vector<std::string> columns = mat_columns(path);
    bool finite = true;
    for (std::size_t i = 0; all_columns && i < columns.size(); ++i) {
      const auto table = load_mat(path, {{columns[i]}, ""});
      for (const double value : table.front()) finite = finite && std::isfinite(value);
    }
    load_mat(path, {{"t", "n(:,2)", "log.signals.values", "log.time"}, "t"});
    return finite ? Ending::values : Ending::other;
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool has_words = message.size() > path.string().size() + 10 &&
                           message.starts_with(path.string() + ": ") &&
                           message.find('\n') == std::string::npos;
    return has_words ? Ending::refused : Ending::other;
  }
}

long megabytes_of(int who) {
  rusage usage{};
  ::getrusage(who, &usage);
  return usage.ru_maxrss / 1024;
}

struct Count {
  std::size_t values = 0;
  std::size_t refused = 0;
};

/// Tries every `step`-th byte with each change.
Count damage(const TemporaryFolder& folder, const std::string& whole, std::size_t step,
             const std::vector<unsigned char>& changes, bool all_columns) {
  Count count;
  for (std::size_t at = 0; at < whole.size(); at += step) {
    for (const unsigned char change : changes) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(static_cast<unsigned char>(damaged[at]) ^ change);
      fs::remove(folder / "damaged.mat");  // to write into it anew would wait for the disk
      const Ending ending = ending_of(folder.write("damaged.mat", damaged), all_columns);
      if (ending == Ending::other) FAIL_CHECK("byte " << at << " changed by " << int{change});
      count.values += ending == Ending::values ? 1 : 0;
      count.refused += ending == Ending::refused ? 1 : 0;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("damaged MAT: any byte of version 5, changed in several ways", "[datasets]") {
  const auto format = GENERATE(MatFormat::v6, MatFormat::v7);
  const TemporaryFolder folder;
  const std::string whole = small_mat(folder, format);
  REQUIRE(ending_of(folder / "small.mat", true) == Ending::values);
  const long megabytes_before = megabytes_of(RUSAGE_SELF);
  const std::vector<unsigned char> changes =
      kSanitized ? std::vector<unsigned char>{0x02, 0x80, 0xFF}
                 : std::vector<unsigned char>{0x01, 0x02, 0x08, 0x80, 0xFF};
  const Count count = damage(folder, whole, 1, changes, true);
  const std::size_t each = changes.size();
  CHECK(count.values + count.refused == each * whole.size());
  // What is compressed has a checksum; of the rest the numbers and the header's text have none.
  CHECK(count.values >= each * 110);
  CHECK(count.refused > each * 250);
  // AddressSanitizer keeps 256 MB of what was freed.
  CHECK(megabytes_of(RUSAGE_SELF) - megabytes_before < (kSanitized ? 400 : 50));
}

TEST_CASE("damaged MAT: version 7.3, byte by byte", "[datasets]") {
  const TemporaryFolder folder;
  const std::string whole = small_mat(folder, MatFormat::v73);
  REQUIRE(ending_of(folder / "small.mat", true) == Ending::values);
  const Count count = damage(folder, whole, kSanitized ? 397 : 61, {0x80, 0xFF}, false);
  CHECK(count.refused > 0);
  CHECK(count.values > 0);
  // What HDF5 1.10 takes for an address, in the heap that holds the names of fields.
  std::string damaged = whole;
  const std::size_t heap = whole.find("GCOL");
  REQUIRE(heap != std::string::npos);
  damaged[heap + 26] = static_cast<char>(damaged[heap + 26] ^ 0x80);
  CHECK_THROWS_WITH(mat_columns(folder.write("heap.mat", damaged)),
                    Catch::Contains("heap.mat: cannot be read by HDF5"));
  CHECK(megabytes_of(RUSAGE_CHILDREN) < (kSanitized ? 4096 : 1024));
}

}  // namespace rigcal::test
