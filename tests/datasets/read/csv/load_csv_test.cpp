#include "datasets/read/csv/load_csv.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/read/csv/csv_lines.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fs = std::filesystem;
using Catch::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using rigcal::InputError;
using rigcal::datasets::CsvLines;
using rigcal::datasets::load_csv_record;
using rigcal::datasets::RecordRequest;
using rigcal::datasets::RecordTable;
using NumberColumns = std::vector<std::vector<double>>;

namespace {

/// A separate file for each test, removed at the end.
class File {
 public:
  explicit File(const std::string& content) { folder_.write("a.csv", content); }
  fs::path path() const { return folder_ / "a.csv"; }
  fs::path folder() const { return folder_.path(); }

 private:
  rigcal::test::TemporaryFolder folder_;
};

RecordRequest request(std::vector<std::string> columns, const std::string& time = "") {
  RecordRequest result;
  result.columns = std::move(columns);
  result.time_column = time;
  return result;
}

RecordTable load(const std::string& content,
                 const RecordRequest& wanted = request({"t", "x"}, "t")) {
  return load_csv_record(File(content).path(), wanted);
}

/// Error message on reading a file, from the name of the file on: "a.csv:2:3: ...".
std::string refusal_of(const fs::path& path, const RecordRequest& wanted) {
  try {
    load_csv_record(path, wanted);
  } catch (const InputError& error) {
    CHECK(error.code() == rigcal::ExitCode::bad_input);
    const std::string message = error.what();
    const std::string folder = path.parent_path().string() + "/";
    CHECK_THAT(message, StartsWith(folder));
    return message.substr(folder.size());
  }
  return "no error";
}

std::string refusal(const std::string& content,
                    const RecordRequest& wanted = request({"t", "x"}, "t")) {
  return refusal_of(File(content).path(), wanted);
}

}  // namespace

// ---- What is accepted ----------------------------------------------------------------------

TEST_CASE("load_csv: wanted columns in the wanted order", "[datasets]") {
  const RecordTable table = load("t,u,x\n0,text,1.5\n0.1,,-2e-3\n", request({"x", "t"}, "t"));
  CHECK(table.columns == NumberColumns{{1.5, -2e-3}, {0.0, 0.1}});
}

TEST_CASE("load_csv: one column may be wanted twice", "[datasets]") {
  CHECK(load("t,x\n0,1\n1,2\n", request({"x", "t", "x"}, "t")).columns ==
        NumberColumns{{1, 2}, {0, 1}, {1, 2}});
}

TEST_CASE("load_csv: numbers are read to the last digit", "[datasets]") {
  const RecordTable table =
      load("x\n0.1\n1e-300\n+5\n.5\n5.\n-0\n1.7976931348623157e308\n0.30000000000000004\n 7 \n",
           request({"x"}));
  CHECK(table.columns.front() == std::vector<double>{0.1, 1e-300, 5, 0.5, 5, 0,
                                                     1.7976931348623157e308, 0.30000000000000004,
                                                     7});
}

TEST_CASE("load_csv: separators are found by themselves", "[datasets]") {
  const NumberColumns expected{{0, 1}, {1.5, 2.5}};
  CHECK(load("t,x\n0,1.5\n1,2.5\n").columns == expected);
  CHECK(load("t;x\n0;1.5\n1;2.5\n").columns == expected);
  CHECK(load("t\tx\n0\t1.5\n1\t2.5\n").columns == expected);
  CHECK(load("t , x\n0 , 1.5\n1 , 2.5 \n").columns == expected);
  CHECK(load("t;x [m,abs]\n0;1.5\n1;2.5\n").columns == expected);
  CHECK(load("\"t\";\"a, b\";x\n0;0;1.5\n1;0;2.5\n").columns == expected);
}

TEST_CASE("load_csv: a given separator counts", "[datasets]") {
  RecordRequest wanted = request({"t;s", "x"});
  wanted.separator = ',';
  CHECK(load("t;s,x\n0,1.5\n", wanted).columns == NumberColumns{{0}, {1.5}});
  wanted.separator = '|';
  CHECK_THAT(refusal("t|x\n0|1\n", wanted), Contains("'|' cannot separate") && Contains("tab"));
}

TEST_CASE("load_csv: decimal commas where the separator allows them", "[datasets]") {
  const NumberColumns expected{{0, 0.5}, {-1.5, 2e-3}};
  CHECK(load("t;x\n0,0;-1,5\n0,5;2,0e-3\n").columns == expected);
  CHECK(load("t\tx\n0,0\t-1,5\n0,5\t2,0e-3\n").columns == expected);
  CHECK(load("t;x\n0.0;-1.5\n0.5;2.0e-3\n").columns == expected);
}

