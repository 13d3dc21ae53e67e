#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "datasets/read/hdf5/load_hdf5.hpp"
#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {
namespace {

namespace fs = std::filesystem;
using datasets::load_hdf5_record;

/// A small file with everything that the reader reads: vectors, packed chunks, a table, attributes.
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

Ending hdf5_ending(const fs::path& path) {
  return ending_of(path, [&] {
    datasets::hdf5_record_columns(path);
    return all_finite(
        load_hdf5_record(path, {{"/run/t", "/run/packed(:,2)", "/run/table.y"}, "/run/t"}).columns);
  });
}

}  // namespace

TEST_CASE("damaged HDF5: a changed byte gives numbers or is refused", "[datasets]") {
  const TemporaryFolder folder;
  const std::string whole = small_hdf5(folder);
  REQUIRE(hdf5_ending(folder / "small.h5") == Ending::values);
  const auto [values, refused] =
      damage(folder, "damaged.h5", whole, kSanitized ? 173 : 41, {0x80, 0xFF, 0x01}, hdf5_ending);
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
    CHECK(hdf5_ending(folder.write("cut.h5", whole.substr(0, bytes))) == Ending::refused);
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
