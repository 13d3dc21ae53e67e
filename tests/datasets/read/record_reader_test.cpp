#include "datasets/read/record_reader.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "tests/datasets/mat_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using namespace rigcal::test;

TEST_CASE("record_reader: a file is of the format that its name or its first bytes tell",
          "[datasets]") {
  const TemporaryFolder folder;
  CHECK(record_reader("x.MAT").name == "MAT");
  CHECK(record_reader("x.csv").name == "CSV");
  CHECK(record_reader(folder.path() / "absent").name == "CSV");
  CHECK(record_reader(folder.path()).name == "CSV");
  CHECK(record_reader(folder.write("x.csv", "t,x\n0,1\n")).name == "CSV");
  CHECK(record_reader(folder.write("empty.txt", "")).name == "CSV");
  write_mat(folder.path() / "y.dat", MatFormat::v7, {mat_array("t", std::vector<double>{1})});
  CHECK(record_reader(folder.path() / "y.dat").name == "MAT");
  write_mat(folder.path() / "z.csv", MatFormat::v73, {mat_array("t", std::vector<double>{1})});
  CHECK(record_reader(folder.path() / "z.csv").name == "MAT");
}

TEST_CASE("record_reader: the start of a pipe is not taken from it", "[datasets]") {
  const TemporaryFolder folder;
  const auto pipe = folder.path() / "pipe";
  std::filesystem::create_directories(folder.path());
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(record_reader(pipe).name == "CSV");  // and does not wait for a writer
}

TEST_CASE("record_reader: names of recordings", "[datasets]") {
  CHECK(has_record_name("a/run.CSV"));
  CHECK(has_record_name("run.mat"));
  CHECK_FALSE(has_record_name("run"));
  CHECK_FALSE(has_record_name("run."));
  CHECK_FALSE(has_record_name("run.json"));
  CHECK(record_format_names().starts_with("CSV"));
  CHECK(record_extensions().starts_with(".csv"));
}

TEST_CASE("record_reader: CSV and MAT by the same calls", "[datasets]") {
  const TemporaryFolder folder;
  const auto csv = folder.write("x.csv", "t,x [mm]\n0,1\n0.5,2\n");
  const auto mat = folder.path() / "x.mat";
  write_mat(mat, MatFormat::v7,
            {mat_array("t", std::vector<double>{0, 0.5}), mat_array("x", std::vector<double>{1, 2}),
             mat_array("rows", std::vector<double>{1, 2, 3, 4, 5, 6}, {2, 3})});
  CHECK(record_reader(csv).columns(csv) ==
        std::vector<RecordColumn>{{"t", "", false, false}, {"x [mm]", "", false, false}});
  CHECK(record_reader(mat).columns(mat) ==
        std::vector<RecordColumn>{{"t", "", false, false},
                                  {"x", "", false, false},
                                  {"rows(1,:)", "", false, true},
                                  {"rows(2,:)", "", false, true}});
  for (const auto& file : {csv, mat}) {
    const RecordTable table = record_reader(file).load(file, {{"x", "t"}, "t"});
    CHECK(table.columns == std::vector<std::vector<double>>{{1, 2}, {0, 0.5}});
    CHECK(table.warning.empty());
    CHECK_THROWS_AS(record_reader(file).load(file, {{"x"}, "t"}), std::invalid_argument);
    CHECK_THROWS_AS(record_reader(file).load(file, {{"y"}, ""}), InputError);
  }
  const auto cut = folder.write("cut.csv", "t,x\n0,1.5\n0.5,2.25\n1.0,2");
  CHECK_THAT(record_reader(cut).load(cut, {{"t", "x"}, "t"}).warning,
             Catch::Contains("ends without a newline"));
}
