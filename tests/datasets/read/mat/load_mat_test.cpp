#include "datasets/read/mat/load_mat.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/read/record_reader.hpp"
#include "datasets/synthetic/noise.hpp"
#include "tests/datasets/campaign_fixture.hpp"
#include "tests/datasets/hdf5_fixture.hpp"
#include "tests/datasets/mat_fixture.hpp"
#include "tests/datasets/reading.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::Contains;

namespace {

std::string message_of(const std::filesystem::path& path, const RecordRequest& request) {
  return message_when([&] { load_mat_record(path, request); });
}

/// Message when reading the column `name` from a file with these variables.
std::string message_of(const std::vector<matvar_t*>& variables, const std::string& name,
                       MatFormat format = MatFormat::v7) {
  const TemporaryFolder folder;
  write_mat(folder.path() / "a.mat", format, variables);
  return message_of(folder.path() / "a.mat", {{name}, ""});
}

std::string content_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A variable like those that Simulink's "To Workspace" writes as a "Structure With Time".
matvar_t* logged(const std::string& name) {
  return mat_struct(
      name, {{mat_array("time", Numbers{0.0, 0.1, 0.2}),
              mat_struct("signals", {{mat_array("values", Numbers{1.0, 2.0, 3.0}),
                                      mat_text("label", "position")},
                                     {mat_array("values", Numbers{1, 2, 3, 4, 5, 6}, {3, 2}),
                                      mat_text("label", "pressures")}}),
              mat_text("blockName", "rig/To Workspace")}});
}

/// An object as stored by MATLAB in version 5, following the documented layout: array flags of
/// class 17, then the name, "MCOS", the class name and a reference that only MATLAB can follow.
std::string opaque_variable() {
  const auto word = [](std::uint32_t value) {
    return std::string(reinterpret_cast<const char*>(&value), 4);
  };
  const auto element = [&](std::uint32_t type, std::string bytes) {
    const auto size = static_cast<std::uint32_t>(bytes.size());
    bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
    return word(type) + word(size) + bytes;
  };
  const std::string reference = element(
      14, element(6, word(13) + word(0)) + element(5, word(6) + word(1)) + element(1, "") +
              element(6, word(0xdd000000U) + word(2) + word(1) + word(1) + word(1) + word(1)));
  return element(14, element(6, word(17) + word(0)) + element(1, "ts") + element(1, "MCOS") +
                         element(1, "timeseries") + reference);
}

std::vector<std::string> columns_of(const std::filesystem::path& path) {
  std::vector<std::string> names;
  for (const RecordColumn& column : mat_record_columns(path)) names.push_back(column.name);
  return names;
}

/// Writes the header of version 7.3 into the first bytes of a file, as Python packages do.
void write_mat73_header(const std::filesystem::path& path) {
  std::string header = "MATLAB 7.3 MAT-file, Platform: CPython, Created on: Fri Nov 27 2026";
  header.resize(124, ' ');
  header += std::string("\x00\x02IM", 4);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.write(header.data(), static_cast<std::streamsize>(header.size()));
}

}  // namespace

TEST_CASE("load_mat: variables, fields and columns of a matrix", "[datasets]") {
  const auto format = GENERATE(MatFormat::v6, MatFormat::v7, MatFormat::v73);
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, format,
            {mat_array("t", Numbers{0.0, 0.5, 1.0}), mat_array("x", Numbers{1, 2, 3}, {1, 3}),
             mat_array("data", Numbers{1, 2, 3, 4, 5, 6}, {3, 2}),
             mat_array("deep", Numbers{7, 8, 9}, {1, 1, 3}),
             mat_array("wide", Numbers{1, 10, 2, 20, 3, 30}, {2, 1, 3}), logged("log")});
  const auto table =
      load_mat_record(path, {{"t", "x", "data(:,2)", "deep", "wide(2,1,:)", "log.time",
                              "log.signals(1).values", "log.signals(2).values(:,2)"},
                             "t"})
          .columns;
  CHECK(table[0] == Numbers{0.0, 0.5, 1.0});
  CHECK(table[1] == Numbers{1, 2, 3});
  CHECK(table[2] == Numbers{4, 5, 6});
  CHECK(table[3] == Numbers{7, 8, 9});
  CHECK(table[4] == Numbers{10, 20, 30});
  CHECK(table[5] == Numbers{0.0, 0.1, 0.2});
  CHECK(table[6] == Numbers{1, 2, 3});
  CHECK(table[7] == Numbers{4, 5, 6});
  auto columns = columns_of(path);
  std::sort(columns.begin(), columns.end());
  CHECK(columns == std::vector<std::string>{"data(:,1)", "data(:,2)", "deep",
                                            "log.signals(1).values", "log.signals(2).values(:,1)",
                                            "log.signals(2).values(:,2)", "log.time", "t", "x"});
}