TEST_CASE("load_csv: units behind names", "[datasets]") {
  const NumberColumns expected{{0}, {1}};
  const std::string header =
      GENERATE("t [s],x [mm]", "t (s),x (mm)", "t[s],x(mm)", "\"t [s]\",\"x (m/(s Pa))\"");
  CAPTURE(header);
  CHECK(load(header + "\n0,1\n").columns == expected);
  CHECK_THAT(refusal(header + "\n0,1\n", request({"speed"})), Contains("(known: t, x)"));
}

TEST_CASE("load_csv: names with units tell columns of one name apart", "[datasets]") {
  const std::string text = "p (A),p (B)\n1,2\n";
  CHECK(load(text, request({"p (B)", "p (A)"})).columns == NumberColumns{{2}, {1}});
  CHECK_THAT(refusal(text, request({"speed"})), Contains("(known: p (A), p (B))"));
  CHECK_THAT(refusal(text, request({"p"})),
             StartsWith("a.csv:1: ") && Contains("columns 1 and 2 are both named 'p'"));
}

TEST_CASE("load_csv: quoted header, and quoted text in columns that are not wanted", "[datasets]") {
  CHECK(load("\"t\",\"x \"\"raw\"\" [mm]\",note\n0,1,\"a, b\"\n", request({"t", "x \"raw\""}))
            .columns == NumberColumns{{0}, {1}});
  CHECK(load("t,x,note\n0,1,5\" pipe\n").columns ==
        NumberColumns{{0}, {1}});  // quote inside a field
}

TEST_CASE("load_csv: numbers between quotes", "[datasets]") {
  CHECK(load("\"t\",\"x\"\n\"0\",\"1.5\"\n\"0.1\",\" -2.5e-1\"\n").columns ==
        NumberColumns{{0, 0.1}, {1.5, -0.25}});
  CHECK(load("t;x\n\"0,5\";\"1,5\"\n").columns == NumberColumns{{0.5}, {1.5}});
  CHECK_THAT(refusal("t,x\n0,\"1,234.5\"\n"),
             StartsWith("a.csv:2:3: '\"1,234.5\"' in column 'x' is not a finite number"));
  CHECK_THAT(refusal("t,x\n0,\"\"\n"), StartsWith("a.csv:2:"));
}

TEST_CASE("load_csv: decimal commas between quotes, where commas separate", "[datasets]") {
  const NumberColumns expected{{0, 0.5}, {1.5, -2.25}};
  CHECK(load("\"t\",\"x\"\n\"0,000\",\"1,5\"\n\"0,500\",\"-2,25\"\n").columns == expected);
  CHECK(load("t,x\n0,\"1,5\"\n\"0,5\",\"-2,25\"\n").columns == expected);
  // "1,234" may be a thousand, and a decimal point means that it is.
  CHECK_THAT(refusal("t,x\n0,\"1,234\"\n1,\"-12,500\"\n"),
             StartsWith("a.csv:2") && Contains("between thousands"));
  CHECK(load("t,x\n0,\"1,234\"\n1,\"0,500\"\n").columns == NumberColumns{{0, 1}, {1.234, 0.5}});
  CHECK_THAT(refusal("t,x\n0.5,1.5\n0.75,2.5\n1,\"1,23\"\n"),
             Contains("a.csv:4:3: '\"1,23\"' has a decimal comma, but line 2"));
}

TEST_CASE("load_csv: exponents of Fortran", "[datasets]") {
  CHECK(load("t,x\n0.0D+00,1.5D-03\n1.d0,-2D2\n").columns == NumberColumns{{0, 1}, {1.5e-3, -200}});
  CHECK_THAT(refusal("t,x\n0,1\n1,D2\n"), StartsWith("a.csv:3:3: 'D2' in column 'x'"));
  CHECK_THAT(refusal("t,x\n0,1\n1,1D2D\n"), StartsWith("a.csv:3:3: '1D2D' in column 'x'"));
}

TEST_CASE("load_csv: rows that end with a separator where the header does not", "[datasets]") {
  CHECK(load("t,x\n0,1,\n1,2,\n").columns == NumberColumns{{0, 1}, {1, 2}});
  CHECK(load("t;x\n0;1,5;\n1;2;\n").columns == NumberColumns{{0, 1}, {1.5, 2}});
  CHECK_THAT(refusal("t,x\n0,1,\n1,2,3\n"), StartsWith("a.csv:3:5: 3 columns; expected 2"));
}

TEST_CASE("load_csv: a second header begins another recording", "[datasets]") {
  CHECK_THAT(refusal("t,x\n0,1\n1,2\nt,x\n0,1\n"),
             StartsWith("a.csv:4:1: the header occurs again"));
}

