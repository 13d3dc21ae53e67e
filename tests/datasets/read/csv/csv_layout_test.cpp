#include "datasets/read/csv/csv_layout.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "datasets/read/csv/load_csv.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::Contains;
using rigcal::test::TemporaryFolder;

namespace {

/// Reads two columns of a text.
struct ReadText {
  TemporaryFolder folder;
  std::filesystem::path path;
  explicit ReadText(const std::string& text) : path(folder.write("a.txt", text)) {}
  RecordTable table(const std::string& time, const std::string& x, char separator = 0) const {
    RecordRequest request;
    request.columns = {time, x};
    request.time_column = time;
    request.separator = separator;
    return load_csv_record(path, request);
  }
};

std::vector<std::string> names_in(const ReadText& text) {
  std::vector<std::string> names;
  for (const RecordColumn& column : csv_record_columns(text.path)) names.push_back(column.name);
  return names;
}

using NumberColumns = std::vector<std::vector<double>>;
const NumberColumns kNumbers{{0.0, 0.1, 0.2}, {1.5, 2.5, 3.5}};

}  // namespace

TEST_CASE("csv_layout: lines of text above the header", "[datasets]") {
  for (const std::string& text : {
           std::string(
               "Test rig 3\nOperator: Weber\n\nrun 7, 2026\nt,x\n0,1.5\n0.1,2.5\n0.2,3.5\n"),
           std::string("Pruefstand;3\nDatum;12.3.2024\n\nt;x\n0;1,5\n0,1;2,5\n0,2;3,5\n"),
           std::string("Rate,1000\nGain,3.5\nt,x\n\n0,1.5\n0.1,2.5\n0.2,3.5\n"),
           std::string("# numpy\n# t,x\n0,1.5\n0.1,2.5\n0.2,3.5\n"),
           std::string("% from MATLAB\n% t,x\n0,1.5\n0.1,2.5\n0.2,3.5\n"),
       }) {
    CAPTURE(text);
    CHECK(ReadText(text).table("t", "x").columns == kNumbers);
  }
  std::string notes;
  for (int i = 0; i < 490; ++i) notes += "note\n";
  CHECK(ReadText(notes + "t,x\n0,1.5\n0.1,2.5\n0.2,3.5\n").table("t", "x").columns == kNumbers);
}

TEST_CASE("csv_layout: LabVIEW's .lvm", "[datasets]") {
  const ReadText lvm(
      "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\n"
      "Decimal_Separator\t.\nX_Columns\tOne\n***End_of_Header***\t\n\t\nChannels\t1\t\n"
      "Samples\t3\t\nY_Unit_Label\tVolts\t\nX0\t0.0000000000000000E+0\t\n"
      "Delta_X\t0.1\t\n***End_of_Header***\t\t\nX_Value\tVoltage\tComment\n"
      "0.0\t1.5\t\n0.1\t2.5\n0.2\t3.5\n");
  CHECK(lvm.table("X_Value", "Voltage").columns == kNumbers);
  CHECK(names_in(lvm) == std::vector<std::string>{"X_Value", "Voltage", "Comment"});
}

