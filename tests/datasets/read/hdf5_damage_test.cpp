#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/read/load_hdf5.hpp"
#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {
namespace {

namespace fs = std::filesystem;
using datasets::hdf5_record_columns;
using datasets::load_hdf5_record;

/// A small file with all that is read: vectors, packed chunks, a table, attributes.
std::string small_hdf5(const TemporaryFolder& folder) {
  {
    const Hdf5Writer file(folder / "small.h5");
    file.array("/run/t", {0.0, 0.5, 1.25});
    file.array("/run/packed", {1, 2, 3, 4, 5, 6}, {3, 2}, H5T_IEEE_F32BE, true);
    file.table("/run/table", {{"x", {1, 2, 3}}, {"y", {4, 5, 6}}});
    file.text("/run/t", "units", "s");
    file.number("/run/t", "wf_increment", 0.25);
  }
  return text_of(folder / "small.h5");
}

enum class Hdf5Ending { values, refused, other };

Hdf5Ending hdf5_ending(const fs::path& path) {
  try {
    hdf5_record_columns(path);
    const auto table =
        load_hdf5_record(path, {{"/run/t", "/run/packed(:,2)", "/run/table.y"}, "/run/t"});
    for (const auto& column : table.columns)
      for (const double value : column)
        if (!std::isfinite(value)) return Hdf5Ending::other;
    return Hdf5Ending::values;
  } catch (const InputError& error) {
    const std::string message = error.what();
    const bool has_words = message.size() > path.string().size() + 10 &&
                           message.starts_with(path.string() + ": ") &&
                           message.find('\n') == std::string::npos;
    return has_words ? Hdf5Ending::refused : Hdf5Ending::other;
  }
}

}  // namespace

TEST_CASE("damaged HDF5: a changed byte gives numbers or is refused", "[datasets]") {
  const TemporaryFolder folder;
  const std::string whole = small_hdf5(folder);
  REQUIRE(hdf5_ending(folder / "small.h5") == Hdf5Ending::values);
  std::size_t values = 0;
  std::size_t refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += kSanitized ? 173 : 41) {
    for (const int change : {0x80, 0xFF, 0x01}) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ change);
      fs::remove(folder / "damaged.h5");  // to write into it anew would wait for the disk
      const Hdf5Ending ending = hdf5_ending(folder.write("damaged.h5", damaged));
      if (ending == Hdf5Ending::other) FAIL_CHECK("byte " << at << " changed by " << change);
      values += ending == Hdf5Ending::values ? 1 : 0;
      refused += ending == Hdf5Ending::refused ? 1 : 0;
    }
  }
  CHECK(values > 0);
  CHECK(refused > 0);
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  CHECK(children.ru_maxrss / 1024 < (kSanitized ? 4096 : 1024));
}

TEST_CASE("damaged HDF5: cut anywhere, it is refused", "[datasets]") {
  const TemporaryFolder folder;
  const std::string whole = small_hdf5(folder);
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += kSanitized ? 499 : 97) {
    CAPTURE(bytes, whole.size());
    CHECK(hdf5_ending(folder.write("cut.h5", whole.substr(0, bytes))) == Hdf5Ending::refused);
  }
}

TEST_CASE("damaged HDF5: a shape beyond the limit of one file takes no memory", "[datasets]") {
  const TemporaryFolder folder;
  {
    const Hdf5Writer file(folder / "huge.h5");
    const hsize_t shape = hsize_t{1} << 40;
    const hsize_t chunk = hsize_t{1} << 20;
    const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(plan, 1, &chunk);
    H5Pset_deflate(plan, 9);
    const hid_t space = H5Screate_simple(1, &shape, nullptr);
    H5Dclose(H5Dcreate2(file.file(), "/x", H5T_IEEE_F64LE, space, H5P_DEFAULT, plan, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(plan);
  }
  CHECK_THROWS_WITH(
      load_hdf5_record(folder / "huge.h5", {{"/x"}, ""}),
      Catch::Contains("'/x' has 1099511627776 rows") && Catch::Contains("the limit of one file"));
}

}  // namespace rigcal::test
