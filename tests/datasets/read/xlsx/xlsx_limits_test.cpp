#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "datasets/read/xlsx/load_xlsx.hpp"
#include "datasets/read/xlsx/xlsx_book.hpp"
#include "datasets/read/xlsx/xlsx_date_format.hpp"
#include "tests/datasets/reading.hpp"
#include "tests/datasets/xlsx_fixture.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests the largest contents of an .xlsx file that are accepted, and the smallest that are refused.

namespace rigcal::test {
namespace {

using Catch::Contains;
using datasets::xlsx_address;
using Parts = std::vector<std::pair<std::string, std::string>>;

/// Returns a sheet with the given rows as XML.
std::string sheet_of(const std::string& rows, const std::string& behind = "") {
  return "<worksheet><sheetData>" + rows + "</sheetData>" + behind + "</worksheet>";
}

std::string text_cell(const std::string& address, const std::string& text) {
  return fmt::format("<c r=\"{}\" t=\"inlineStr\"><is><t>{}</t></is></c>", address, text);
}
std::string number_cell(const std::string& address, double value) {
  return fmt::format("<c r=\"{}\"><v>{}</v></c>", address, value);
}
std::string row(std::size_t number, const std::string& cells) {
  return fmt::format("<row r=\"{}\">{}</row>", number, cells);
}
const std::string kHeader = row(1, text_cell("A1", "t") + text_cell("B1", "x"));
std::string numbers(std::size_t number, double t, double x) {
  return row(number, number_cell(fmt::format("A{}", number), t) +
                         number_cell(fmt::format("B{}", number), x));
}

/// A workbook and the result of reading it: numbers, or a refusal.
class Book {
 public:
  explicit Book(const Parts& parts) { write_zip(path(), parts); }
  explicit Book(const std::string& sheet) : Book(xlsx_parts({{"Log", sheet}})) {}

  std::filesystem::path path() const { return folder_ / "a.xlsx"; }
  Table read(const std::vector<std::string>& columns = {"t", "x"}) const {
    return read_columns(path(), columns);
  }
  std::string refusal(const std::vector<std::string>& columns = {"t", "x"}) const {
    return read_refusal(path(), columns);
  }