TEST_CASE("csv_layout: units of LabVIEW's .lvm, and times that no column contains", "[datasets]") {
  const std::string above =
      "LabVIEW Measurement\t\nDecimal_Separator\t.\nX_Columns\tOne\n***End_of_Header***\t\n\t\n"
      "Channels\t2\t\t\nY_Unit_Label\tmm\tVolts\t\nX_Dimension\tTime\tTime\t\nX0\t0.5\t0.5\t\n"
      "Delta_X\t0.1\t0.1\t\n***End_of_Header***\t\t\t\nX_Value\tPosition\tSignal\tComment\n";
  const ReadText with_times(above + "0.0\t1.5\t7\t\n0.1\t2.5\t8\n0.2\t3.5\t9\n");
  CHECK(csv_record_columns(with_times.path) ==
        std::vector<RecordColumn>{
            {"X_Value", "s"}, {"Position", "mm"}, {"Signal", "Volts"}, {"Comment", ""}});
  CHECK(with_times.table("X_Value", "Position").labels[1].unit == "mm");
  CHECK(with_times.table("X_Value", "Position").labels[1].line == 7);

  std::string text = above;
  text.replace(text.find("One"), 3, "No");
  text.replace(text.find("X_Value\t"), 8, "");
  const ReadText without_times(text + "1.5\t7\t\n2.5\t8\n3.5\t9\n");
  CHECK(csv_record_columns(without_times.path) ==
        std::vector<RecordColumn>{
            {"X_Value", "s", true}, {"Position", "mm"}, {"Signal", "Volts"}, {"Comment", ""}});
  const RecordTable table = without_times.table("X_Value", "Signal");
  REQUIRE(table.columns.size() == 2);
  CHECK(table.columns[1] == std::vector<double>{7, 8, 9});
  for (std::size_t i = 0; i < 3; ++i)
    CHECK(table.columns[0].at(i) == Approx(0.5 + 0.1 * static_cast<double>(i)));
  CHECK(table.labels[0].unit == "s");
  CHECK(names_in(without_times).front() == "X_Value");

  // Channels with rates of their own have no common time.
  text.replace(text.find("Delta_X\t0.1\t0.1"), 15, "Delta_X\t0.1\t0.2");
  const ReadText rates(text + "1.5\t7\t\n2.5\t8\n3.5\t9\n");
  CHECK_THROWS_WITH(rates.table("X_Value", "Signal"), Contains("X_Value"));
  text.replace(text.find("Delta_X\t0.1\t0.2"), 15, "Delta_X\t1e-30\t\t");
  CHECK_THROWS_WITH(ReadText(text + "1.5\t7\t\n2.5\t8\n3.5\t9\n").table("X_Value", "Signal"),
                    Contains("Delta_X is 1e-30 s"));
}

TEST_CASE("csv_layout: a .lvm names the X_Value that it leaves empty", "[datasets]") {
  const std::string segment =
      "Channels\t2\t\t\t\nY_Unit_Label\tmm\tVolts\t\nX_Dimension\tTime\tTime\t\nX0\t0.5\t0.5\t\n"
      "Delta_X\t0.1\t0.1\t\n***End_of_Header***\t\t\t\nX_Value\tPosition\tSignal\tComment\n"
      "\t1.5\t7\t\n\t2.5\t8\n\t3.5\t9\n";
  const std::string above =
      "LabVIEW Measurement\t\nMulti_Headings\tYes\nX_Columns\tNo\n***End_of_Header***\t\n\t\n";
  const ReadText lvm(above + segment);
  CHECK(csv_record_columns(lvm.path) ==
        std::vector<RecordColumn>{
            {"X_Value", "s", true}, {"Position", "mm"}, {"Signal", "Volts"}, {"Comment", ""}});
  const RecordTable table = lvm.table("X_Value", "Position");
  CHECK(table.columns[1] == kNumbers[1]);
  CHECK(table.columns[0].at(2) == Approx(0.7));
  // Each segment has a beginning of its own.
  CHECK_THROWS_WITH(ReadText(above + segment + "\n" + segment).table("X_Value", "Position"),
                    Contains("a.txt:17:1: 'Channels") && Contains("a file of its own"));
}

TEST_CASE("csv_layout: TwinCAT Scope's pairs of time and value", "[datasets]") {
  const std::string above =
      "Name\tScope Project\nFile\tC:\\run.svdx\nStarttime of export\t133507764000000000\t26 "
      "January\n"
      "\nName\tActPos\tName\tActPres\nSymbolComment\t\tSymbolComment\t\n"
      "SampleTime[ms]\t100\tSampleTime[ms]\t100\nUnit\tmm\tUnit\tbar\nOffset\t0\tOffset\t0\n\n";
  const ReadText scope(above + "0\t1.5\t0\t7\n100\t2.5\t100\t8\n200\t3.5\t200\t9\n");
  CHECK(csv_record_columns(scope.path) ==
        std::vector<RecordColumn>{{"Time", "ms", true}, {"ActPos", "mm"}, {"ActPres", "bar"}});
  CHECK(scope.table("Time", "ActPres").columns == NumberColumns{{0, 100, 200}, {7, 8, 9}});
  CHECK_THROWS_WITH(ReadText(above + "0\t1\t0\t7\n100\t2\t150\t8\n").table("Time", "ActPres"),
                    Contains("a.txt:12:7: the time of 'ActPres' is '150'"));
  const ReadText ticks(above +
                       "133507764000000000\t1\t133507764000000000\t7\n"
                       "133507764001000000\t2\t133507764001000000\t8\n");
  CHECK(csv_record_columns(ticks.path).front() == RecordColumn{"Time", "100 ns", true});
}