TEST_CASE("load_csv: a header on each page of one recording", "[datasets]") {
  const RecordTable pages = load("t,x\n0,1\n1,2\n\nt,x\n2,3\nt,x\n3,4\n");
  CHECK(pages.columns == NumberColumns{{0, 1, 2, 3}, {1, 2, 3, 4}});
  CHECK_THAT(pages.warning, Contains("a.csv:5: the header occurs again, 2 times in all"));

  const std::string blocks = "MTS793\n\nTimed\nt,x\ns,mm\n0,1\n1,2\n\nTimed\nt,x\ns,mm\n2,3\n3,4\n";
  CHECK(load(blocks).columns == NumberColumns{{0, 1, 2, 3}, {1, 2, 3, 4}});
  std::string other = blocks;
  other.replace(other.rfind("s,mm"), 4, "s,um");
  CHECK_THAT(refusal(other),
             StartsWith("a.csv:11:1: the header occurs again, but the row below it"));
}

TEST_CASE("load_csv: text behind the last row", "[datasets]") {
  const RecordTable table = load("t,x\n0,1\n1,2\n\nEnd of file\nMax,7\n");
  CHECK(table.columns == NumberColumns{{0, 1}, {1, 2}});
  CHECK_THAT(table.warning, Contains("a.csv:5: not read: 'End of file'"));
  CHECK_THAT(refusal("t,x\n0,1\nstopped\n1,2\n"),
             StartsWith("a.csv:3:1: 'stopped' inside the data, which continue in line 4"));
  // A row that was cut off is no text.
  CHECK_THAT(refusal("t,x\n0,1\n1\n"), StartsWith("a.csv:3:2: 1 columns; expected 2"));
}

TEST_CASE("load_csv: a time before each value", "[datasets]") {
  CHECK(load("t,x,t,y\n0,1,0,2\n1,3,1,4\n", request({"t", "x", "y"}, "t")).columns ==
        NumberColumns{{0, 1}, {1, 3}, {2, 4}});
  const std::string slow = "t,x,t,y\n0,1,0,2\n1,3,2,4\n";
  CHECK_THAT(
      refusal(slow, request({"t", "x", "y"}, "t")),
      StartsWith("a.csv:3:5: the time of 'y' is '2', that of 'x' is '1'; expected the same"));
  // Times of columns that are not wanted do not matter.
  CHECK(load(slow, request({"t", "x"}, "t")).columns == NumberColumns{{0, 1}, {1, 3}});
}

TEST_CASE("load_csv: dates whose order is assumed are told", "[datasets]") {
  const RecordTable table = load("t,x\n01/02/2024 23:59:59,1\n02/02/2024 00:00:00,2\n");
  CHECK(table.columns == NumberColumns{{0, 1}, {1, 2}});
  CHECK_THAT(table.warning, Contains("the day is assumed to be first"));
  CHECK(load("t,x\n2024-02-01 23:59:59,1\n2024-02-02 00:00:00,2\n").warning.empty());
}

TEST_CASE("load_csv: comments before the header", "[datasets]") {
  const RecordTable table = load("# rig 3; day 2\n  # more\nt,x\n0,1\n");
  CHECK(table.columns == NumberColumns{{0}, {1}});
}

TEST_CASE("load_csv: line ends, byte-order mark, end of file", "[datasets]") {
  const NumberColumns expected{{0, 1}, {1, 2}};
  CHECK(load("t,x\r\n0,1\r\n1,2\r\n").columns == expected);
  CHECK(load("\xEF\xBB\xBFt,x\n0,1\n1,2\n").columns == expected);
  CHECK(load("t,x\n0,1\n1,2").columns == expected);
  CHECK(load("t,x\r\n0,1\r\n1,2\r\n\r\n  \n\n").columns == expected);
}

TEST_CASE("load_csv: header in Latin-1", "[datasets]") {
  CHECK(load("t,\xD6ldruck [bar]\n0,1\n", request({"Öldruck"})).columns == NumberColumns{{1}});
}

TEST_CASE("load_csv: an error names columns without their units", "[datasets]") {
  CHECK_THAT(refusal("# c\nt [s];x;;y (m)\n0;1;2;3\n", request({"speed"})),
             Contains("(known: t, x, , y)"));
  RecordRequest by_comma = request({"speed"});
  by_comma.separator = ',';
  CHECK_THAT(refusal("a;b,c\n0;1,2\n", by_comma), Contains("(known: a;b, c)"));
}

// ---- What is refused -----------------------------------------------------------------------

TEST_CASE("load_csv: fields that are not numbers", "[datasets]") {
  const std::string field = GENERATE("abc", "nan", "inf", "-inf", "1.5x", "1.2.3", "0x10", "1 2",
                                     "1e999", "--1", "+-1", "12:00:01", "1'000");
  CAPTURE(field);
  CHECK_THAT(refusal("t,x\n0,1\n1, " + field + "\n"),
             StartsWith("a.csv:3:4: '" + field + "' in column 'x' is not a finite number") &&
                 Contains("expected"));
}

