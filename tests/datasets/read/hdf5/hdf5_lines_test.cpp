#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

#include "datasets/read/hdf5/load_hdf5.hpp"
#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests which numbers belong to a column of an HDF5 file, and which files are refused.

namespace rigcal::test {
namespace {

using Catch::Contains;
using datasets::hdf5_record_columns;
using datasets::RecordColumn;

/// Returns 100 i + 10 j + k, with indices counted from 1.
double code(std::size_t i, std::size_t j, std::size_t k) {
  return static_cast<double>(100 * i + 10 * j + k);
}

/// Writes a dataset of shape `dims` whose cells are arrays of shape `cell`.
void write_cells(const Hdf5Writer& file, const char* path, const std::vector<hsize_t>& dims,
                 const std::vector<hsize_t>& cell, const std::vector<double>& values) {
  const hid_t array =
      H5Tarray_create2(H5T_IEEE_F64LE, static_cast<unsigned>(cell.size()), cell.data());
  const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
  const hid_t set =
      H5Dcreate2(file.file(), path, array, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  REQUIRE(H5Dwrite(set, array, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  H5Dclose(set);
  H5Sclose(space);
  H5Tclose(array);
}

void unwritten_of(const Hdf5Writer& file, const char* path, hid_t type) {
  file.unwritten(path, {3}, type);
  H5Tclose(type);
}

std::vector<std::string> names_in(const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const RecordColumn& column : hdf5_record_columns(path)) names.push_back(column.name);
  return names;
}

std::string unit_of(const std::filesystem::path& path, const std::string& name) {
  for (const RecordColumn& column : hdf5_record_columns(path))
    if (column.name == name) return column.unit;
  return "no such column";
}

}  // namespace

TEST_CASE("load_hdf5: every line of an array of three dimensions", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  constexpr std::size_t kI = 4;
  constexpr std::size_t kJ = 3;
  constexpr std::size_t kK = 2;
  {
    const Hdf5Writer file(path);
    std::vector<double> values;
    for (std::size_t i = 1; i <= kI; ++i)
      for (std::size_t j = 1; j <= kJ; ++j)
        for (std::size_t k = 1; k <= kK; ++k) values.push_back(code(i, j, k));
    // Writes the same numbers with none, one, two and all of the dimensions inside the cells.
    file.array("/plain", values, {kI, kJ, kK});
    write_cells(file, "/cell1", {kI, kJ}, {kK}, values);
    write_cells(file, "/cell2", {kI}, {kJ, kK}, values);
    const hsize_t shape[3] = {kI, kJ, kK};
    const hid_t block = H5Tarray_create2(H5T_IEEE_F64LE, 3, shape);
    const hid_t row = H5Tcreate(H5T_COMPOUND, 8 + H5Tget_size(block));
    H5Tinsert(row, "other", 0, H5T_IEEE_F64LE);
    H5Tinsert(row, "block", 8, block);
    values.insert(values.begin(), -1.0);
    const hsize_t one = 1;
    const hid_t space = H5Screate_simple(1, &one, nullptr);
    const hid_t set =
        H5Dcreate2(file.file(), "/table", row, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    REQUIRE(H5Dwrite(set, row, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    H5Dclose(set);
    H5Sclose(space);
    H5Tclose(row);
    H5Tclose(block);
  }
  for (const std::string name : {"/plain(", "/cell1(", "/cell2(", "/table.block(1,"}) {
    CAPTURE(name);
    const auto column = [&](const std::string& rest) {
      return read_columns(path, {name + rest})[0];
    };
    for (std::size_t i = 1; i <= kI; ++i) {
      for (std::size_t j = 1; j <= kJ; ++j)
        CHECK(column(fmt::format("{},{},:)", i, j)) == Numbers{code(i, j, 1), code(i, j, 2)});
      for (std::size_t k = 1; k <= kK; ++k)
        CHECK(column(fmt::format("{},:,{})", i, k)) ==
              Numbers{code(i, 1, k), code(i, 2, k), code(i, 3, k)});
    }
    for (std::size_t j = 1; j <= kJ; ++j)
      for (std::size_t k = 1; k <= kK; ++k)
        CHECK(column(fmt::format("{}:,{},{})", "", j, k)) ==
              Numbers{code(1, j, k), code(2, j, k), code(3, j, k), code(4, j, k)});
    for (const char* beyond : {"5,1,:)", "1,4,:)", ":,1,3)", ":,4,1)", "5,:,1)", "1,:,3)"}) {
      CAPTURE(beyond);
      CHECK_THAT(read_refusal(path, {name + beyond}), Contains("is outside of"));
    }
    CHECK_THAT(read_refusal(path, {name + ":)"}), Contains("entries between the brackets"));
    CHECK_THAT(read_refusal(path, {name + ":,1,1,1)"}), Contains("entries between the brackets"));
  }
  CHECK_THAT(
      read_refusal(path, {"/cell2"}),
      Contains("'/cell2' has 4 x 3 x 2 elements; expected a vector") && Contains("/cell2(:,1,1)"));
  CHECK(read_columns(path, {"/table.other"}) == Table{{-1}});
}

TEST_CASE("load_hdf5: what may stand between the brackets", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/m", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.array("/v", {7, 8, 9});
    file.array("/row", {7, 8, 9}, {1, 3});
    file.array("/thin", {7, 8, 9}, {1, 3, 1});
    file.array("/one", {5}, {1, 1});
  }
  for (const char* good : {"/m(:,2)", "/m( :,2)", "/m(:, 2 )", "m(:,2)", "/m(  :  ,  2  )"})
    CHECK(read_columns(path, {good}) == Table{{2, 4, 6}});
  CHECK(read_columns(path, {"/m(3,:)"}) == Table{{5, 6}});
  CHECK(read_columns(path, {"/v", "/v(:)", "/row", "/row(1,:)", "/thin", "/thin(1,:,1)"}) ==
        Table{{7, 8, 9}, {7, 8, 9}, {7, 8, 9}, {7, 8, 9}, {7, 8, 9}, {7, 8, 9}});
  CHECK(read_columns(path, {"/one"}) == Table{{5}});
  CHECK_THAT(read_refusal(path, {"/row(:,1)", "/m(1,:)"}),
             Contains("'/m(1,:)' has 2 rows, but '/row(:,1)' has 1"));
  CHECK_THAT(read_refusal(path, {"/m(1,:)", "/row(:,1)"}),
             Contains("'/row(:,1)' has 1 rows, but '/m(1,:)' has 2"));
  for (const char* bad :
       {"/m(:,-1)", "/m(:,1.5)", "/m(:,x)", "/m(:,)", "/m()", "/m(", "/m(:,2)x", "/m(::,2)",
        "/m(:,0)", "/m(0,:)", "/m(1,1)", "/m(:,:)", "/m(:,99999999999999999999)"}) {
    CAPTURE(bad);
    CHECK_THAT(read_refusal(path, {bad}), Contains("does not end in one row or column"));
  }
  CHECK_THAT(read_refusal(path, {"/m(4,:)"}), Contains("'/m(4,:)' is outside of '/m'"));
  CHECK_THAT(read_refusal(path, {"/m(:,3)"}), Contains("'/m(:,3)' is outside of '/m'"));
  CHECK_THAT(read_refusal(path, {"/m"}), Contains("such as /m(:,1)"));
}

TEST_CASE("load_hdf5: which columns a file offers", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/a single number", {5}, {1});
    file.array("/b square", {1, 2, 3, 4}, {2, 2});
    file.array("/c wide", {1, 2, 3, 4, 5, 6}, {2, 3});
    file.array("/d tall", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.array("/e deep", {1, 2, 3, 4, 5, 6, 7, 8}, {2, 2, 2});
    file.array("/f flat", {1, 2}, {1, 2, 1});
    file.array("/g\nline", {1, 2});
    file.array("/h\x7f", {1, 2});
  }
  CHECK(names_in(path) == std::vector<std::string>{"/b square(:,1)", "/b square(:,2)",
                                                   "/c wide(1,:)", "/c wide(2,:)", "/d tall(:,1)",
                                                   "/d tall(:,2)", "/f flat"});
  CHECK(hdf5_record_columns(path)[0].is_matrix_line);
  const auto many = folder / "many.h5";
  {
    const Hdf5Writer file(many);
    file.array("/columns", std::vector<double>(102 * 101, 1.0), {102, 101});
    file.array("/rows", std::vector<double>(100 * 102, 1.0), {100, 102});
  }
  const auto names = names_in(many);
  REQUIRE(names.size() == 200);
  CHECK(names[99] == "/columns(:,100)");
  CHECK(names[100] == "/rows(1,:)");
  CHECK(names[199] == "/rows(100,:)");
  CHECK(read_columns(many, {"/columns(:,101)"})[0].size() == 102);
}

TEST_CASE("load_hdf5: groups within groups, to a depth of 32", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  std::string deep;
  for (int i = 0; i < 31; ++i) deep += "/g";
  {
    const Hdf5Writer file(path);
    file.array(deep + "/x", {1, 2});
    file.array(deep + "/g/x", {3, 4});
  }
  CHECK(names_in(path) == std::vector<std::string>{deep + "/x"});
  CHECK(read_columns(path, {deep + "/x"}) == Table{{1, 2}});
}

TEST_CASE("load_hdf5: a dataset that is put together from other files is refused", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer other(folder / "other.h5");
    other.array("/x", {5, 6, 7});
    const Hdf5Writer file(path);
    file.array("/t", {0, 1, 2});
    const hsize_t three = 3;
    const hid_t space = H5Screate_simple(1, &three, nullptr);
    const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    REQUIRE(H5Pset_virtual(plan, space, (folder / "other.h5").c_str(), "/x", space) >= 0);
    H5Dclose(
        H5Dcreate2(file.file(), "/virtual", H5T_IEEE_F64LE, space, H5P_DEFAULT, plan, H5P_DEFAULT));
    H5Pclose(plan);
    H5Sclose(space);
  }
  CHECK_THAT(read_refusal(path, {"/virtual"}),
             Contains("'/virtual' is stored in another file; expected numbers in this one"));
  CHECK(read_columns(path, {"/t"}) == Table{{0, 1, 2}});
}

TEST_CASE("load_hdf5: a filter that is not built in is named", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer file(path);
    const hsize_t two = 2;
    const hid_t space = H5Screate_simple(1, &two, nullptr);
    const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(plan, 1, &two);
    H5Pset_deflate(plan, 6);
    REQUIRE(H5Pset_filter(plan, 32001, H5Z_FLAG_OPTIONAL, 0, nullptr) >= 0);
    const hid_t set =
        H5Dcreate2(file.file(), "/x", H5T_IEEE_F64LE, space, H5P_DEFAULT, plan, H5P_DEFAULT);
    REQUIRE(set >= 0);
    const double values[2] = {1, 2};
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(set);
    H5Pclose(plan);
    H5Sclose(space);
    file.array("/gzip", {1, 2, 3, 4}, {}, H5T_IEEE_F64LE, true);
  }
  CHECK_THAT(read_refusal(path, {"/x"}), Contains("'/x' is compressed by the filter 32001"));
  CHECK(read_columns(path, {"/gzip"}) == Table{{1, 2, 3, 4}});
}

TEST_CASE("load_hdf5: what is no number is named by its kind", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer file(path);
    const double item = 0.0;
    unwritten_of(file, "/lists", H5Tvlen_create(H5T_IEEE_F64LE));
    unwritten_of(file, "/bits", H5Tcopy(H5T_STD_B8LE));
    unwritten_of(file, "/blob", H5Tcreate(H5T_OPAQUE, 4));
    const hid_t inner = H5Tcreate(H5T_COMPOUND, 8);
    H5Tinsert(inner, "x", 0, H5T_IEEE_F64LE);
    const hid_t outer = H5Tcreate(H5T_COMPOUND, 16);
    H5Tinsert(outer, "inner", 0, inner);
    H5Tinsert(outer, "x", 8, H5T_IEEE_F64LE);
    unwritten_of(file, "/tables", outer);
    H5Tclose(inner);
    const hid_t null = H5Screate(H5S_NULL);
    H5Dclose(H5Dcreate2(file.file(), "/null", H5T_IEEE_F64LE, null, H5P_DEFAULT, H5P_DEFAULT,
                        H5P_DEFAULT));
    H5Sclose(null);
    const hid_t scalar = H5Screate(H5S_SCALAR);
    const hid_t set = H5Dcreate2(file.file(), "/scalar", H5T_IEEE_F64LE, scalar, H5P_DEFAULT,
                                 H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &item);
    H5Dclose(set);
    H5Sclose(scalar);
    file.array("/nothing", {}, {3, 0});
  }
  const auto refusal = [&](const char* column) { return read_refusal(path, {column}); };
  CHECK_THAT(refusal("/lists"), Contains("'/lists' is a list of lists"));
  CHECK_THAT(refusal("/bits"), Contains("'/bits' is a field of bits"));
  CHECK_THAT(refusal("/blob"), Contains("'/blob' is of a type that is not numeric"));
  CHECK_THAT(refusal("/tables.inner"), Contains("'/tables.inner' is a table within a table"));
  CHECK_THAT(refusal("/tables"), Contains("'/tables' is a table; expected one of its columns"));
  CHECK_THAT(refusal("/null"), Contains("'/null' is empty"));
  CHECK_THAT(refusal("/nothing(:,1)"), Contains("'/nothing(:,1)' is empty"));
  CHECK(read_columns(path, {"/scalar"}) == Table{{0}});
}

TEST_CASE("load_hdf5: integers up to what a double holds exactly", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  constexpr long long kMost = 9007199254740992;
  {
    const Hdf5Writer file(path);
    file.integers("/most", {kMost, -kMost, 1 - kMost});
    file.integers("/above", {1, 2, kMost + 1});
    file.integers("/below", {-kMost - 1});
    file.integers("/unsigned", {kMost}, H5T_STD_U64BE);
    file.integers("/unsigned above", {kMost + 1}, H5T_STD_U64BE);
  }
  CHECK(read_columns(path, {"/most"}) ==
        Table{{9007199254740992.0, -9007199254740992.0, -9007199254740991.0}});
  CHECK(read_columns(path, {"/unsigned"}) == Table{{9007199254740992.0}});
  CHECK_THAT(read_refusal(path, {"/above"}),
             Contains("row 3 of '/above' is 9007199254740993, more"));
  CHECK_THAT(read_refusal(path, {"/below"}),
             Contains("row 1 of '/below' is -9007199254740993, more"));
  CHECK_THAT(read_refusal(path, {"/unsigned above"}),
             Contains("row 1 of '/unsigned above' is 9007199254740993"));
}

TEST_CASE("load_hdf5: 12 million numbers of one file, those of other columns counted",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer file(path);
    file.array("/x", std::vector<double>(100'000, 1.0));
    file.number("/x", "dt", 0.5);
    // There are 7000 cells with 2000 numbers each, all unwritten.
    const hsize_t width = 2000;
    const hsize_t rows = 7000;
    const hid_t array = H5Tarray_create2(H5T_IEEE_F64LE, 1, &width);
    const hid_t space = H5Screate_simple(1, &rows, nullptr);
    const hid_t plan = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_alloc_time(plan, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(plan, H5D_FILL_TIME_NEVER);
    H5Dclose(H5Dcreate2(file.file(), "/wide", array, space, H5P_DEFAULT, plan, H5P_DEFAULT));
    H5Pclose(plan);
    H5Sclose(space);
    H5Tclose(array);
  }
  std::vector<std::string> columns(119, "/x");
  columns.emplace_back("/x@dt");
  const Table most = read_columns(path, columns);
  CHECK(most.back().back() == 0.5 * 99'999);
  columns.emplace_back("/x");
  CHECK_THAT(read_refusal(path, columns),
             Contains("'/x@dt' has 100000 samples, more than 12000000 numbers in all"));
  columns.assign(121, "/x");
  CHECK_THAT(read_refusal(path, columns),
             Contains("'/x' has 100000 rows; with the 12000000 numbers of other columns"));
  CHECK_THAT(read_refusal(path, {"/wide(:,1)"}),
             Contains("'/wide(:,1)' has arrays of 2000 numbers each, 7000 of them: more than "
                      "12000000 numbers in total"));
}

TEST_CASE("load_hdf5: units by any of their attributes, the first that holds a text",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  {
    const Hdf5Writer file(path);
    for (const char* name : {"unit", "units", "Unit", "Units", "unit_string"}) {
      const std::string dataset = std::string("/") + name;
      file.array(dataset, {1, 2, 3});
      file.text(dataset, name, "mm");
    }
    file.array("/both", {1, 2, 3});
    file.text("/both", "units", "s");
    file.text("/both", "unit", "ms");
    file.array("/number first", {1, 2, 3});
    file.number("/number first", "unit", 3.0);
    file.text("/number first", "units", "bar");
    file.array("/other name", {1, 2, 3});
    file.text("/other name", "uni", "bar");
    file.array("/longest", {1, 2, 3});
    file.text("/longest", "unit", std::string(40, 'm'));
    file.array("/too long", {1, 2, 3});
    file.text("/too long", "unit", std::string(41, 'm'));
    file.array("/blanks", {1, 2, 3});
    file.text("/blanks", "unit", "\t mm \t");
    file.array("/padded", {1, 2, 3});
    file.text("/padded", "unit", std::string("kN\0\0\0", 5), false);
    file.array("/deleted", {1, 2, 3});
    file.text("/deleted", "unit", "m\x7fm");
    file.array("/matrix", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.text("/matrix", "unit", "V");
    file.array("/three", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.texts("/three", "unit", {"V", "A", "W"});
    file.array("/in rows", {1, 2, 3, 4, 5, 6}, {2, 3});
    file.texts("/in rows", "unit", {"V", "A"});
    file.table("/table", {{"t", {0, 1, 2}}, {"u", {4, 5, 6}}});
    file.text("/table", "units", "ms");  // names no column, so it has no effect
  }
  for (const char* name : {"/unit", "/units", "/Unit", "/Units", "/unit_string"})
    CHECK(unit_of(path, name) == "mm");
  CHECK(unit_of(path, "/both") == "ms");
  CHECK(unit_of(path, "/number first") == "bar");
  CHECK(unit_of(path, "/other name") == "");
  CHECK(unit_of(path, "/longest") == std::string(40, 'm'));
  CHECK(unit_of(path, "/too long") == "");
  CHECK(unit_of(path, "/blanks") == "mm");
  CHECK(unit_of(path, "/padded") == "kN");
  CHECK(unit_of(path, "/deleted") == "");
  CHECK(unit_of(path, "/matrix(:,1)") == "V");
  CHECK(unit_of(path, "/matrix(:,2)") == "V");
  CHECK(unit_of(path, "/three(:,1)") == "");
  CHECK(unit_of(path, "/in rows(1,:)") == "V");
  CHECK(unit_of(path, "/in rows(2,:)") == "A");
  CHECK(unit_of(path, "/table.t") == "");
}

TEST_CASE("load_hdf5: intervals and rates of samples by their attributes", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder / "run.h5";
  const std::vector<std::string> intervals{"wf_increment", "dt", "sample_interval"};
  const std::vector<std::string> rates{"sample_rate", "sampling_rate", "sampling_frequency", "fs"};
  {
    const Hdf5Writer file(path);
    for (const auto& names : {intervals, rates}) {
      for (const std::string& name : names) {
        file.array("/" + name, {5, 6, 7});
        file.number("/" + name, name, 4.0);
        file.number("/" + name, "wf_start_offset", 10.0);
      }
    }
    file.array("/bad", {5, 6, 7});
    file.number("/bad", "dt", -1.0);
    file.number("/bad", "fs", std::numeric_limits<double>::quiet_NaN());
    file.number("/bad", "sample_rate", std::numeric_limits<double>::infinity());
    file.text("/bad", "wf_increment", "0.5");
    file.array("/matrix", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.number("/matrix", "dt", 0.5);
    file.number("/", "dt", 0.25);
  }
  for (const std::string& name : intervals)
    CHECK(read_columns(path, {"/" + name + "@" + name}) == Table{{10, 14, 18}});
  // A start offset is used only together with an interval.
  for (const std::string& name : rates)
    CHECK(read_columns(path, {"/" + name + "@" + name}) == Table{{0, 0.25, 0.5}});
  for (const char* none :
       {"/bad@dt", "/bad@fs", "/bad@sample_rate", "/bad@wf_increment", "/matrix@dt", "/dt@fs"})
    CHECK_THAT(read_refusal(path, {none}), Contains("unknown dataset"));
  CHECK(read_columns(path, {"@dt", "/bad"}) == Table{{0, 0.25, 0.5}, {5, 6, 7}});
}

TEST_CASE("load_hdf5: a file without numbers says what is expected", "[datasets]") {
  const TemporaryFolder folder;
  {
    const Hdf5Writer file(folder / "run.h5");
    const hid_t text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, 4);
    unwritten_of(file, "/text", text);
    file.number("/", "dt", 0.25);
  }
  CHECK_THAT(read_refusal(folder / "run.h5", {"/x"}),
             Contains("contains no numbers; expected datasets"));
  CHECK(hdf5_record_columns(folder / "run.h5").empty());
}

TEST_CASE("is_hdf5_file: by name, or by the signature where it may stand", "[datasets]") {
  const std::string signature("\x89HDF\r\n\x1a\n", 8);
  CHECK(datasets::is_hdf5_file({".h5", ""}));
  CHECK(datasets::is_hdf5_file({".hdf5", ""}));
  CHECK_FALSE(datasets::is_hdf5_file({".mat", ""}));
  for (const std::size_t at : {0U, 512U, 1024U, 2048U}) {
    CAPTURE(at);
    CHECK(datasets::is_hdf5_file({".dat", std::string(at, 'x') + signature}));
    CHECK_FALSE(datasets::is_hdf5_file({".dat", std::string(at, 'x') + signature.substr(0, 7)}));
  }
  for (const std::size_t at : {1U, 256U, 511U, 513U, 1536U, 4000U})
    CHECK_FALSE(datasets::is_hdf5_file({".dat", std::string(at, 'x') + signature}));
}

}  // namespace rigcal::test
