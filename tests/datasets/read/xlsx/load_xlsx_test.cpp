#include "datasets/read/xlsx/load_xlsx.hpp"

#include <xlsxwriter.h>

#include <catch2/catch.hpp>
#include <clocale>
#include <string>
#include <vector>

#include "tests/datasets/reading.hpp"
#include "tests/datasets/xlsx_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::Contains;

namespace {

/// Message when reading "t" and "x" from a first sheet with these rows.
std::string refusal_of_sheet(const XlsxRows& rows, const std::string& behind = "") {
  const TemporaryFolder folder;
  write_zip(folder.path() / "a.xlsx", xlsx_parts({{"Log", sheet_xml(rows, behind)}}));
  return read_refusal(folder.path() / "a.xlsx", {"t", "x"}, "t");
}

}  // namespace

/// libxlsxwriter rounds numbers to 16 digits, so the numbers used here need fewer.
TEST_CASE("load_xlsx: what libxlsxwriter writes", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.xlsx";
  {
    lxw_workbook* book = workbook_new(path.c_str());
    lxw_format* shown = workbook_add_format(book);
    format_set_num_format(shown, "0.0 \"mm\"");
    lxw_worksheet* first = workbook_add_worksheet(book, "Log");
    worksheet_write_string(first, 0, 0, "t [s]", nullptr);
    worksheet_write_string(first, 0, 1, "x [mm]", nullptr);
    worksheet_write_string(first, 0, 2, "note", nullptr);
    lxw_worksheet* second = workbook_add_worksheet(book, "Pressures, side A");
    worksheet_write_string(second, 0, 0, "p", nullptr);
    for (unsigned i = 0; i < 3; ++i) {
      worksheet_write_number(first, i + 1, 0, 0.125 * i, nullptr);
      worksheet_write_number(first, i + 1, 1, 0.3125 + i, shown);
      worksheet_write_string(first, i + 1, 2, "free text", nullptr);
      worksheet_write_formula_num(second, i + 1, 0, "=Log!B2*2", nullptr, 7.5 + i);
    }
    REQUIRE(workbook_close(book) == LXW_NO_ERROR);
  }
  CHECK(read_columns(path, {"t", "x", "Pressures, side A!p", "x [mm]", "'Log'!x"}, "t") ==
        Table{{0.0, 0.125, 0.25},
              {0.3125, 0.3125 + 1, 0.3125 + 2},
              {7.5, 8.5, 9.5},
              {0.3125, 0.3125 + 1, 0.3125 + 2},
              {0.3125, 0.3125 + 1, 0.3125 + 2}});
  CHECK(xlsx_record_columns(path) ==
        std::vector<RecordColumn>{{"t [s]", "", false, false},
                                  {"x [mm]", "", false, false},
                                  {"note", "", false, false},
                                  {"Pressures, side A!p", "", false, false}});
}

TEST_CASE("load_xlsx: comments, header, a row of units, shared and rich texts", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.xlsx";
  write_xlsx(
      path,
      {{"A",
        {{cell("# rig 2, run 7")},
         {},
         {raw_cell("<c r=\"@\" t=\"s\"><v>0</v></c>"), no_cell(), cell("p\n  A (bar)"), cell("u")},
         {cell("[ms]"), cell("-"), cell("MPa"), cell("V")},
         {cell(0), no_cell(), cell(1.5), cell(-3)},
         {cell(1), no_cell(), cell(2.5), cell(-4)},
         {},
         {no_cell(), cell("a note below")}}},
       {"B", {{raw_cell("<c t=\"s\"><v>1</v></c>")}, {cell(5)}, {cell(6)}}}});
  CHECK(read_columns(path, {"t", "p A", "p A (bar)", "B!x"}, "t") ==
        Table{{0, 1}, {1.5, 2.5}, {1.5, 2.5}, {5, 6}});
  CHECK(xlsx_record_columns(path) == std::vector<RecordColumn>{{"t", "ms", false, false},
                                                               {"p A (bar)", "MPa", false, false},
                                                               {"u", "V", false, false},
                                                               {"B!x [mm]", "", false, false}});
}