TEST_CASE("load_csv: decimal commas that are none", "[datasets]") {
  const std::string field = GENERATE("1.234,5", "1,234,5", ",", "1,5x");
  CAPTURE(field);
  CHECK_THAT(refusal("t;x\n0;1\n1;" + field + "\n"),
             StartsWith("a.csv:3:3: '" + field + "' in column 'x' is not a finite number"));
}

TEST_CASE("load_csv: an empty field is no zero", "[datasets]") {
  CHECK_THAT(refusal("t,x,y\n0,1,2\n1,,2\n"), StartsWith("a.csv:3:3: column 'x' is empty"));
  CHECK_THAT(refusal("t,x\n0,1\n1,\n"), StartsWith("a.csv:3:3: column 'x' is empty"));
}

TEST_CASE("load_csv: the column in messages counts characters", "[datasets]") {
  CHECK_THAT(refusal("note,t,x\n0,0,1\n\xC3\xB6\xE2\x82\xAC,1,bad\n"), StartsWith("a.csv:3:6: "));
}

TEST_CASE("load_csv: decimal comma with ',' as separator", "[datasets]") {
  CHECK_THAT(refusal("t,x\n0,0,1,5\n"),
             StartsWith("a.csv:2:5: 4 columns; expected 2 as in the header (line 1)") &&
                 Contains("decimal commas are a likely cause"));
  // The number of columns is the real fault, although one field is wrong, too.
  CHECK_THAT(refusal("t,x\n0,a,1,5\n"), Contains("decimal commas are a likely cause"));
}

TEST_CASE("load_csv: wrong count of columns", "[datasets]") {
  CHECK_THAT(refusal("t,x,y\n0,1,2\n1,2\n"),
             StartsWith("a.csv:3:4: 2 columns; expected 3") && !Contains("decimal"));
  CHECK_THAT(refusal("t;x\n0;1\n1;2;3\n"),
             StartsWith("a.csv:3:5: 3 columns; expected 2") && !Contains("decimal"));
  CHECK_THAT(refusal("t,x\n0,1\n1,2,\n"),
             StartsWith("a.csv:3:5: ") && Contains("the line ends with a separator"));
  CHECK_THAT(refusal("t,x\n0,1\n# end of record\n"),
             StartsWith("a.csv:3:") && Contains("comments are accepted before the header only"));
}

TEST_CASE("load_csv: missing column", "[datasets]") {
  const std::string message = refusal("# c\nt [s],x_mm,u\n0,1,2\n", request({"t", "xmm"}));
  CHECK(message == "a.csv:2: unknown column 'xmm'; did you mean 'x_mm'? (known: t, x_mm, u)");
  CHECK_THAT(refusal("t|x\n0|1\n"), Contains("(known: t|x)") && Contains("separator"));
}

TEST_CASE("load_csv: duplicate names matter where they are wanted", "[datasets]") {
  const std::string text = "t,x,y,x\n0,1,2,3\n";
  CHECK_THAT(refusal(text), StartsWith("a.csv:1: columns 2 and 4 are both named 'x'"));
  CHECK(load(text, request({"t", "y"}, "t")).columns == NumberColumns{{0}, {2}});
}

TEST_CASE("load_csv: a second header line that is none of units", "[datasets]") {
  CHECK_THAT(refusal("t,x\ntime,travel\n0,a\n"),
             StartsWith("a.csv:2:1: the first row has no numbers ('time' in column 't')") &&
                 Contains("x [mm]"));
  CHECK(load("t,x\n[s],\n0,1\n").columns == NumberColumns{{0}, {1}});
}

TEST_CASE("load_csv: numbers where the header should be", "[datasets]") {
  CHECK_THAT(refusal("0,1\n1,2\n"), StartsWith("a.csv:1:1: contains numbers; expected the header"));
  CHECK_THAT(refusal("# a rig\n0,1\n"), StartsWith("a.csv:2:1: ") && Contains("'#'"));
}

TEST_CASE("load_csv: rows without a number are left out on request only", "[datasets]") {
  const std::string text = "t,x,y\n0,1,2\n0.1,NaN,3\n0.2,,4\n0.3,4,5\n0.4,ok,6\n";
  CHECK_THAT(refusal(text), StartsWith("a.csv:3:5: 'NaN' in column 'x'"));
  auto tolerant = request({"t", "x", "y"}, "t");
  tolerant.leaves_out_rows = true;
  const RecordTable table = load(text, tolerant);
  CHECK(table.columns == NumberColumns{{0, 0.3}, {1, 4}, {2, 5}});
  CHECK(table.left_out == "3 rows without a number: line 3 has 'NaN' in column 'x'");
  // Only a number may be missing.
  CHECK_THROWS_WITH(load("t,x,y\n0,1,2\n0.1,2\n", tolerant), Contains("2 columns; expected 3"));
  CHECK_THROWS_WITH(load("t,x,y\ntime,travel,y\n0,a,2\n", tolerant),
                    Contains("the first row has no numbers"));
  CHECK(load("t,x,y\n0,1,2\n", tolerant).left_out.empty());
  CHECK_THROWS_WITH(load("t,x,y\n0,a,2\n1,b,2\n", tolerant),
                    Contains("no row has a number in every column: line 2 has 'a' in column 'x'"));
}