TEST_CASE("load_mat: an element of a matrix of structs", "[datasets]") {
  const auto format = GENERATE(MatFormat::v7, MatFormat::v73);
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  const auto element = [](double value) {
    return std::vector<matvar_t*>{mat_array("x", Numbers{value})};
  };
  write_mat(path, format,
            {mat_struct("run", {element(11), element(21), element(12), element(22)}, {2, 2})});
  for (const int row : {1, 2}) {
    for (const int column : {1, 2}) {
      const auto table =
          load_mat_record(path, {{fmt::format("run({},{}).x", row, column)}, ""}).columns;
      CHECK(table[0] == Numbers{10.0 * row + column});
    }
  }
}

TEST_CASE("load_mat: 12 million numbers of one file, those of other columns counted",
          "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, MatFormat::v7, {mat_array("x", std::vector<std::int8_t>(100'000, 1))});
  std::vector<std::string> columns(120, "x");
  CHECK(load_mat_record(path, {columns, ""}).columns.size() == 120);
  columns.emplace_back("x");
  CHECK_THAT(message_of(path, {columns, ""}),
             Contains("'x' has 100000 elements; with the 12000000 of other columns"));
}

TEST_CASE("load_mat: every real number class", "[datasets]") {
  const auto format = GENERATE(MatFormat::v7, MatFormat::v73);
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, format,
            {mat_array("f", std::vector<float>{0.1F, -2.5F}),
             mat_array("i8", std::vector<std::int8_t>{-128, 127}),
             mat_array("u16", std::vector<std::uint16_t>{0, 65535}),
             mat_array("i64", std::vector<std::int64_t>{-9007199254740992, 3})});
  const auto table = load_mat_record(path, {{"f", "i8", "u16", "i64"}, ""}).columns;
  CHECK(table[0] == Numbers{static_cast<double>(0.1F), -2.5});
  CHECK(table[1] == Numbers{-128, 127});
  CHECK(table[2] == Numbers{0, 65535});
  CHECK(table[3] == Numbers{-9007199254740992.0, 3});
  CHECK_THAT(
      message_of({mat_array("big", std::vector<std::int64_t>{1, 9007199254740995})}, "big", format),
      Contains("element 2 of 'big' is 9007199254740995, more than a double can hold"));
}

TEST_CASE("load_mat: what is no column of numbers", "[datasets]") {
  const auto format = GENERATE(MatFormat::v7, MatFormat::v73);
  struct Case {
    std::string column;
    std::vector<std::string> parts;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Case> cases{
      {"posiion", {"unknown variable 'posiion'", "did you mean 'position'?"}},
      {"log.tim", {"'log'", "unknown field 'tim'", "did you mean 'time'?"}},
      {"log", {"'log' is a struct; expected real numbers"}},
      {"log.signals.values", {"'log.signals' is a struct of 1 x 2", "log.signals(1)"}},
      {"log.signals(3).values", {"'log.signals' is a struct of 1 x 2, which has no element 3"}},
      {"log.signals(2).values", {"has 3 x 2 elements", "log.signals(2).values(:,1)"}},
      {"log.signals(2).values(:,3)", {"is outside of 'values', which has 3 x 2"}},
      {"wide(:,1)", {"is outside of 'wide', which has 2 x 1 x 3"}},
      {"log.blockName", {"is text; expected real numbers"}},
      {"position.x", {"'position' is a number and has no field 'x'"}},
      {"hole", {"element 3 of 'hole' is nan; expected a finite number"}},
      {"edge", {"element 1 of 'edge' is -inf"}},
      {"position(:", {"'position(:' lacks a closing bracket"}},
      {"position(2)", {"does not name a whole row or column"}},
      {"log(:).time", {"selects all elements of 'log'"}},
      {"position(0,:)", {"has a subscript that is not a number from 1"}},
      {"position mm", {"continues with 'mm'"}},
      {".position", {"lacks the name of a variable"}}};
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, format,
            {mat_array("position", Numbers{1, 2, 3}), mat_array("hole", Numbers{1, 2, nan}),
             mat_array("edge", Numbers{-std::numeric_limits<double>::infinity(), 2}),
             mat_array("wide", Numbers{1, 2, 3, 4, 5, 6}, {2, 1, 3}), logged("log")});
  for (const Case& each : cases) {
    CAPTURE(each.column);
    const std::string message = message_of(path, {{each.column}, ""});
    CHECK_THAT(message, Contains("run.mat: "));
    for (const std::string& part : each.parts) CHECK_THAT(message, Contains(part));
  }
}