TEST_CASE("csv_layout: settings of each column below its name", "[datasets]") {
  const ReadText catman(
      "catman\nZeit [s]\tWeg [mm]\nStart: 26.01.2024\t\nRate: 10 Hz\tRate: 10 Hz\n"
      "0\t1,5\n0,1\t2,5\n0,2\t3,5\n");
  CHECK(catman.table("Zeit", "Weg").columns == kNumbers);
}

TEST_CASE("csv_layout: a row of units may have a label", "[datasets]") {
  const ReadText units("Name,t,x\nUnit,s,mm\n7,0,1.5\n8,0.1,2.5\n9,0.2,3.5\n");
  CHECK(units.table("t", "x").columns == kNumbers);
  CHECK(csv_record_columns(units.path) ==
        std::vector<RecordColumn>{{"Name", ""}, {"t", "s"}, {"x", "mm"}});
}

TEST_CASE("csv_layout: columns that no line names have numbers", "[datasets]") {
  for (const char* text : {"0,1.5\n0.1,2.5\n0.2,3.5\n", "0 1.5\n0.1 2.5\n0.2 3.5\n",
                           "0;1,5\n0,1;2,5\n0,2;3,5\n", "# t u y\n0\t1.5\n0.1\t2.5\n0.2\t3.5\n",
                           "time of the servo\n0.0  1.5\n0.1  2.5\n0.2  3.5\n"}) {
    CAPTURE(text);
    const ReadText numbers(text);
    CHECK(numbers.table("1", "2").columns == kNumbers);
    CHECK(names_in(numbers) == std::vector<std::string>{"1", "2"});
    // A campaign that names its columns is refused as ever.
    CHECK_THROWS_WITH(numbers.table("t", "x"), Contains("contains numbers; expected the header") &&
                                                   Contains("\"1\" to \"2\""));
  }
  CHECK_THROWS_WITH(
      ReadText("% Column 1: time\n% Column 2: travel\n0 1 2\n1 2 3\n").table("t", "x"),
      Contains("contains numbers"));
  // One column alone is named by its header.
  CHECK(names_in(ReadText("x\n1\n2\n")) == std::vector<std::string>{"x"});
}

TEST_CASE("csv_layout: a comment that rows omit is no number", "[datasets]") {
  const ReadText lvm("X_Value\tVoltage\tComment\n0.0\t1.5\n0.1\t2.5\n0.2\t3.5\n");
  CHECK(lvm.table("X_Value", "Voltage").columns == kNumbers);
  CHECK_THROWS_WITH(lvm.table("X_Value", "Comment"),
                    Contains("a.txt:2:") && Contains("2 columns; expected 3"));
}

TEST_CASE("csv_layout: columns between blanks", "[datasets]") {
  const ReadText aligned("  t [s]    x [mm]\n  0.0      1.5\n  0.1      2.5\n  0.2\t3.5\n");
  CHECK(aligned.table("t", "x").columns == kNumbers);
  CHECK(names_in(aligned) == std::vector<std::string>{"t [s]", "x [mm]"});
  CHECK(ReadText("t x\n0,0 1,5\n0,1 2,5\n0,2 3,5\n").table("t", "x", ' ').columns == kNumbers);
  CHECK_THROWS_WITH(ReadText("t x\n0.0 1.5\n0.1 a\n").table("t", "x", ' '),
                    Contains("a.txt:3:5: 'a' in column 'x' is not a finite number"));
}

TEST_CASE("csv_layout: a row of units", "[datasets]") {
  const ReadText units("Log of rig 3\nt,x\n[s],[mm]\n0,1.5\n0.1,2.5\n0.2,3.5\n");
  const RecordTable table = units.table("t", "x");
  CHECK(table.columns == kNumbers);
  CHECK(table.labels[1].unit == "mm");
  CHECK(table.labels[1].line == 3);
  CHECK(ReadText("t,x\n[s],[mm]\n\n0,1.5\n0.1,2.5\n0.2,3.5\n").table("t", "x").labels[1].line == 2);
  CHECK(csv_record_columns(units.path) ==
        std::vector<RecordColumn>{{"t", "s", false, false}, {"x", "mm", false, false}});
  CHECK(ReadText("t;x;note\ns;mm;-\n0;1.5;0\n0.1;2.5;0\n0.2;3.5;1\n").table("t", "x").columns ==
        kNumbers);
}

