#include "report/document/render_terminal.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "report/text/text_table.hpp"

using Catch::Contains;
using rigcal::report::Style;
namespace doc = rigcal::report::doc;

namespace {

const doc::Verdict kVerdict{{doc::State::good, "PASS"}, {"All is well."}};

std::string shown(doc::Blocks blocks, const Style& style = {}) {
  return doc::render_terminal({kVerdict, {}, {{"id", "Title", std::move(blocks)}}}, style);
}

doc::Table table_of(std::size_t rows) {
  doc::Table table{"label"};
  table.columns = {{"Name"}, {"Value", doc::Column::Kind::number}};
  for (std::size_t i = 0; i < rows; ++i)
    table.rows.push_back({{"row " + std::to_string(i), doc::Quantity{1.0, "1.0", "mm"}}});
  return table;
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("render_terminal: the verdict first, with its reasons and how many there are more",
          "[report]") {
  doc::Verdict verdict{{doc::State::bad, "FAIL"}, {"Beyond the limit."}};
  verdict.reasons = {{doc::Link{"#there", "rho2 is 0.9"}}};
  verdict.more = 2;
  CHECK(doc::render_terminal({verdict}, {}) ==
        "FAIL: Beyond the limit.\n  - rho2 is 0.9\n  and 2 more\n");
  Style style;
  style.colour = true;
  CHECK_THAT(doc::render_terminal({verdict}, style), Contains("\x1b[31mFAIL\x1b[0m"));
}

TEST_CASE("render_terminal: a cell of several lines keeps its column", "[report]") {
  doc::Table table = table_of(1);
  table.rows[0].cells[0].below = {{"second line"}};
  table.rows[0].notes = {"left out"};
  CHECK(shown({table}) ==
        "PASS: All is well.\n\nTitle\n"
        "Name          Value\n"
        "row 0        1.0 mm\n"
        "second line\n"
        "row 0 second line: left out\n");
}

TEST_CASE("render_terminal: a name with a line end does not break its row", "[report]") {
  doc::Table table = table_of(1);
  table.rows[0].cells[0] = doc::Cell("two\nlines");
  CHECK_THAT(shown({table}), Contains("two lines  1.0 mm\n"));
}

TEST_CASE("render_terminal: pictures, and columns and sections of nothing else, stay on the page",
          "[report]") {
  doc::Table table = table_of(2);
  table.columns.push_back({"Picture"});
  for (doc::Row& row : table.rows) {
    doc::Cell& cell = row.cells.emplace_back();
    cell.picture.emplace();
  }
  CHECK_THAT(shown({table}), !Contains("Picture"));
  doc::Gallery gallery;
  gallery.figures.emplace_back();
  const std::string text = shown({gallery, doc::Heading{{"Above a picture"}}, doc::Figure{}});
  CHECK(text == "PASS: All is well.\n");
  gallery.figures[0].reading = "It rises.";
  CHECK_THAT(shown({gallery}), Contains("Title\nIt rises.\n"));
}

TEST_CASE("render_terminal: a closed fold shows its warnings alone", "[report]") {
  const doc::List warnings{{{"the supply sagged"}}, doc::State::warn};
  doc::Fold fold{"Details", {table_of(1), warnings}};
  CHECK_THAT(shown({fold}),
             Contains("Details\nwarning: the supply sagged\n") && !Contains("row 0"));
  fold.open = true;
  CHECK_THAT(shown({fold}), Contains("row 0") && Contains("warning: the supply sagged"));
}

TEST_CASE("render_terminal: below a first page, sections only if asked for", "[report]") {
  doc::Document document{kVerdict};
  document.front = {doc::Doubts{{{"a doubt"}}, doc::Line{"2 warnings"}},
                    doc::Aspects{{{{doc::State::good, "pass"}, "Agreement", {{"all"}, {"good"}}}}},
                    doc::Paragraph{{"small print"}, doc::Paragraph::Tone::small}};
  document.sections = {{"one", "One", {table_of(1)}},
                       {"two", "Two", {doc::List{{{"w"}}, doc::State::warn}}}};
  document.sections[1].always = true;
  CHECK(doc::render_terminal(document, {}) ==
        "PASS: All is well.\n\nBefore you sign\n- a doubt\npass Agreement: all; good\n"
        "small print\n\nTwo\nwarning: w\n\n-v for more: One\n");
  Style style;
  style.everything = true;
  CHECK_THAT(doc::render_terminal(document, style),
             Contains("\nOne\nName") && !Contains("-v for more"));
}

TEST_CASE("render_terminal: a rendered page shows its blocks, a long list its first items",
          "[report]") {
  CHECK_THAT(shown({doc::Rendered{"<p>", {table_of(1)}}}), Contains("row 0") && !Contains("<p>"));
  doc::List list;
  for (int i = 0; i < 100; ++i) list.items.push_back({"item"});
  Style style;
  style.lines = 20;
  CHECK_THAT(shown({list}, style), Contains("and 84 more (-v for all)"));
}

TEST_CASE("render_terminal: as many rows as find room, and the rest is counted", "[report]") {
  Style style;
  style.lines = 20;
  const std::string text = shown({table_of(100), table_of(3)}, style);
  CHECK(lines_of(text) <= style.lines);
  CHECK_THAT(text, Contains("and 90 more (-v for all)\n\nName "));
  CHECK(lines_of(shown({table_of(100)})) > 100);
  CHECK_THAT(shown({table_of(5)}, style), !Contains("more"));
}

TEST_CASE("render_terminal: the first table, which has the result itself, keeps eight rows",
          "[report]") {
  Style style;
  style.lines = 12;
  const std::string text = shown({table_of(8), table_of(100)}, style);
  CHECK_THAT(text, Contains("row 7") && Contains("and 99 more"));
}

TEST_CASE("render_terminal: prose is broken, in a table too", "[report]") {
  doc::Table table = table_of(1);
  std::string prose;
  for (int i = 0; i < 40; ++i) prose += "word ";
  table.columns.push_back({"Why", doc::Column::Kind::words});
  table.rows[0].cells.emplace_back(prose);
  Style style;
  style.columns = 80;
  const std::string text = shown({table, doc::reading(prose)}, style);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    CHECK(rigcal::report::text_width(std::string_view(text).substr(begin, end - begin)) <= 80);
    begin = end + 1;
  }
}