 private:
  TemporaryFolder folder_;
};

/// Replaces the content of the part with this name.
Parts with_part(Parts parts, const std::string& name, const std::string& content) {
  for (auto& [part, text] : parts)
    if (part == name) text = content;
  return parts;
}

}  // namespace

TEST_CASE("xlsx address: columns count on behind Z as A, B, .., Z, AA", "[datasets]") {
  const std::vector<std::pair<std::size_t, std::string>> columns{
      {1, "A"},     {2, "B"},     {25, "Y"},    {26, "Z"},     {27, "AA"},    {28, "AB"},
      {51, "AY"},   {52, "AZ"},   {53, "BA"},   {676, "YZ"},   {677, "ZA"},   {702, "ZZ"},
      {703, "AAA"}, {728, "AAZ"}, {729, "ABA"}, {1378, "AZZ"}, {16384, "XFD"}};
  for (const auto& [number, letters] : columns) {
    CHECK(xlsx_address(1, number) == letters + "1");
    CHECK(xlsx_address(1'048'576, number) == letters + "1048576");
  }
}

TEST_CASE("load_xlsx: columns stand where their addresses say, up to XFD", "[datasets]") {
  const auto sheet = [](const std::string& first, const std::string& second) {
    return sheet_of(row(1, text_cell(first + "1", "t") + text_cell(second + "1", "x")) +
                    row(2, number_cell(first + "2", 0.5) + number_cell(second + "2", 7)) +
                    row(3, number_cell(first + "3", 1.5) + number_cell(second + "3", 8)));
  };
  for (const auto& [first, second] :
       std::vector<std::pair<std::string, std::string>>{{"A", "B"},
                                                        {"Y", "Z"},
                                                        {"Z", "AA"},
                                                        {"AA", "AB"},
                                                        {"AZ", "BA"},
                                                        {"ZZ", "AAA"},
                                                        {"AAZ", "ABA"},
                                                        {"C", "XFD"}}) {
    CAPTURE(first, second);
    CHECK(Book(sheet(first, second)).read() == Table{{0.5, 1.5}, {7, 8}});
  }
  for (const char* beyond : {"XFE", "ZZZ", "AAAA", "AAAAA"}) {
    CAPTURE(beyond);
    CHECK_THAT(Book(sheet("A", beyond)).refusal(), Contains("is out of order"));
  }
  // The message about a gap gives the address, also for columns after Z.
  CHECK_THAT(Book(sheet_of(row(1, text_cell("Z1", "t") + text_cell("AB1", "x")) +
                           row(2, number_cell("Z2", 0) + number_cell("AB2", 7)) +
                           row(3, number_cell("Z3", 1)) + row(4, number_cell("Z4", 2))))
                 .refusal(),
             Contains("Log!AB3 is empty"));
}

TEST_CASE("load_xlsx: an address that is none is refused", "[datasets]") {
  for (const char* address : {"a2", "A0", "A", "2", "A2x", "A-2", "$A$2", "", "A 2", "AA2AA"}) {
    CAPTURE(address);
    CHECK_THAT(
        Book(sheet_of(kHeader + row(2, number_cell(address, 1)) + numbers(3, 1, 2))).refusal(),
        Contains("is out of order"));
  }
}

TEST_CASE("load_xlsx: a row given twice, or out of order, is refused", "[datasets]") {
  const std::string good = kHeader + numbers(2, 0, 1) + numbers(3, 1, 2);
  CHECK(Book(sheet_of(good)).read() == Table{{0, 1}, {1, 2}});
  for (const std::string& rows :
       {good + numbers(3, 2, 3), good + numbers(2, 2, 3), good + numbers(1, 2, 3),
        kHeader + numbers(2, 0, 1) + numbers(2, 1, 2) + numbers(3, 2, 3),
        kHeader + numbers(3, 0, 1) + numbers(2, 1, 2), kHeader + kHeader + numbers(2, 0, 1)}) {
    CHECK_THAT(Book(sheet_of(rows)).refusal(), Contains("begins a row that is out of order"));
  }
  for (const char* number : {"0", "-1", "x", "", "2.0"})
    CHECK_THAT(Book(sheet_of(kHeader + fmt::format("<row r=\"{}\"></row>", number))).refusal(),
               Contains("begins a row that is out of order"));
}

TEST_CASE("load_xlsx: rows and cells without a number count on", "[datasets]") {
  const std::string one = "<c><v>1</v></c>";
  // Cells without an address continue: row 2 follows row 1, and C follows B.
  CHECK(Book(sheet_of(kHeader + "<row><c><v>0</v></c><c><v>5</v></c></row>" + numbers(3, 1, 6)))
            .read() == Table{{0, 1}, {5, 6}});
  CHECK(Book(sheet_of(row(4, text_cell("B4", "t") + "<c t=\"inlineStr\"><is><t>x</t></is></c>") +
                      "<row>" + number_cell("B5", 3) + "<c><v>4</v></c></row>"))
            .read() == Table{{3}, {4}});
  CHECK_THAT(Book(sheet_of(row(4, text_cell("B4", "t") + text_cell("C4", "x")) + "<row>" +
                           number_cell("B4", 3) + one + "</row>"))
                 .refusal(),
             Contains("is out of order"));
  CHECK_THAT(Book(sheet_of(kHeader + "<row><c/><c/></row>" + numbers(9, 3, 4))).refusal(),
             Contains("Log!A2 is empty"));
}

TEST_CASE("load_xlsx: a cell given twice, or out of order, is refused", "[datasets]") {
  const auto refusal = [](const std::string& cells) {
    return Book(sheet_of(kHeader + numbers(2, 0, 1) + row(3, cells))).refusal();
  };
  const std::string a = number_cell("A3", 1);
  const std::string b = number_cell("B3", 2);
  CHECK(refusal(a + b) == "no error");
  for (const std::string& cells :
       {a + a + b, a + b + b, b + a, a + b + a, number_cell("A2", 1) + b, a + number_cell("B4", 2),
        a + number_cell("B2", 2), b + "<c r=\"A3\"/>", a + a}) {
    CAPTURE(cells);
    CHECK_THAT(refusal(cells), Contains("Log!") && Contains("is out of order"));
  }
  // This also applies to a column that is not wanted.
  CHECK_THAT(refusal(a + b + number_cell("C3", 1) + number_cell("C3", 2)),
             Contains("is out of order"));
}

TEST_CASE("load_xlsx: at most as many rows as Excel has", "[datasets]") {
  const auto note_in = [](std::size_t number) {
    return Book(sheet_of(kHeader + numbers(2, 0, 1) +
                         row(number, text_cell(fmt::format("C{}", number), "note"))));
  };
  CHECK(note_in(1'048'576).read() == Table{{0}, {1}});
  CHECK_THAT(note_in(1'048'577).refusal(), Contains("begins a row that is out of order"));
}

TEST_CASE("load_xlsx: a cell holds four times 32 767 bytes of text at most", "[datasets]") {
  const auto with_note = [](std::size_t bytes) {
    return Book(sheet_of(kHeader + row(2, number_cell("A2", 0) + number_cell("B2", 1) +
                                              text_cell("C2", std::string(bytes, 'n')))));
  };
  CHECK(with_note(131'068).read() == Table{{0}, {1}});
  CHECK_THAT(with_note(131'069).refusal(), Contains("Log!C2 has more text than a cell may have"));
}

TEST_CASE("load_xlsx: a sheet may have more than a part and a tag may", "[datasets]") {
  std::string rows = kHeader;
  for (std::size_t i = 0; i < 30'000; ++i) rows += numbers(i + 2, 0.5 * static_cast<double>(i), 1);
  REQUIRE(rows.size() > (std::size_t{2} << 20));
  const Table table = Book(sheet_of(rows)).read();
  REQUIRE(table[0].size() == 30'000);
  CHECK(table[0].back() == 0.5 * 29'999);
  // There are more than 64 MB of blanks between the rows.
  CHECK(Book(sheet_of(kHeader + numbers(2, 0, 1) + std::string(std::size_t{70} << 20, ' ') +
                      numbers(3, 1, 2)))
            .read() == Table{{0, 1}, {1, 2}});
}

TEST_CASE("load_xlsx: a tag or comment may have 1 MB", "[datasets]") {
  const auto with_comment = [](std::size_t bytes) {
    return Book(with_part(xlsx_parts({{"Log", sheet_of(kHeader + numbers(2, 0, 1))}}),
                          "xl/styles.xml",
                          "<styleSheet><!--" + std::string(bytes, '.') + "--></styleSheet>"));
  };
  CHECK(with_comment(950'000).read() == Table{{0}, {1}});
  CHECK_THAT(with_comment(1'200'000).refusal(), Contains("of more than 1 MB"));
}

TEST_CASE("load_xlsx: an archive holds 10 000 files at most", "[datasets]") {
  Parts parts = xlsx_parts({{"Log", sheet_of(kHeader + numbers(2, 0, 1))}});
  while (parts.size() < 10'000) parts.emplace_back(fmt::format("x/{}", parts.size()), "");
  CHECK(Book(parts).read() == Table{{0}, {1}});
  parts.emplace_back("x/one more", "");
  CHECK_THAT(Book(parts).refusal(), Contains("is an archive of more than 10000 files"));
}

TEST_CASE("load_xlsx: 12 million numbers of one file, over all sheets", "[datasets]") {
  constexpr std::size_t kRows = 50'000;
  std::string rows = kHeader;
  for (std::size_t i = 0; i < kRows; ++i)
    rows += numbers(i + 2, static_cast<double>(i), -static_cast<double>(i));
  const Book book(xlsx_parts({{"A", sheet_of(rows)}, {"B", sheet_of(rows)}}));
  // A column requested twice counts twice.
  std::vector<std::string> columns(239, "A!t");
  columns.emplace_back("B!x");
  const Table most = book.read(columns);
  REQUIRE(most.size() == 240);
  CHECK(most.back().back() == -49'999);
  columns.emplace_back("B!t");
  CHECK_THAT(book.refusal(columns),
             Contains("B!A") && Contains("is beyond 12000000 numbers, the limit of one file"));
  columns.assign(240, "A!t");
  columns.emplace_back("B!x");
  CHECK_THAT(book.refusal(columns), Contains("B!B2 is beyond 12000000 numbers"));
}

TEST_CASE("load_xlsx: columns of unequal length are refused by the cell that is missing",
          "[datasets]") {
  const auto refusal = [](const std::string& rows) {
    return Book(
               sheet_of(row(1, text_cell("A1", "t") + text_cell("B1", "x") + text_cell("C1", "y")) +
                        rows))
        .refusal({"t", "x", "y"});
  };
  const auto cells = [](std::size_t number, const std::string& which) {
    std::string text;
    for (const char letter : which)
      text += number_cell(letter + std::to_string(number), static_cast<double>(number));
    return row(number, text);
  };
  CHECK(refusal(cells(2, "ABC") + cells(3, "ABC")) == "no error");
  CHECK_THAT(refusal(cells(2, "ABC") + cells(3, "BC")), Contains("Log!A3 is empty"));
  CHECK_THAT(refusal(cells(2, "ABC") + cells(3, "AC")), Contains("Log!B3 is empty"));
  CHECK_THAT(refusal(cells(2, "ABC") + cells(3, "AB")), Contains("Log!C3 is empty"));
  CHECK_THAT(refusal(cells(2, "ABC") + cells(3, "C") + cells(4, "ABC")),
             Contains("Log!A3 is empty"));
  CHECK_THAT(refusal(cells(2, "AB") + cells(3, "ABC")), Contains("Log!C2 is empty"));
  CHECK_THAT(refusal(cells(2, "ABC") + cells(4, "ABC")), Contains("Log!A3 is empty"));
  // If the columns are on two sheets, the message names the columns.
  const std::string two = sheet_of(kHeader + numbers(2, 0, 1) + numbers(3, 1, 2));
  const std::string three =
      sheet_of(kHeader + numbers(2, 0, 1) + numbers(3, 1, 2) + numbers(4, 2, 3));
  const Book book(xlsx_parts({{"A", two}, {"B", three}}));
  CHECK_THAT(book.refusal({"A!t", "A!x", "B!t"}),
             Contains("'B!t' has 3 rows, but 'A!t' has 2; expected the same number"));
  CHECK_THAT(book.refusal({"B!t", "A!t"}), Contains("'A!t' has 2 rows, but 'B!t' has 3"));
}

TEST_CASE("load_xlsx: a merged range holds its corners, and nothing beside them", "[datasets]") {
  const datasets::XlsxMerged range{"C4:E6", 4, 3, 6, 5};
  for (const std::size_t at : {3U, 4U, 5U, 6U, 7U})
    for (const std::size_t column : {2U, 3U, 4U, 5U, 6U})
      CHECK(range.holds(at, column) == (at >= 4 && at <= 6 && column >= 3 && column <= 5));
  const auto refusal = [](const std::string& merged) {
    return Book(sheet_of(
                    kHeader + numbers(2, 0, 1) + row(3, number_cell("A3", 1)) + numbers(4, 2, 3),
                    "<mergeCells>" + merged + "</mergeCells>"))
        .refusal();
  };
  CHECK_THAT(refusal("<mergeCell ref=\"B2:B3\"/>"), Contains("belongs to the merged cells B2:B3"));
  CHECK_THAT(refusal("<mergeCell ref=\"B3:D3\"/>"), Contains("belongs to the merged cells B3:D3"));
  CHECK_THAT(refusal("<mergeCell ref=\"D9:E9\"/><mergeCell ref=\"A3:B3\"/>"),
             Contains("belongs to the merged cells A3:B3"));
  for (const char* other : {"B3", "B4:B5", "A1:B2", "C3:D3", "B2:", ":B3", "b2:b3", "B0:B3",
                            "B2:B1048577", "B2:XFE9"}) {
    CAPTURE(other);
    CHECK_THAT(refusal(fmt::format("<mergeCell ref=\"{}\"/>", other)),
               Contains("Log!B3 is empty, but rows follow"));
  }
}

TEST_CASE("load_xlsx: a row of units stands right below the header and holds units only",
          "[datasets]") {
  const auto units_of = [](const std::string& first, const std::string& second) {
    const Book book(sheet_of(kHeader + row(2, text_cell("A2", first) + text_cell("B2", second)) +
                             numbers(3, 0, 1) + numbers(4, 1, 2)));
    const auto columns = datasets::xlsx_record_columns(book.path());
    REQUIRE(columns.size() == 2);
    if (columns[0].unit.empty() && columns[1].unit.empty()) return book.refusal();
    CHECK(book.read() == Table{{0, 1}, {1, 2}});
    return columns[0].unit + "|" + columns[1].unit;
  };
  CHECK(units_of("s", "mm") == "s|mm");
  CHECK(units_of("[ms]", "(bar)") == "ms|bar");
  CHECK(units_of("s", "-") == "s|");
  CHECK(units_of("s", "[-]") == "s|");
  CHECK_THAT(units_of("s", "open"), Contains("Log!A2 is the text 's'"));
  CHECK_THAT(units_of("[s)", "mm"), Contains("Log!A2 is the text '[s)'"));
  CHECK_THAT(units_of("s]", "mm"), Contains("Log!A2 is the text 's]'"));
  // With a number in it, the row is a row of numbers rather than units.
  CHECK_THAT(Book(sheet_of(kHeader + row(2, text_cell("A2", "s") + number_cell("B2", 1)) +
                           numbers(3, 0, 1)))
                 .refusal(),
             Contains("Log!A2 is the text 's'"));
  CHECK_THAT(Book(sheet_of(kHeader + row(3, text_cell("A3", "s") + text_cell("B3", "mm")) +
                           numbers(4, 0, 1)))
                 .refusal(),
             Contains("Log!A2 is empty"));
  // A unit outside the table does not matter.
  CHECK(Book(sheet_of(kHeader +
                      row(2, text_cell("A2", "s") + text_cell("B2", "mm") + text_cell("F2", "m")) +
                      numbers(3, 0, 1)))
            .read() == Table{{0}, {1}});
}

TEST_CASE("load_xlsx: which cells show a date, by the style of the cell", "[datasets]") {
  const auto refusal = [](const std::string& styles, const std::string& style) {
    return Book(with_part(xlsx_parts(
                              {{"Log",
                                sheet_of(kHeader +
                                         row(2, number_cell("A2", 0) +
                                                    fmt::format("<c r=\"B2\" s=\"{}\"><v>5</v></c>",
                                                                style)))}}),
                          "xl/styles.xml", "<styleSheet>" + styles + "</styleSheet>"))
        .refusal();
  };
  const std::string cells =
      "<cellStyleXfs><xf numFmtId=\"14\"/></cellStyleXfs>"
      "<cellXfs><xf numFmtId=\"0\"/><xf numFmtId=\"22\"/><xf/></cellXfs>"
      "<dxfs><xf numFmtId=\"14\"/></dxfs>";
  CHECK(refusal(cells, "0") == "no error");
  CHECK_THAT(refusal(cells, "1"), Contains("Log!B2 shows a date or a time of day"));
  for (const char* none : {"2", "3", "-1", "x", ""}) CHECK(refusal(cells, none) == "no error");
  // A format defined in the workbook overrides the built-in format with the same number.
  CHECK(refusal("<numFmts><numFmt numFmtId=\"22\" formatCode=\"0.00\"/></numFmts>" + cells, "1") ==
        "no error");
  CHECK_THAT(
      refusal("<numFmts><numFmt numFmtId=\"0\" formatCode=\"hh:mm\"/></numFmts>" + cells, "0"),
      Contains("Log!A2 shows a date"));
}

TEST_CASE("xlsx_date_format: by number, at the ends of every range", "[datasets]") {
  const std::set<long> dates{14, 15, 16, 17, 18, 19, 20, 21, 22, 27, 28, 29, 30, 31, 32, 33,
                             34, 35, 36, 45, 46, 47, 50, 51, 52, 53, 54, 55, 56, 57, 58};
  for (long number = -1; number <= 200; ++number) {
    CAPTURE(number);
    CHECK(datasets::is_date_format(number) == dates.contains(number));
  }
}

TEST_CASE("xlsx_date_format: by its letters, outside of texts and brackets", "[datasets]") {
  using datasets::is_date_format;
  for (const char* code : {"d",   "m",    "y",      "h",    "s",     "D",   "M",      "Y",   "H",
                           "S",   "0d",   "\"x\"d", "\\xd", "_dd",   "*dd", "[Red]d", "[h]", "[HH]",
                           "[m]", "[mm]", "[s]",    "[SS]", "0.0;d", "[]d", "\"\"d"}) {
    CAPTURE(code);
    CHECK(is_date_format(std::string_view(code)));
  }
  for (const char* code :
       {"",    "0",   "General", "GENERAL",      "Standard", "\"d\"", "\"day\"0", "\\d",
        "_d",  "*d",  "0\\d0",   "[d]",          "[Red]0",   "[]0",   "[h",       "0[h",
        "\"d", "E+0", "@",       "0.0\\ \"mm\"", "\\",       "_",     "*"}) {
    CAPTURE(code);
    CHECK_FALSE(is_date_format(std::string_view(code)));
  }
}

TEST_CASE("load_xlsx: parts by their references, whatever these look like", "[datasets]") {
  const Parts parts = xlsx_parts({{"Log", sheet_of(kHeader + numbers(2, 0, 1))}});
  const auto with_target = [&](const std::string& target, const std::string& kind = "worksheet") {
    return Book(with_part(parts, "xl/_rels/workbook.xml.rels",
                          fmt::format("<Relationships><Relationship Id=\"rId1\" Type=\"x/{}\" "
                                      "Target=\"{}\"/></Relationships>",
                                      kind, target)));
  };
  for (const char* target :
       {"worksheets/sheet1.xml", "/xl/worksheets/sheet1.xml",
        "./worksheets/../worksheets/sheet1.xml", "../xl/worksheets/sheet1.xml"}) {
    CAPTURE(target);
    CHECK(with_target(target).read() == Table{{0}, {1}});
  }
  CHECK_THAT(with_target("worksheets/sheet1.xml", "chartsheet").refusal(),
             Contains("contains no worksheet"));
  CHECK_THAT(with_target("sheet1.xml").refusal(), Contains("lacks its part 'xl/sheet1.xml'"));
  CHECK_THAT(with_target("../sheet1.xml").refusal(), Contains("lacks its part 'sheet1.xml'"));
}

TEST_CASE("load_xlsx: two sheets of one part are refused, not read twice", "[datasets]") {
  const std::string log = sheet_of(kHeader + numbers(2, 0, 1));
  const Parts parts = xlsx_parts({{"Log", log}, {"Copy", log}});
  CHECK(Book(parts).read() == Table{{0}, {1}});
  std::string references;
  for (const char* id : {"rId1", "rId2"})
    references += fmt::format(
        "<Relationship Id=\"{}\" Type=\"x/worksheet\" Target=\"worksheets/sheet1.xml\"/>", id);
  CHECK_THAT(Book(with_part(parts, "xl/_rels/workbook.xml.rels",
                            "<Relationships>" + references + "</Relationships>"))
                 .refusal(),
             Contains("'Log' and 'Copy' in one part"));
}

TEST_CASE("load_xlsx: the header is the first row that holds something and is no comment",
          "[datasets]") {
  CHECK(Book(sheet_of(row(3, text_cell("A3", "# a comment") + number_cell("B3", 1)) +
                      row(5, text_cell("A5", "t") + text_cell("B5", "x")) + numbers(6, 0, 1)))
            .read() == Table{{0}, {1}});
  // A row that begins with another cell is not a row of names.
  CHECK_THAT(Book(sheet_of(row(1, text_cell("A1", "t") + text_cell("B1", "#x")) + numbers(2, 0, 1)))
                 .refusal(),
             Contains("unknown column 'x'"));
  // A number among the names does not turn the row into a row of numbers.
  CHECK(Book(sheet_of(row(1, text_cell("A1", "t") + text_cell("B1", "x") + number_cell("C1", 7)) +
                      numbers(2, 0, 1)))
            .read() == Table{{0}, {1}});
  CHECK_THAT(Book(sheet_of(row(2, number_cell("A2", 1) + number_cell("D2", 7)) + numbers(3, 0, 1)))
                 .refusal(),
             Contains("Log!D2 and the rest of its row are numbers"));
  // Sheets without names, and columns without a name, are not listed.
  const Book book(xlsx_parts({{"Numbers", sheet_of(numbers(1, 0, 1))},
                              {"Gap", sheet_of(row(1, text_cell("A1", "t") + text_cell("C1", "x")) +
                                               row(2, number_cell("A2", 0)))}}));
  std::vector<std::string> names;
  for (const auto& column : datasets::xlsx_record_columns(book.path()))
    names.push_back(column.name);
  CHECK(names == std::vector<std::string>{"Gap!t", "Gap!x"});
}

TEST_CASE("load_xlsx: only the column of times must increase", "[datasets]") {
  const Book book(sheet_of(kHeader + numbers(2, 0, 1) + numbers(3, 1, 1) + numbers(4, 2, 0)));
  CHECK(read_columns(book.path(), {"t", "x"}, "t") == Table{{0, 1, 2}, {1, 1, 0}});
  CHECK_THAT(read_refusal(book.path(), {"t", "x"}, "x"),
             Contains("Log!B3 is 1 after 1: time 'x' does not increase"));
  const Book back(sheet_of(kHeader + numbers(2, 0, 1) + numbers(3, -1, 1)));
  CHECK_THAT(read_refusal(back.path(), {"t", "x"}, "t"), Contains("Log!A3 is -1 after 0"));
  CHECK(read_columns(back.path(), {"t", "x"}) == Table{{0, -1}, {1, 1}});
}

TEST_CASE("is_xlsx_file: by name or by the first bytes", "[datasets]") {
  CHECK(datasets::is_xlsx_file({".xlsx", ""}));
  CHECK(datasets::is_xlsx_file({".xlsm", ""}));
  CHECK(datasets::is_xlsx_file({".dat", "PK\x03\x04rest"}));
  CHECK(datasets::is_xlsx_file({".xls", "\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1rest"}));
  CHECK_FALSE(datasets::is_xlsx_file({".csv", "t,x"}));
  CHECK_FALSE(datasets::is_xlsx_file({".dat", "PK\x05\x06"}));
  CHECK_FALSE(datasets::is_xlsx_file({".dat", " PK\x03\x04"}));
  CHECK_FALSE(datasets::is_xlsx_file({".xls", "\xD0\xCF\x11\xE0"}));
}

}  // namespace rigcal::test
