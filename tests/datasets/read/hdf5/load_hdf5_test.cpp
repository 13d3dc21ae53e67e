#include "datasets/read/hdf5/load_hdf5.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::Contains;

namespace {

std::vector<std::string> hdf5_names(const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const RecordColumn& column : hdf5_record_columns(path)) names.push_back(column.name);
  return names;
}

}  // namespace

TEST_CASE("load_hdf5: datasets, lines of matrices and columns of tables", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/run1/time", {0, 0.5, 1});
    file.array("/run1/position", {1, 2, 3});
    file.array("/run1/column", {7, 8, 9}, {3, 1});
    file.array("/run1/data", {1, 10, 2, 20, 3, 30}, {3, 2});
    file.array("/run1/rows", {1, 2, 3, 10, 20, 30}, {2, 3});
    file.array("/deep", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, {3, 2, 2});
    file.array("/packed", {1, 10, 2, 20, 3, 30}, {3, 2}, H5T_IEEE_F32LE, true);
    file.table("/run1/table", {{"t", {0, 1, 2}}, {"x mm", {4, 5, 6}}});
    file.array("/run1/data.old", {1, 1, 1});
  }
  CHECK(read_columns(
            path,
            {"/run1/time", "run1/position", "/run1/column", "/run1/data(:,2)", "/run1/rows(2,:)",
             "/deep(:,1,2)", "/packed( : , 2 )", "/run1/table.x mm", "/run1/data.old"},
            "/run1/time") == Table{{0, 0.5, 1},
                                   {1, 2, 3},
                                   {7, 8, 9},
                                   {10, 20, 30},
                                   {10, 20, 30},
                                   {2, 6, 10},
                                   {10, 20, 30},
                                   {4, 5, 6},
                                   {1, 1, 1}});
  CHECK(hdf5_names(path) ==
        std::vector<std::string>{"/packed(:,1)", "/packed(:,2)", "/run1/column", "/run1/data(:,1)",
                                 "/run1/data(:,2)", "/run1/data.old", "/run1/position",
                                 "/run1/rows(1,:)", "/run1/rows(2,:)", "/run1/table.t",
                                 "/run1/table.x mm", "/run1/time"});
}

TEST_CASE("load_hdf5: numbers of any size and byte order", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  const std::vector<std::pair<std::string, hid_t>> types{
      {"f8b", H5T_IEEE_F64BE}, {"f4l", H5T_IEEE_F32LE}, {"f4b", H5T_IEEE_F32BE},
      {"i1", H5T_STD_I8LE},    {"u1", H5T_STD_U8BE},    {"i2b", H5T_STD_I16BE},
      {"u2", H5T_STD_U16LE},   {"i4", H5T_STD_I32LE},   {"u4b", H5T_STD_U32BE},
      {"i8b", H5T_STD_I64BE},  {"u8", H5T_STD_U64LE},   {"f10", H5T_NATIVE_LDOUBLE}};
  {
    const Hdf5Writer file(path);
    for (const auto& [name, type] : types) file.array("/" + name, {1, 100, 7}, {}, type);
    // 12 significant bits out of 16, as delivered by converters.
    const hid_t twelve = H5Tcopy(H5T_STD_I16LE);
    H5Tset_precision(twelve, 12);
    file.array("/i12", {-2048, 2047, -1}, {}, twelve);
    H5Tclose(twelve);
    // A floating-point type of half precision.
    const hid_t half = H5Tcopy(H5T_IEEE_F32LE);
    H5Tset_fields(half, 15, 10, 5, 0, 10);
    H5Tset_size(half, 2);
    H5Tset_ebias(half, 15);
    file.array("/f2", {0.5, -2.25, 1024}, {}, half);
    H5Tclose(half);
    file.array("/tenth", {0.1, 0.2, 0.3}, {}, H5T_IEEE_F32LE);
    file.integers("/most", {9007199254740992, -9007199254740992});
    file.integers("/beyond", {1, 9007199254740993});
  }
  for (const auto& [name, type] : types) {
    CAPTURE(name);
    CHECK(read_columns(path, {"/" + name}) == Table{{1, 100, 7}});
  }
  CHECK(read_columns(path, {"/i12", "/f2"}) == Table{{-2048, 2047, -1}, {0.5, -2.25, 1024}});
  CHECK(read_columns(path, {"/tenth"})[0][0] == static_cast<double>(0.1F));
  CHECK(read_columns(path, {"/most"}) == Table{{9007199254740992.0, -9007199254740992.0}});
  CHECK_THAT(read_refusal(path, {"/beyond"}),
             Contains("row 2 of '/beyond' is 9007199254740993, more than a double can hold"));
}