TEST_CASE("load_csv: a clock as time is in seconds since its first stamp", "[datasets]") {
  const std::string text =
      "x;clock\n1,5;2024-02-29 23:59:59.500\n2,5;2024-03-01 00:00:00.000\n3,5;2024-03-01 "
      "00:00:01.25\n";
  const RecordTable table = load(text, request({"clock", "x"}, "clock"));
  CHECK(table.columns == NumberColumns{{0, 0.5, 1.75}, {1.5, 2.5, 3.5}});
  CHECK(table.labels[0].unit == "s");
  CHECK(table.labels[0].place == "time stamps");
  // Loggers of other countries; the units may be below the names.
  for (const char* clock :
       {"28.11.2024 9:12:44,5;0\n28.11.2024 9:12:45,0;1\n",
        "11/28/2024 9:12:44.5 AM;0\n11/28/2024 9:12:45 AM;1\n", "9:12:44,5;0\n9:12:45,0;1\n"}) {
    CAPTURE(clock);
    CHECK(load(std::string("rig 7\nclock;x\n;mm\n") + clock, request({"clock", "x"}, "clock"))
              .columns == NumberColumns{{0, 0.5}, {0, 1}});
  }
  CHECK(load("day,t,x\n2024-11-28,9:12:44,0\n2024-11-28,9:12:45,1\n").columns ==
        NumberColumns{{0, 1}, {0, 1}});
  // It must be the time, increase, and not change its form.
  CHECK_THROWS_WITH(load(text, request({"clock", "x"}, "x")), Contains("2024-02-29 23:59:59.500"));
  CHECK_THROWS_WITH(load("t,x\n12:00:01,1\n12:00:00,2\n", request({"t", "x"}, "t")),
                    Contains("does not increase: -1 comes after 0"));
  CHECK_THROWS_WITH(load("t,x\n0.5,1\n12:00:01,2\n", request({"t", "x"}, "t")),
                    Contains("'12:00:01' in column 't' is not a finite number"));
  CHECK_THROWS_WITH(load("t,x\n12:00:01,1\n5,2\n", request({"t", "x"}, "t")),
                    Contains("a.csv:3:1: '5' in column 't'"));
}

TEST_CASE("load_csv: time that does not increase", "[datasets]") {
  CHECK_THAT(refusal("x,t\n5,0\n5,0.1\n5,0.1\n"),
             StartsWith("a.csv:4:3: time 't' does not increase: 0.1 comes after 0.1"));
  CHECK_THAT(refusal("x,t\n5,0\n5,0.2\n5,0.1\n"),
             StartsWith("a.csv:4:3: time 't' does not increase: 0.1 comes after 0.2"));
  CHECK(load("x,t\n5,1\n5,0\n", request({"t", "x"})).columns == NumberColumns{{1, 0}, {5, 5}});
}

TEST_CASE("load_csv: a time column that is not wanted is a mistake of the caller", "[datasets]") {
  CHECK_THROWS_AS(load("t,x\n0,1\n", request({"x"}, "t")), std::invalid_argument);
}

TEST_CASE("load_csv: empty lines inside", "[datasets]") {
  CHECK_THAT(refusal("t,x\n0,1\n\n \n1,2\n"),
             StartsWith("a.csv:3:1: an empty line inside the data, which continue in line 5"));
  CHECK_THAT(refusal("\nt,x\n0,a\n"), StartsWith("a.csv:1:1: is an empty line"));
  CHECK_THAT(refusal("t,x\n\n0,1\n"), StartsWith("a.csv:2:1: an empty line inside the data"));
}

TEST_CASE("load_csv: nothing to read", "[datasets]") {
  CHECK_THAT(refusal(""), StartsWith("a.csv: is empty; expected a header line"));
  CHECK_THAT(refusal("\xEF\xBB\xBF"), StartsWith("a.csv:1:1: is an empty line"));
  CHECK_THAT(refusal("# only\n# comments\n"), StartsWith("a.csv: contains comments only"));
  CHECK_THAT(refusal("t,x\n"), StartsWith("a.csv:1: no rows after the header"));
  CHECK_THAT(refusal("t,x\n\n\n"), StartsWith("a.csv:1: no rows after the header"));
}

