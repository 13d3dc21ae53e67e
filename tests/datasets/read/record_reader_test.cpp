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
  CHECK(record_reader(pipe).name == "CSV");  // and it does not wait for a writer
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
  // Without the separator of the request, the names would be 't' and 'a,x'.
  const auto two = folder.write("two.csv", "t;a,x\n0;n,1.5\n1;n,2.5\n");
  CHECK(record_reader(two).load(two, {{"x"}, "", ','}).columns ==
        std::vector<std::vector<double>>{{1.5, 2.5}});
  const auto cut = folder.write("cut.csv", "t,x\n0,1.5\n0.5,2.25\n1.0,2");
  CHECK_THAT(record_reader(cut).load(cut, {{"t", "x"}, "t"}).warning,
             Catch::Contains("ends without a newline"));
}

TEST_CASE("record_reader: formats that are not read are named, with what to export instead",
          "[datasets]") {
  struct Row {
    const char* file;
    std::string bytes;
    const char* says;
  };
  const TemporaryFolder folder;
  for (const Row& row : {
           Row{"a.bin", "TDSm....", "TDMS"},
           Row{"a.mf4", "MDF     4.10", "asammdf"},
           Row{"b.dat", "MDF     3.30", "MDF"},
           Row{"a.rsp", "x", "RPC III"},
           Row{"c.dat", std::string("FORMAT\0\0\0", 9), "RPC III"},
           Row{"a.txt", "    -1\n    58b     1\n", "pyuff"},
           Row{"b.txt", "    -1\n   151\n", "pyuff"},
           Row{"a.npy", "\x93NUMPY..", "numpy.savetxt"},
           Row{"a.csv.gz", "\x1f\x8b..", "gunzip"},
       }) {
    CAPTURE(row.file);
    CHECK_THROWS_WITH(
        record_reader(folder.write(row.file, row.bytes)),
        Catch::Contains("which rigcal cannot read; expected ") && Catch::Contains(row.says));
  }
  CHECK(record_reader(folder.write("minus.csv", "-1\n5\n")).name == "CSV");
}

TEST_CASE("record_reader: text files may be recordings, but their names do not say so",
          "[datasets]") {
  CHECK(may_be_recording("a.TXT"));
  CHECK(may_be_recording("a.lvm"));
  CHECK(may_be_recording("a.csv"));
  CHECK_FALSE(may_be_recording("a.log"));
  CHECK_FALSE(has_record_name("a.txt"));
  CHECK(has_other_format_name("a.tdms"));
  CHECK_FALSE(has_other_format_name("a.csv"));
}