TEST_CASE("load_hdf5: arrays in the cells of a table, as pandas writes them", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "frame.h5";
  {
    const Hdf5Writer file(path);
    const hsize_t three = 3;
    const hid_t block = H5Tarray_create2(H5T_IEEE_F64LE, 1, &three);
    const hid_t row = H5Tcreate(H5T_COMPOUND, 8 + 24);
    H5Tinsert(row, "index", 0, H5T_STD_I64LE);
    H5Tinsert(row, "values_block_0", 8, block);
    struct Row {
      long long index;
      double values[3];
    };
    const std::vector<Row> rows{{0, {1, 2, 3}}, {1, {4, 5, 6}}};
    const hsize_t count = rows.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t set =
        H5Dcreate2(file.file(), "/df", row, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(H5Dwrite(set, row, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) >= 0);
    for (const hid_t id : {block, row}) H5Tclose(id);
    H5Sclose(space);
    H5Dclose(set);
  }
  CHECK(read_columns(path, {"/df.index", "/df.values_block_0(:,2)"}, "/df.index") ==
        Table{{0, 1}, {2, 5}});
  CHECK(read_columns(path, {"/df.values_block_0(2,:)"}) == Table{{4, 5, 6}});
  CHECK_THAT(read_refusal(path, {"/df"}),
             Contains("'/df' is a table; expected one of its columns, such as '/df.index'"));
}

TEST_CASE("load_hdf5: units by attributes, of one dataset, a matrix or a table", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/a", {1, 2, 3});
    file.text("/a", "units", "mm");
    file.array("/b", {1, 2, 3});
    file.text("/b", "unit_string", " bar  ", false);
    file.array("/c", {1, 10, 2, 20, 3, 30}, {3, 2});
    file.texts("/c", "unit", {"s", "kN"});
    file.table("/d", {{"t", {0, 1, 2}}, {"u", {4, 5, 6}}});
    file.texts("/d", "units", {"ms", "V"});
    file.array("/e", {1, 2, 3});
    file.text("/e", "unit", "m\nschema = 1");  // would add a line to the campaign file
    file.array("/f", {1, 2, 3});
    file.number("/f", "unit", 3.0);
  }
  CHECK(hdf5_record_columns(path) == std::vector<RecordColumn>{{"/a", "mm", false, false},
                                                               {"/b", "bar", false, false},
                                                               {"/c(:,1)", "s", false, true},
                                                               {"/c(:,2)", "kN", false, true},
                                                               {"/d.t", "ms", false, false},
                                                               {"/d.u", "V", false, false},
                                                               {"/e", "", false, false},
                                                               {"/f", "", false, false}});
}

TEST_CASE("load_hdf5: time by the distance of samples", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "tdms.h5";
  {
    const Hdf5Writer file(path);
    file.array("/log/x", {1, 2, 3});
    file.number("/log/x", "wf_increment", 0.25);
    file.number("/log/x", "wf_start_offset", 10.0);
    file.array("/log/y", {4, 5, 6});
    file.number("/log", "sample_rate", 1000.0);
    file.array("/log/short", {4, 5});
    file.number("/log/short", "dt", 0.5);
    file.array("/log/none", {4, 5});
    file.number("/log/none", "dt", 0.0);  // gives no information
  }
  CHECK(read_columns(path, {"/log/x@wf_increment", "/log/x"}, "/log/x@wf_increment") ==
        Table{{10, 10.25, 10.5}, {1, 2, 3}});
  CHECK(read_columns(path, {"log@sample_rate", "log/y"}, "log@sample_rate") ==
        Table{{0, 0.001, 0.002}, {4, 5, 6}});
  const auto columns = hdf5_record_columns(path);
  CHECK(std::count(columns.begin(), columns.end(),
                   RecordColumn{"/log/x@wf_increment", "s", true, false}) == 1);
  CHECK(std::count_if(columns.begin(), columns.end(),
                      [](const RecordColumn& column) { return column.is_time; }) == 3);
  CHECK_THAT(read_refusal(path, {"/log/x@wf_increment", "/log/short"}),
             Contains("'/log/x@wf_increment' applies to the 3 samples of its dataset, but "
                      "'/log/short' has 2"));
  CHECK_THAT(read_refusal(path, {"/log/x@wf_increment", "/log/short@dt"}),
             Contains("'/log/short@dt' applies to the 2 samples of its dataset, but "
                      "'/log/x@wf_increment' has 3"));
  CHECK_THAT(read_refusal(path, {"/log@sample_rate"}), Contains("expected another column"));
}