TEST_CASE("load_csv: no such file, a folder", "[datasets]") {
  const File file("");
  CHECK_THAT(refusal_of(file.folder() / "missing.csv", request({"t"})),
             StartsWith("missing.csv: cannot be opened: No such file"));
  fs::create_directory(file.folder() / "folder.csv");
  CHECK_THAT(refusal_of(file.folder() / "folder.csv", request({"t"})),
             StartsWith("folder.csv: is a folder; expected a CSV file"));
}

TEST_CASE("load_csv: a file that cannot be read", "[datasets]") {
  const File file("t\n0\n");
  if (::geteuid() != 0) {  // root can read everything
    fs::permissions(file.path(), fs::perms::none);
    CHECK_THAT(refusal_of(file.path(), request({"t"})), Contains("cannot be opened: Permission"));
  }
  // This file can be opened, but its first byte cannot be read.
  CHECK_THAT(refusal_of("/proc/self/mem", request({"t"})), Contains("mem: cannot be read: "));
}

TEST_CASE("load_csv: text in another encoding, and what is no text", "[datasets]") {
  using namespace std::string_literals;
  // Half a character, and half of a pair of surrogates.
  CHECK_THAT(refusal("\xFF\xFEt\0,\0x\0\n\0\x30"s),
             StartsWith("a.csv: is UTF-16 text, but byte 11 belongs to no character"));
  CHECK_THAT(refusal("\xFE\xFF\0t\0,\xDC\0\0x\0\n"s),
             StartsWith("a.csv: is UTF-16 text, but byte 7 belongs to no character"));
  CHECK_THAT(refusal("t,x\n0,1\n1,\0\x32\n"s),
             StartsWith("a.csv: is a binary file (byte 11 is NUL); expected CSV text"));
  CHECK_THAT(refusal("\x89PNG\x1A\n0,1\n"), Contains("control characters"));
  CHECK_THAT(refusal("t,x\r0,1\r1,2\r"), StartsWith("a.csv:1:1: ") && Contains("carriage return"));
}

TEST_CASE("load_csv: UTF-16 with and without a byte-order mark", "[datasets]") {
  const std::string text = "t [s]\tx [\xB5m]\n0\t1,5\n1\t2,5\n";  // Latin-1
  for (const bool big_endian : {false, true})
    for (const bool has_mark : {false, true}) {
      CAPTURE(big_endian, has_mark);
      std::string wide = !has_mark ? "" : big_endian ? "\xFE\xFF" : "\xFF\xFE";
      for (const char c : text) {
        const char bytes[] = {big_endian ? '\0' : c, big_endian ? c : '\0'};
        wide.append(bytes, 2);
      }
      const RecordTable table = load(wide, request({"t", "x [\u00b5m]"}));
      CHECK(table.columns == NumberColumns{{0, 1}, {1.5, 2.5}});
    }
}

TEST_CASE("load_csv: UTF-16 longer than a block of the converter", "[datasets]") {
  // The euro sign has two bytes in UTF-16 and three in UTF-8, so that blocks end within a line.
  constexpr int kRows = 40'000;
  std::string wide = "\xFF\xFE";
  const auto append = [&wide](std::string_view ascii) {
    for (const char c : ascii) wide.append({c, '\0'});
  };
  append("t,x,note\n");
  for (int i = 0; i < kRows; ++i) {
    append(std::to_string(i) + "," + std::to_string(i % 7) + ",");
    wide += "\xAC\x20";
    append("\n");
  }
  const RecordTable table = load(wide);
  REQUIRE(table.columns[0].size() == kRows);
  CHECK(table.columns[0].back() == kRows - 1);
  CHECK(table.columns[1].back() == (kRows - 1) % 7);
}

TEST_CASE("load_csv: messages show no control characters and stay short", "[datasets]") {
  const std::string message = refusal("t,x\n0,\x1B[31m" + std::string(1000, 'a') + "\n");
  CHECK_THAT(message, StartsWith("a.csv:2:3: '?[31maaa") && Contains("...' in column"));
  CHECK(message.size() < 200);
}