TEST_CASE("load_xlsx: titles above the header, and a sheet of notes", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.xlsx";
  write_xlsx(path, {{"Info", {{cell("Specimen"), cell("Position 12")}, {cell("Rate"), cell(500)}}},
                    {"Log",
                     {{cell("Run 7 of rig 3")},
                      {cell("Rate [Hz]"), cell(500)},
                      {},
                      {cell("t"), cell("x")},
                      {cell("s"), cell("mm")},
                      {cell(0), cell(1.5)},
                      {cell(1), cell(2.5)}}},
                    {"Short", {{cell("Title")}, {cell("y"), cell("z")}, {cell(5), cell(6)}}}});
  CHECK(xlsx_record_columns(path) == std::vector<RecordColumn>{{"Log!t", "s", false, false},
                                                               {"Log!x", "mm", false, false},
                                                               {"Short!y", "", false, false},
                                                               {"Short!z", "", false, false}});
  CHECK(read_columns(path, {"Log!t", "Log!x"}, "Log!t") == Table{{0, 1}, {1.5, 2.5}});
  CHECK(read_columns(path, {"Short!z"}, "") == Table{{6}});
}

TEST_CASE("load_xlsx: numbers as they are stored, in any locale", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.xlsx";
  write_xlsx(path, {{"A",
                     {{cell("t"), cell("x")},
                      {raw_cell("<c r=\"@\"><v>0.10000000000000001</v></c>"),
                       raw_cell("<c r=\"@\" s=\"2\"><v>1.2345678901234567E-7</v></c>")},
                      {raw_cell("<c r=\"@\" t=\"n\"><v>0.29999999999999999</v></c>"),
                       raw_cell("<c r=\"@\"><f>A3*2</f><v>-12</v></c>")}}}});
  const Table expected{{0.1, 0.3}, {1.2345678901234567e-7, -12}};
  CHECK(read_columns(path, {"t", "x"}, "t") == expected);
  for (const char* locale : {"de_DE.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_ALL, locale) == nullptr) continue;  // not installed on this machine
    CHECK(read_columns(path, {"t", "x"}, "t") == expected);
  }
  std::setlocale(LC_ALL, "C");
}

TEST_CASE("load_xlsx: what is no number is named with its cell", "[datasets]") {
  const auto third = [](const XlsxFixtureCell& bad) {
    return XlsxRows{{cell("t"), cell("x"), cell("note")},
                    {cell(0), cell(1), cell("a")},
                    {cell(1), bad, cell("b")},
                    {cell(2), cell(3), cell("c")}};
  };
  struct Case {
    std::string xml;
    std::string part;
  };
  const std::vector<Case> cases{
      {"<c r=\"@\" t=\"e\"><v>#DIV/0!</v></c>", "Log!B3 is the error #DIV/0!; expected a number"},
      {"<c r=\"@\" t=\"e\"><f>1/0</f><v>#DIV/0!</v></c>", "Log!B3 is the error #DIV/0!"},
      {"<c r=\"@\" t=\"str\"><f>A1</f><v>open</v></c>", "Log!B3 is the text 'open'"},
      {"<c r=\"@\" t=\"b\"><v>1</v></c>", "Log!B3 is a truth value"},
      {"<c r=\"@\"><f>A1+1</f></c>", "Log!B3 has a formula without a stored result"},
      {"<c r=\"@\"><f>A1+1</f><v></v></c>", "Log!B3 has a formula without a stored result"},
      {"<c r=\"@\" t=\"n\"><f>A1+1</f><v/></c>", "Log!B3 has a formula without a stored result"},
      {"<c r=\"@\"><v>1</v><v>2</v></c>", "Log!B3 has two values"},
      {"<c r=\"@\"><v>1<y/>2</v></c>", "Log!B3 has an element within its value"},
      {"<c r=\"@\"><v>1</v><x:v xmlns:x=\"urn:x\">2</x:v></c>",
       "Log!B3 or a cell after it is of an unknown type"},
      {"<x:c xmlns:x=\"urn:x\" r=\"@\"><v>1</v></x:c>",
       "Log!A3 or a cell after it is of an unknown type"},
      {"<c r=\"@\" s=\"1\"><v>45000.5</v></c>",
       "Log!B3 shows a date or a time of day (stored as 45000.5); expected a number"},
      {"<c r=\"@\" s=\"3\"><v>0.001</v></c>", "Log!B3 shows a date or a time of day"},
      {"<c r=\"@\" t=\"d\"><v>2026-01-01T00:00:00</v></c>", "Log!B3 shows a date"},
      {"<c r=\"@\"><v>1,5</v></c>", "Log!B3 is '1,5', which is not a finite number"},
      {"<c r=\"@\"><v>1e999</v></c>", "Log!B3 is '1e999', which is not a finite number"},
      {"", "Log!B3 is empty, but rows follow or other columns continue; expected a number"},
      {"<c r=\"@\" s=\"1\"/>", "Log!B3 is empty"},
      {"<c r=\"@\" t=\"s\"><v>7</v></c>", "Log!B3 refers to text that the workbook lacks"},
      {"<c r=\"A3\"><v>1</v></c>", "Log!"},
      {"<c r=\"@\" t=\"inlineStr\"><is><t>1.5</t></is></c>", "Log!B3 is the text '1.5'"}};
  for (const Case& each : cases) {
    CAPTURE(each.xml);
    CHECK_THAT(refusal_of_sheet(third(raw_cell(each.xml))),
               Contains("a.xlsx: ") && Contains(each.part));
  }
  CHECK_THAT(refusal_of_sheet(third(no_cell()),
                              "<mergeCells count=\"1\"><mergeCell ref=\"B2:B3\"/></mergeCells>"),
             Contains("Log!B3 belongs to the merged cells B2:B3, of which only the first"));
}

TEST_CASE("load_xlsx: rows and headers that do not fit", "[datasets]") {
  const auto header = std::vector<XlsxFixtureCell>{cell("t"), cell("x")};
  const std::vector<XlsxFixtureCell> row{cell(0), cell(1)};
  CHECK_THAT(refusal_of_sheet({header}), Contains("Log: no rows below the header in row 1"));
  CHECK_THAT(refusal_of_sheet(XlsxRows{}), Contains("Log is empty; expected a header"));
  CHECK_THAT(refusal_of_sheet({row, row}), Contains("Log!B1 and the rest of its row are numbers"));
  CHECK_THAT(refusal_of_sheet({header, {}, row}), Contains("Log!A2 is empty"));
  CHECK_THAT(refusal_of_sheet({header, row, {}, {cell(1), cell(1)}}), Contains("Log!A3 is empty"));
  CHECK_THAT(refusal_of_sheet({header, row, {cell(1)}}), Contains("Log!B3 is empty"));
  CHECK_THAT(refusal_of_sheet({header, row, row}),
             Contains("Log!A3 is 0 after 0: time 't' does not increase"));
  CHECK_THAT(refusal_of_sheet({header, {cell("s"), cell("open")}, row}),
             Contains("Log!A2 is the text 's'; expected a number; the row below the header may "
                      "hold units only"));
  CHECK_THAT(refusal_of_sheet({{cell("t"), cell("y")}, row}),
             Contains("Log row 1: unknown column 'x'") && Contains("known: t, y"));
  CHECK_THAT(refusal_of_sheet({{cell("t"), cell("x"), cell("x")}, row}),
             Contains("Log: columns B1 and C1 are both named 'x'; expected one"));
}

/// openpyxl, pandas and XlsxWriter write formulas without a computed result.
TEST_CASE("load_xlsx: formulas at the end do not end the record", "[datasets]") {
  const auto rows = [](const std::string& formula) {
    return XlsxRows{{cell("t"), cell("x")},
                    {cell(0), cell(1)},
                    {cell(1), cell(2)},
                    {raw_cell(formula), raw_cell(formula)},
                    {raw_cell(formula), raw_cell(formula)}};
  };
  for (const char* formula : {"<c r=\"@\"><f>A3+1</f><v></v></c>", "<c r=\"@\"><f>A3+1</f><v/></c>",
                              "<c r=\"@\"><f>A3+1</f></c>"}) {
    CAPTURE(formula);
    CHECK_THAT(refusal_of_sheet(rows(formula)), Contains("Log!A4 has a formula without"));
  }
  const TemporaryFolder folder;
  const auto path = folder.path() / "a.xlsx";
  const auto read_anew = [&](const std::string& formula, const std::string& computing) {
    auto parts = xlsx_parts({{"Log", sheet_xml({{cell("t"), cell("x")},
                                                {cell(0), raw_cell(formula)},
                                                {cell(1), raw_cell(formula)}})}});
    for (auto& [name, text] : parts)
      if (name == "xl/workbook.xml") text.insert(text.find("</workbook>"), computing);
    write_zip(path, parts);
    return message_when([&] { read_columns(path, {"t", "x"}, "t"); });
  };
  const std::string zero = "<c r=\"@\"><f>A2</f><v>0</v></c>";
  for (const std::string yes : {"1", "true"})
    CHECK_THAT(read_anew(zero, "<calcPr fullCalcOnLoad=\"" + yes + "\"/>"),
               Contains("Log!B2 has a formula without a stored result"));
  CHECK(read_anew(zero, "<calcPr/>") == "no error");
  CHECK(read_anew("<c r=\"@\"><f>A2</f><v>3</v></c>", "<calcPr fullCalcOnLoad=\"1\"/>") ==
        "no error");
}

TEST_CASE("load_xlsx: rows and cells out of order are refused", "[datasets]") {
  const auto refusal = [](const std::string& rows) {
    const TemporaryFolder folder;
    std::string sheet = sheet_xml({{cell("t"), cell("x")}});
    sheet.insert(sheet.find("</sheetData>"), rows);
    write_zip(folder.path() / "a.xlsx", xlsx_parts({{"Log", sheet}}));
    return read_refusal(folder.path() / "a.xlsx", {"t", "x"}, "t");
  };
  const auto row = [](int number, const std::string& cells) {
    return "<row r=\"" + std::to_string(number) + "\">" + cells + "</row>";
  };
  const std::string second = row(2, "<c r=\"A2\"><v>0</v></c><c r=\"B2\"><v>1</v></c>");
  CHECK(refusal(second) == "no error");
  CHECK_THAT(refusal(second + second), Contains("Log!A2 begins a row that is out of order"));
  CHECK_THAT(refusal(row(3, "") + second), Contains("out of order"));
  CHECK_THAT(refusal(row(2, "<c r=\"A2\"><v>0</v></c><c r=\"A2\"><v>1</v></c>")),
             Contains("out of order"));
  CHECK_THAT(refusal(row(2, "<c r=\"B2\"><v>0</v></c><c r=\"A2\"><v>1</v></c>")),
             Contains("out of order"));
  CHECK_THAT(refusal(row(2, "<c r=\"A3\"><v>0</v></c><c r=\"B3\"><v>1</v></c>")),
             Contains("out of order"));
  CHECK_THAT(refusal(second + "<c><v>1</v></c>"), Contains("out of order"));
  CHECK_THAT(refusal(second + "<x:row xmlns:x=\"urn:x\"/>"), Contains("of an unknown type"));
}

TEST_CASE("load_xlsx: columns beyond Z", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "wide.xlsx";
  XlsxRows rows(3);
  for (int column = 0; column < 60; ++column) {
    rows[0].push_back(cell("c" + std::to_string(column)));
    rows[1].push_back(cell(column));
    rows[2].push_back(cell(100 + column));
  }
  write_xlsx(path, {{"Log", rows}});
  CHECK(read_columns(path, {"c0", "c25", "c26", "c51", "c52", "c59"}) ==
        Table{{0, 100}, {25, 125}, {26, 126}, {51, 151}, {52, 152}, {59, 159}});
  rows[2][26] = cell("open");
  write_xlsx(path, {{"Log", rows}});
  CHECK_THAT(read_refusal(path, {"c26"}), Contains("Log!AA3 is the text 'open'"));
}

TEST_CASE("load_xlsx: sheets by their names", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.xlsx";
  const auto sheet = [](double from, int rows) {
    XlsxRows result{{cell("t"), cell("wow!x")}};
    for (int i = 0; i < rows; ++i) result.push_back({cell(i), cell(from + i)});
    return result;
  };
  write_xlsx(path, {{"One", sheet(1, 2)}, {"it's!", sheet(10, 2)}, {"Short", sheet(5, 1)}});
  CHECK(read_columns(path, {"One!t", "'it''s!'!wow!x", "wow!x", "it's!!t"}, "One!t") ==
        Table{{0, 1}, {10, 11}, {1, 2}, {0, 1}});
  const auto columns = xlsx_record_columns(path);
  REQUIRE(columns.size() == 6);
  CHECK(columns[3].name == "'it''s!'!wow!x");
  CHECK(read_columns(path, {columns[3].name}) == Table{{10, 11}});
  CHECK_THAT(read_refusal(path, {"t", "Short!t"}),
             Contains("'Short!t' has 1 rows, but 't' has 2; expected the same number"));
  CHECK_THAT(read_refusal(path, {"Shrt!t"}),
             Contains("unknown column 'Shrt!t'") && Contains("unknown sheet 'Shrt'; did you mean "
                                                             "'Short'?"));
  CHECK_THROWS_AS(read_columns(path, {"t"}, "x"), std::invalid_argument);
}

TEST_CASE("load_xlsx: what is no workbook", "[datasets]") {
  const TemporaryFolder folder;
  const auto message = [&](const std::string& name, const std::string& content) {
    return read_refusal(folder.write(name, content), {"t"});
  };
  CHECK_THAT(message("a.xlsx", "t,x\n0,1\n"), Contains("a.xlsx: is not an .xlsx file"));
  CHECK_THAT(message("b.xlsx", ""), Contains("is not an .xlsx file"));
  CHECK_THAT(message("c.xls", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1" + std::string(100, '\0')),
             Contains("the format before 2007 (.xls), or an encrypted one"));
  CHECK_THAT(message_when([&] {
               load_xlsx_record(folder.path(), {{"t"}, ""});
             }),
             Contains("is a folder; expected an .xlsx file"));
  CHECK_THAT(read_refusal(folder.path() / "none.xlsx", {"t"}), Contains("cannot be opened"));
  const auto archive = [&](const std::vector<std::pair<std::string, std::string>>& files) {
    write_zip(folder.path() / "z.xlsx", files);
    return read_refusal(folder.path() / "z.xlsx", {"t"});
  };
  CHECK_THAT(archive({{"mimetype", "application/vnd.oasis.opendocument.spreadsheet"}}),
             Contains("is a ZIP archive, but not an .xlsx workbook"));
  CHECK_THAT(archive({{"_rels/.rels",
                       "<Relationships><Relationship Id=\"r\" Type=\"x/"
                       "officeDocument\" Target=\"xl/workbook.bin\"/>"
                       "</Relationships>"}}),
             Contains("in another format (.xlsb)"));
  CHECK_THAT(archive({{"_rels/.rels", "<Relationships>"}}),
             Contains("is damaged in line 1 of its part '_rels/.rels'"));
  auto parts = xlsx_parts({{"A", sheet_xml({{cell("t")}, {cell(1)}})}});
  parts.front().second.insert(parts.front().second.find("<worksheet"),
                              "<!DOCTYPE x [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]>");
  CHECK_THAT(archive(parts), Contains("has a document type"));
  parts.erase(parts.begin());
  CHECK_THAT(archive(parts), Contains("lacks its part 'xl/worksheets/sheet1.xml'"));
  CHECK(record_reader("x.XLSX").name == "Excel");
  write_xlsx(folder.path() / "data.bin", {{"A", {{cell("t")}, {cell(1)}}}});
  CHECK(record_reader(folder.path() / "data.bin").name == "Excel");
}

TEST_CASE("load_xlsx: how the columns are labelled", "[datasets]") {
  const TemporaryFolder folder;
  const auto path = folder.path() / "run.xlsx";
  write_xlsx(path, {{"Log",
                     {{cell("t [s]"), cell("p"), cell("x")},
                      {cell("-"), cell("psi"), cell("-")},
                      {cell(0), cell(1), cell(2)}}}});
  const auto table = record_reader(path).load(path, {{"t", "p", "x"}, "t"});
  REQUIRE(table.labels.size() == 3);
  CHECK(table.labels[0].name == "t [s]");
  CHECK(table.labels[0].unit.empty());
  CHECK(table.labels[1].unit == "psi");
  CHECK(table.labels[1].place == "Log!B2");
  CHECK(table.labels[2].unit.empty());
}