TEST_CASE("load_hdf5: what is no column of numbers", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  {
    const Hdf5Writer file(path);
    file.array("/run/t", {0, 1, 2});
    file.array("/run/position", {1, 2, 3});
    file.array("/run/back", {0, 1, 1});
    file.array("/run/hole", {1, 2, nan});
    file.array("/run/edge", {-std::numeric_limits<double>::infinity(), 2, 3});
    file.array("/run/short", {1, 2});
    file.array("/run/data", {1, 10, 2, 20, 3, 30}, {3, 2});
    file.unwritten("/run/absent", {3}, H5T_IEEE_F64LE);
    file.unwritten("/run/empty", {0}, H5T_IEEE_F64LE);
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, 4);
    file.unwritten("/run/text", {3}, text);
    H5Tclose(text);
    const hid_t truth = H5Tenum_create(H5T_STD_I8LE);
    const signed char no = 0;
    H5Tenum_insert(truth, "FALSE", &no);
    file.unwritten("/run/flag", {3}, truth);
    H5Tclose(truth);
    file.unwritten("/run/refs", {3}, H5T_STD_REF_OBJ);
  }
  struct Case {
    std::vector<std::string> columns;
    std::string part;
  };
  const std::vector<Case> cases{
      {{"/run/posiion"}, "unknown dataset '/run/posiion'; did you mean '/run/position'?"},
      {{"/run"}, "unknown dataset '/run'"},
      {{"/run/hole"}, "row 3 of '/run/hole' is nan; expected a finite number"},
      {{"/run/edge"}, "row 1 of '/run/edge' is -inf; expected a finite number"},
      {{"/run/position", "/run/short"},
       "'/run/short' has 2 rows, but '/run/position' has 3; expected the same number"},
      {{"/run/data"}, "'/run/data' has 3 x 2 elements; expected a vector, or one line of it"},
      {{"/run/data(:,3)"}, "'/run/data(:,3)' is outside of '/run/data', which has 3 x 2"},
      {{"/run/data(:)"}, "expected 2 entries between the brackets"},
      {{"/run/data(:,0)"}, "does not end in one row or column"},
      {{"/run/data(:,:)"}, "does not end in one row or column"},
      {{"/run/data(:,1"}, "does not end in one row or column"},
      {{"/run/data(1,1)"}, "does not end in one row or column"},
      {{"/run/absent"}, "'/run/absent' was never written: it has a shape, but no numbers"},
      {{"/run/empty"}, "'/run/empty' is empty; expected numbers"},
      {{"/run/text"}, "'/run/text' is text; expected numbers"},
      {{"/run/flag"}, "'/run/flag' is an enumeration, such as truth values; expected numbers"},
      {{"/run/refs"}, "'/run/refs' is a reference; expected numbers"}};
  for (const Case& each : cases) {
    CAPTURE(each.columns);
    CHECK_THAT(read_refusal(path, each.columns), Contains("run.h5: ") && Contains(each.part));
  }
  CHECK_THAT(read_refusal(path, {"/run/back"}, "/run/back"),
             Contains("time '/run/back' does not increase: row 3 is 1 after 1"));
  CHECK_THROWS_AS(read_columns(path, {"/run/t"}, "/run/position"), std::invalid_argument);
}