TEST_CASE("load_csv: too many columns", "[datasets]") {
  CHECK_THAT(refusal(std::string(20'000, ',') + "\n"),
             StartsWith("a.csv:1:1: has 20001 columns; expected at most 10000"));
}

// ---- Sizes ---------------------------------------------------------------------------------

TEST_CASE("load_csv: files longer than the window of the reader", "[datasets]") {
  // The file has three windows of 16 MiB and no line end after the last line. Every line is checked
  // against its number.
  constexpr bool kFewer = rigcal::test::kSanitized;  // a tenth as many lines, ten times as long
  constexpr long kRows = kFewer ? 110'000 : 1'100'000;
  std::string text = "note,t,x\n";
  const std::string padding(kFewer ? 300 : 30, 'p');
  for (long i = 0; i < kRows; ++i)
    text.append(padding)
        .append(",")
        .append(std::to_string(i))
        .append(",")
        .append(std::to_string(i % 7))
        .append("\n");
  text.pop_back();
  REQUIRE(text.size() > std::size_t{3} << 23);
  const RecordTable table = load(text);
  REQUIRE(table.columns[0].size() == kRows);
  long wrong = 0;
  for (long i = 0; i < kRows; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (table.columns[0][k] != static_cast<double>(i)) ++wrong;
    if (table.columns[1][k] != static_cast<double>(i % 7)) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK_THAT(refusal(text + "x\n"), StartsWith("a.csv:" + std::to_string(kRows + 1) + ":"));
}

TEST_CASE("load_csv: a file above the limit of bytes is refused unread", "[datasets]") {
  const File file("t,x\n0,1\n");
  fs::resize_file(file.path(), std::uintmax_t{5} << 30);  // sparse, so it needs no disk space
  CHECK_THAT(refusal_of(file.path(), request({"t"})),
             StartsWith("a.csv: has 5368709120 bytes, more than the limit of 4294967296") &&
                 EndsWith("split it into several files"));
  const auto open = [](const std::string& text) { CsvLines(File(text).path(), 8); };
  CHECK_NOTHROW(open("t,x\n0,1\n"));
  CHECK_THROWS_WITH(open("t,x\n0,12\n"), Contains("limit of 8"));
}

namespace {

// The whole command may use 200 MB, of which 20 MB are reserved for everything else. A sanitizer
// needs memory of its own, and keeps freed blocks in quarantine.
constexpr long kMostMegabytes = rigcal::test::kSanitized ? 700 : 180;

/// Resident memory of this process. A child process starts with the same amount.
long resident_megabytes() {
  long pages_of_program = 0;
  long pages_resident = 0;
  std::ifstream("/proc/self/statm") >> pages_of_program >> pages_resident;
  return pages_resident * ::sysconf(_SC_PAGESIZE) / (1 << 20);
}

struct EndlessResult {
  std::string message;
  std::size_t bytes_given = 0;
  long grown_megabytes = 0;  ///< increase of the peak memory
};

/// Calls `read`, in a separate process, with a pipe that delivers `head` and then `body` over and
/// over.
EndlessResult read_endless(const std::string& head, const std::string& body,
                           const std::function<void(const fs::path&)>& read) {
  const File file("");
  const fs::path pipe = file.folder() / "endless.csv";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const auto handler = std::signal(SIGPIPE, SIG_IGN);  // write() fails when the reader gives up
  const long megabytes_before = resident_megabytes();
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::string message = "no error";
    try {
      read(pipe);
    } catch (const std::exception& error) {
      message = error.what();
    }
    std::ofstream(file.folder() / "message") << message;
    ::_exit(0);
  }
  EndlessResult result;
  const int out = ::open(pipe.c_str(), O_WRONLY);
  REQUIRE(out >= 0);
  // Stops here if the reader never gives up.
  constexpr std::size_t kStop = std::size_t{2} << 30;
  std::string block = head;
  while (block.size() < (std::size_t{1} << 20)) block += body;
  const std::string first = block;
  block.clear();
  while (block.size() < (std::size_t{1} << 20)) block += body;
  const std::string* next = &first;
  while (result.bytes_given < kStop) {
    const ssize_t written = ::write(out, next->data(), next->size());
    if (written < 0) break;
    result.bytes_given += static_cast<std::size_t>(written);
    if (static_cast<std::size_t>(written) < next->size()) break;
    next = &block;
  }
  ::close(out);
  int status = 0;
  rusage usage{};
  REQUIRE(::wait4(child, &status, 0, &usage) == child);
  std::signal(SIGPIPE, handler);
  CHECK(status == 0);
  result.grown_megabytes = usage.ru_maxrss / 1024 - megabytes_before;
  std::getline(std::ifstream(file.folder() / "message"), result.message);
  return result;
}

}  // namespace

TEST_CASE("load_csv: a huge file is given up early and within 200 MB", "[datasets]") {
  const auto [head, row, names] =
      GENERATE(table<std::string, std::string, std::vector<std::string>>(
          {{"x\n", "1\n", {"x"}}, {"a,b,c,d\n", "1,2,3,4\n", {"a", "b", "c", "d"}}}));
  const RecordRequest wanted = request(names);
  const EndlessResult result =
      read_endless(head, row, [&](const fs::path& pipe) { load_csv_record(pipe, wanted); });
  CAPTURE(result.bytes_given, result.grown_megabytes);
  CHECK_THAT(result.message, Contains("endless.csv:") && Contains("more than 12000000 numbers") &&
                                 Contains("decimate the record, or split it"));
  // This allows for 12 million numbers of two bytes each, and at most three windows of 16 MiB read
  // ahead.
  CHECK(result.bytes_given < 80'000'000);
  CHECK(result.grown_megabytes < kMostMegabytes);
}

TEST_CASE("load_csv: a huge file on disk is refused within 200 MB", "[datasets]") {
  const File file("");
  {
    std::ofstream out(file.path());
    out << "x\n1\n";
    std::string block;
    for (int i = 0; i < 100'000; ++i) block += "1\n";
    for (int i = 0; i < 121; ++i) out << block;
  }
  const long megabytes_before = resident_megabytes();
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    try {
      load_csv_record(file.path(), request({"x"}));
    } catch (const InputError& error) {
      ::_exit(error.where().line == 12'000'002 ? 2 : 3);
    }
    ::_exit(0);
  }
  int status = 0;
  rusage usage{};
  REQUIRE(::wait4(child, &status, 0, &usage) == child);
  CHECK(WEXITSTATUS(status) == 2);
  CHECK(usage.ru_maxrss / 1024 - megabytes_before < kMostMegabytes);
}

TEST_CASE("load_csv: a line without end is given up early", "[datasets]") {
  const EndlessResult result = read_endless("t,x\n0,1\n", "1234567890", [](const fs::path& pipe) {
    load_csv_record(pipe, request({"t"}));
  });
  CHECK_THAT(result.message, Contains("endless.csv:3: the line has 16 MiB or more"));
  CHECK(result.bytes_given < 80'000'000);
  CHECK(result.grown_megabytes < kMostMegabytes);
}

TEST_CASE("load_csv: a pipe above the limit of bytes", "[datasets]") {
  const EndlessResult result = read_endless("x\n", "1\n", [](const fs::path& pipe) {
    CsvLines lines(pipe, 1'000'000);
    while (lines.next() != nullptr) {
    }
  });
  CHECK_THAT(result.message, Contains("is longer than the limit of 1000000 bytes"));
  CHECK(result.bytes_given < 80'000'000);
}

TEST_CASE("load_csv: a file that may have been cut within its last number", "[datasets]") {
  const auto cut = [](const std::string& content, const std::vector<std::string>& columns) {
    return load_csv_record(File(content).path(), request(columns)).warning;
  };
  const std::string rows = "t,x\n0.0,3.4209\n0.1,-1.2345\n0.2,2.5";
  CHECK_THAT(cut(rows, {"t", "x"}), Contains(":4: the file ends without a newline") &&
                                        Contains("column 'x', has 3 characters") &&
                                        Contains("6 or more"));
  CHECK(cut(rows + "\n", {"t", "x"}).empty());            // complete
  CHECK(cut(rows + "432", {"t", "x"}).empty());           // as long as the others
  CHECK(cut(rows, {"t"}).empty());                        // last column not used
  CHECK(cut("t,x\n0.0,3.4", {"t", "x"}).empty());         // nothing to compare with
  CHECK(cut("t,x\n0,1\n1,10\n2,3", {"t", "x"}).empty());  // not the shortest
}

TEST_CASE("load_csv: decimal comma and decimal point in one file are refused", "[datasets]") {
  const auto refusal = [](const std::string& content) {
    return refusal_of(File(content).path(), request({"t", "x"}, "t"));
  };
  CHECK_THAT(refusal("t;x\n0,5;1,5\n1,5;1.234\n"),
             Contains("a.csv:3:5: '1.234' has a decimal point, but line 2 has a decimal comma"));
  CHECK_THAT(refusal("t;x\n0.5;1.5\n1.5;2.5\n2.5;1,5\n"),
             Contains("a.csv:4:5: '1,5' has a decimal comma, but line 2 has a decimal point"));
  CHECK_THAT(refusal("t\tx\n0,5\t1.5\n"), Contains("has a decimal point, but line 2"));
  CHECK(load("t;x\n0;1\n1;2,5\n2;3\n").columns == NumberColumns{{0, 1, 2}, {1, 2.5, 3}});
  CHECK(load("t;x\n0;1\n1;2.5\n2;3\n").columns == NumberColumns{{0, 1, 2}, {1, 2.5, 3}});
  // A column that is not wanted may contain dates.
  CHECK(load("t;date;x\n0;12.03.2026;1,5\n1;12.03.2026;2,5\n").columns ==
        NumberColumns{{0, 1}, {1.5, 2.5}});
}

TEST_CASE("load_csv: how the columns are labelled", "[datasets]") {
  const RecordTable table = load("# rig 2\nt [s],x [mm]\n0,1\n", request({"x", "t"}));
  REQUIRE(table.labels.size() == 2);
  CHECK(table.labels[0].name == "x [mm]");
  CHECK(table.labels[1].name == "t [s]");
  CHECK(table.labels[1].line == 2);
}