TEST_CASE("load_mat: complex, sparse, cell and empty variables", "[datasets]") {
  std::vector<double> re{1, 2};
  std::vector<double> im{0, 1};
  mat_complex_split_t parts{re.data(), im.data()};
  std::vector<std::size_t> dims{2, 1};
  CHECK_THAT(message_of({Mat_VarCreate("z", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dims.data(), &parts,
                                       MAT_F_COMPLEX)},
                        "z"),
             Contains("'z' is complex; expected real numbers"));
  std::vector<std::size_t> one{1, 1};
  matvar_t* content[]{mat_array("", Numbers{1, 2})};
  CHECK_THAT(message_of({Mat_VarCreate("c", MAT_C_CELL, MAT_T_CELL, 2, one.data(), content,
                                       MAT_F_DONT_COPY_DATA)},
                        "c"),
             Contains("'c' is a cell array"));
  std::vector<std::size_t> none{0, 0};
  CHECK_THAT(
      message_of({Mat_VarCreate("e", MAT_C_DOUBLE, MAT_T_DOUBLE, 2, none.data(), nullptr, 0)}, "e"),
      Contains("'e' is empty"));
}

TEST_CASE("load_mat: lengths that differ, and time that does not increase", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, MatFormat::v7,
            {mat_array("t", Numbers{0, 1, 2}), mat_array("x", Numbers{1, 2}),
             mat_array("back", Numbers{0, 1, 1})});
  CHECK_THAT(message_of(path, {{"t", "x"}, "t"}),
             Contains("'x' has 2 elements, but 't' has 3; expected the same number"));
  CHECK_THAT(message_of(path, {{"back", "t"}, "back"}),
             Contains("time 'back' does not increase: element 3 is 1 after 1"));
  CHECK_THROWS_AS(load_mat_record(path, {{"x"}, "t"}), std::invalid_argument);
}

TEST_CASE("load_mat: an object says how to save it", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, MatFormat::v6, {mat_array("t", Numbers{0, 1, 2})});
  std::ofstream(path, std::ios::binary | std::ios::app) << opaque_variable();
  CHECK_THAT(message_of(path, {{"ts"}, ""}),
             Contains("'ts' is an object") && Contains("a timeseries") && Contains("ts.Time"));
  CHECK(load_mat_record(path, {{"t"}, "t"}).columns[0] == Numbers{0, 1, 2});
  CHECK(columns_of(path) == std::vector<std::string>{"t"});

  // In version 7.3, an object is a reference whose class is not one of MATLAB's number classes.
  write_mat(path, MatFormat::v73,
            {mat_array("ts", std::vector<std::uint16_t>{1, 2, 3, 4, 5, 6}, {1, 6}),
             mat_array("t", Numbers{0, 1, 2})});
  std::string content = content_of(path);
  const std::size_t at = content.find("uint16");
  REQUIRE(at != std::string::npos);
  folder.write("object.mat", content.replace(at, 6, "string"));
  CHECK_THAT(message_of(folder.path() / "object.mat", {{"ts"}, ""}),
             Contains("'ts' is an object") && Contains("ts.Time"));
}

TEST_CASE("load_mat: a file of version 7.3 that Python wrote is read as HDF5", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  {
    const Hdf5Writer file(path, 512);
    file.array("/t", {0.0, 0.1, 0.2});
    file.array("/log/x", {1.5, 2.5, 3.5}, {1, 3});
    file.array("/p", {1, 2, 3, 4, 5, 6}, {3, 2});
    file.text("/log/x", "units", "mm");
  }
  write_mat73_header(path);
  REQUIRE(record_reader(path).name == "MAT");
  const std::vector<RecordColumn> columns = record_reader(path).columns(path);
  const auto x = std::find_if(columns.begin(), columns.end(),
                              [](const RecordColumn& column) { return column.name == "/log/x"; });
  REQUIRE(x != columns.end());
  CHECK(x->unit == "mm");
  CHECK(load_mat_record(path, {{"/t", "/log/x", "/p(:,2)"}, "/t"}).columns ==
        std::vector<Numbers>{{0.0, 0.1, 0.2}, {1.5, 2.5, 3.5}, {2, 4, 6}});
  CHECK(load_mat_record(path, {{"t"}, "t"}).columns == std::vector<Numbers>{{0.0, 0.1, 0.2}});
  CHECK_THAT(message_of(path, {{"/y"}, ""}), Contains("run.mat") && Contains("/y"));
}