TEST_CASE("load_hdf5: no other file is opened, and no foreign filter loaded", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  const auto secret = folder.write("secret.bin", std::string(24, '\1'));
  {
    const Hdf5Writer file(path);
    file.array("/t", {0, 1, 2});
    H5Lcreate_external((folder.path() / "other.h5").c_str(), "/x", file.file(), "/link",
                       H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_soft("/t", file.file(), "/soft", H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_hard(file.file(), "/", file.file(), "/circle", H5P_DEFAULT, H5P_DEFAULT);
    const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(plan, secret.c_str(), 0, 24);
    const hsize_t three = 3;
    const hid_t space = H5Screate_simple(1, &three, nullptr);
    H5Dclose(
        H5Dcreate2(file.file(), "/outside", H5T_IEEE_F64LE, space, H5P_DEFAULT, plan, H5P_DEFAULT));
    H5Sclose(space);
    H5Pclose(plan);
  }
  {
    const Hdf5Writer other(folder.path() / "other.h5");
    other.array("/x", {5, 6, 7});
  }
  CHECK_THAT(read_refusal(path, {"/link"}), Contains("unknown dataset '/link'"));
  CHECK_THAT(read_refusal(path, {"/soft"}), Contains("unknown dataset '/soft'"));
  CHECK_THAT(read_refusal(path, {"/outside"}), Contains("'/outside' is stored in another file"));
  CHECK(hdf5_names(path) == std::vector<std::string>{"/outside", "/t"});
}

TEST_CASE("load_hdf5: what is no HDF5 file", "[datasets]") {
  const TemporaryFolder folder;
  CHECK_THAT(read_refusal(folder.write("a.h5", "t,x\n0,1\n"), {"/t"}),
             Contains("a.h5: is truncated or damaged, or not an HDF5 file"));
  CHECK_THAT(read_refusal(folder.write("b.h5", ""), {"/t"}), Contains("b.h5: "));
  CHECK_THAT(read_refusal(folder.path() / "none.h5", {"/t"}), Contains("cannot be opened"));
  CHECK_THAT(message_when([&] {
               load_hdf5_record(folder.path(), {{"/t"}, ""});
             }),
             Contains("is a folder; expected an HDF5 file"));
  {
    const Hdf5Writer file(folder.path() / "data.bin");
    file.array("/t", {0, 1, 2});
  }
  CHECK(record_reader(folder.path() / "data.bin").name == "HDF5");
  CHECK(record_reader("x.HDF5").name == "HDF5");
}

TEST_CASE("load_hdf5: numbers are unpacked, and missing ones refused", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  {
    const Hdf5Writer file(path);
    for (const char* name : {"/x", "/lines", "/text", "/gone", "/lost", "/two"})
      file.array(name, {1, 2, 3, 4}, {}, H5T_STD_I16LE);
    file.number("/x", "scale_factor", 0.5);
    file.number("/x", "add_offset", -10);
    file.number("/x", "_FillValue", -32768);
    file.text("/text", "scale_factor", "0.5");
    file.number("/gone", "_FillValue", 3);
    file.number("/lost", "missing_value", 4);
    file.number("/lost", "scale_factor", 100);
    file.array("/single", {1, -999.9}, {}, H5T_IEEE_F32LE);
    file.number("/single", "missing_value", -999.9);
  }
  CHECK(read_columns(path, {"/x", "/lines"}) == Table{{-9.5, -9, -8.5, -8}, {1, 2, 3, 4}});
  CHECK_THAT(read_refusal(path, {"/text"}),
             Contains("the attribute 'scale_factor' of '/text' is not one finite number"));
  CHECK_THAT(read_refusal(path, {"/gone"}),
             Contains("row 3 of '/gone' is 3, which means a missing value"));
  CHECK_THAT(read_refusal(path, {"/lost"}), Contains("row 4 of '/lost' is 4, which means"));
  CHECK_THAT(read_refusal(path, {"/single"}), Contains("row 2 of '/single' is -999.9"));
}

TEST_CASE("load_hdf5: what was written in part only is refused", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  const double fill = 3.25;
  {
    const Hdf5Writer file(path);
    file.partly_written("/whole", {1, 2, 3, 4, 5}, 5, 2);
    file.partly_written("/half", {1, 2, 3}, 7, 2);
    file.partly_written("/end", {1, 2, 3, 4}, 5, 2);
    file.first_column("/m", {1, 2, 3}, 2);
    file.partly_written("/torn", {1, 2, 3}, 4, 4, &fill);
    file.partly_written("/zero", {1, 2, 3}, 4, 4);
  }
  CHECK(read_columns(path, {"/whole"}) == Table{{1, 2, 3, 4, 5}});
  CHECK_THAT(read_refusal(path, {"/half"}), Contains("rows 5 to 6 of '/half' were never written"));
  CHECK_THAT(read_refusal(path, {"/end"}), Contains("rows 5 to 5 of '/end' were never written"));
  CHECK(read_columns(path, {"/m(:,1)"}) == Table{{1, 2, 3}});
  CHECK_THAT(read_refusal(path, {"/m(:,2)"}), Contains("of '/m(:,2)' were never written"));
  CHECK_THAT(read_refusal(path, {"/torn"}), Contains("row 4 of '/torn' is 3.25, which means"));
  // A zero may be a real value.
  CHECK(read_columns(path, {"/zero"}) == Table{{1, 2, 3, 0}});
}

TEST_CASE("load_hdf5: how the columns are labelled", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/t", {0, 1, 2});
    file.array("/x", {1, 2, 3});
    file.array("/m", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.text("/x", "units", "psi");
    file.texts("/m", "units", {"bar", "mm"});
    file.number("/x", "dt", 0.5);
  }
  const auto table = record_reader(path).load(path, {{"t", "/x", "/m(:,2)", "/x@dt"}, "t"});
  REQUIRE(table.labels.size() == 4);
  CHECK(table.labels[3].unit == "s");
  CHECK(table.labels[0].unit.empty());
  CHECK(table.labels[1].name == "/x");
  CHECK(table.labels[1].unit == "psi");
  CHECK(table.labels[2].unit == "mm");
  CHECK_FALSE(table.labels[2].place.empty());
}