TEST_CASE("csv_layout: rows that dSPACE labels", "[datasets]") {
  const ReadText dspace(
      "descriptions,General,User\nversion,1.0,\npath,t,x\ntrace_values,0,1.5\n,0.1,2.5\n,0.2,3."
      "5\n");
  CHECK(dspace.table("t", "x").columns == kNumbers);
}

TEST_CASE("csv_layout: rows of dSPACE with names and units", "[datasets]") {
  const ReadText dspace(
      "title,run 5\ntrace_names,t,x\ntrace_units,s,mm\ntrace_values,0,1.5\n,0.1,2.5\n,0.2,3.5\n");
  const RecordTable table = dspace.table("t", "x");
  CHECK(table.columns == kNumbers);
  CHECK(table.labels[1].unit == "mm");
}

TEST_CASE("csv_layout: a line of descriptions below the units", "[datasets]") {
  const ReadText diadem(
      "Zeit;Weg;Druck\n[s];[mm];[bar]\nclock 1;LVDT;P8AP\n0;1,5;7\n0,1;2,5;8\n0,2;3,5;9\n");
  const RecordTable table = diadem.table("Zeit", "Weg");
  CHECK(table.columns == kNumbers);
  CHECK(table.labels[1].unit == "mm");
  CHECK(table.labels[1].line == 2);
  // Without units, the names are directly above the numbers.
  CHECK(ReadText("a;b;c\nt;x;note\n0;1,5;7\n0,1;2,5;8\n0,2;3,5;9\n").table("t", "x").columns ==
        kNumbers);
}

TEST_CASE("csv_layout: units of some columns only", "[datasets]") {
  const ReadText units("t;x;state;n\ns;mm;n/a;Counts\n0;1.5;0;1\n0.1;2.5;0;2\n0.2;3.5;1;3\n");
  CHECK(units.table("t", "x").columns == kNumbers);
}

TEST_CASE("csv_layout: tabs at the ends of all lines", "[datasets]") {
  const ReadText mts(
      "MTS793|MPT\nStation:\trig 3\n\nt\tx\t\ns\tmm\t\n0\t1.5\t\n0.1\t2.5\t\n0.2\t3.5\t\n");
  const RecordTable table = mts.table("t", "x");
  CHECK(table.columns == kNumbers);
  CHECK(table.labels[1].unit == "mm");
}

TEST_CASE("csv_layout: units in brackets between blanks", "[datasets]") {
  const ReadText aligned("   t      x\n  (s)   (mm)\n  0.0    1.5\n  0.1    2.5\n  0.2    3.5\n");
  const RecordTable table = aligned.table("t", "x");
  CHECK(table.columns == kNumbers);
  CHECK(table.labels[1].unit == "mm");
}

TEST_CASE("csv_layout: what is no header is none", "[datasets]") {
  // A row with a number is not a header, there must be as many names as fields (only a column of
  // comments may be left out), and a column of states is not a column of numbers.
  CHECK_FALSE(find_layout(std::vector<std::string>{"0,1,ok", "1,2,3", "2,3,4"}, true, 0));
  CHECK_FALSE(find_layout(std::vector<std::string>{"t,x", "0,5,1,5", "1,5,2,5"}, true, 0));
  CHECK_FALSE(find_layout(std::vector<std::string>{"t,x,y", "0,1", "1,2"}, true, 0));
  CHECK_FALSE(find_layout(std::vector<std::string>{"text", "1,2", "more"}, true, 0));
  CHECK_FALSE(find_layout(std::vector<std::string>{"a b", "1,2", "3,4"}, true, ';'));
  const auto found = find_layout(std::vector<std::string>{"title", "a b", "1 2"}, true, 0);
  REQUIRE(found);
  CHECK(found->header == 1);
  CHECK(found->separator == ' ');
  CHECK_FALSE(find_layout(std::vector<std::string>{"title", "a b", "1 2"}, false, 0));
}