TEST_CASE("load_mat: truncated anywhere, it is refused", "[datasets]") {
  const auto format = GENERATE(MatFormat::v6, MatFormat::v7, MatFormat::v73);
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  write_mat(path, format, {mat_array("t", Numbers(300, 1.0)), logged("log")});
  const std::string whole = content_of(path);
  const std::size_t step = whole.size() / 37;
  for (std::size_t bytes = 0; bytes < whole.size(); bytes += step) {
    CAPTURE(bytes, whole.size());
    const auto cut = folder.write("cut.mat", whole.substr(0, bytes));
    CHECK_THAT(message_of(cut, {{"log.time"}, ""}), Contains("cut.mat: "));
  }
  CHECK(message_of(path, {{"log.time"}, ""}) == "no error");
}

TEST_CASE("load_mat: damaged compressed data do not pass", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.mat";
  Numbers values(400);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(static_cast<double>(i));
  write_mat(path, MatFormat::v7, {mat_array("t", values)});
  const std::string whole = content_of(path);
  for (std::size_t at = 128; at < whole.size(); at += whole.size() / 61) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    CAPTURE(at);
    CHECK_THAT(message_of(folder.write("damaged.mat", damaged), {{"t"}, ""}),
               Contains("damaged.mat: "));
  }
}

TEST_CASE("load_mat: what is no MAT file", "[datasets]") {
  const TemporaryFolder folder;
  CHECK_THAT(message_of(folder.write("a.mat", std::string(400, 'x')), {{"t"}, ""}),
             Contains("is not a MAT file of version 5 or 7.3"));
  CHECK_THAT(message_of(folder.write("b.mat", ""), {{"t"}, ""}), Contains("is shorter than"));
  CHECK_THAT(message_of(folder.path() / "none.mat", {{"t"}, ""}), Contains("cannot be opened"));
  CHECK_THAT(message_of(folder.path(), {{"t"}, ""}), Contains("is a folder"));
  write_mat(folder.path() / "y.dat", MatFormat::v7, {mat_array("t", Numbers{1})});
  CHECK(record_reader(folder.path() / "y.dat").name == "MAT");
}

TEST_CASE("load_record: the same campaign as CSV and as MAT gives the same bits", "[datasets]") {
  const auto format = GENERATE(MatFormat::v6, MatFormat::v7, MatFormat::v73);
  const TemporaryFolder folder;
  auto stream = random_stream(3, {"same bits"});
  for (const std::string repeat : {"1", "2", "3"}) {
    Numbers t;
    Numbers u;
    Numbers x;
    std::string csv = "t_ms,log.u,log.x\n";
    for (int i = 0; i < 200; ++i) {
      t.push_back(i + 0.1);
      u.push_back(std::sin(0.1 * i));
      x.push_back(10.0 * std::sin(0.1 * i - 0.4) + normal(stream, 0.1));
      csv += fmt::format("{},{},{}\n", t.back(), u.back(), x.back());
    }
    folder.write("csv/run_" + repeat + ".csv", csv);
    write_mat(folder.path() / "mat" / ("run_" + repeat + ".mat"), format,
              {mat_array("t_ms", t), mat_struct("log", {{mat_array("u", u), mat_array("x", x)}})});
  }
  const auto record_of = [&](const std::string& kind) {
    std::string text = replaced(kExample, "records/sine_0.1Hz_33_*.csv", kind + "/run_*." + kind);
    text = replaced(text, R"("t_s", unit = "s")", R"("t_ms", unit = "ms")");
    text = replaced(replaced(text, "ref_mm", "log.u"), "x_mm\"", "log.x\"");
    const Campaign campaign = load_campaign(folder.write(kind + ".toml", text));
    return load_record(campaign, campaign.conditions[0]);
  };
  const Record csv = record_of("csv");
  const Record mat = record_of("mat");
  CHECK(csv.repeats == 3);
  CHECK(csv.time_s == mat.time_s);
  REQUIRE(csv.channels.size() == mat.channels.size());
  for (const auto& [channel, series] : csv.channels) {
    const Series& other = mat.channels.at(channel);
    CHECK(series.mean == other.mean);
    CHECK(series.count == other.count);
    // All repeats of a generated reference are equal, so it may have no sd.
    CHECK((series.pooled_sd == other.pooled_sd ||
           (std::isnan(series.pooled_sd) && std::isnan(other.pooled_sd))));
  }
}
