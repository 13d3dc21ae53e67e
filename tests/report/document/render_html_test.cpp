#include "report/document/render_html.hpp"

#include <catch2/catch.hpp>

using Catch::Contains;
namespace doc = rigcal::report::doc;

namespace {

const std::string kHostileText = "</p><script>alert(1)</script>\"'&";

std::string drawn_blocks(const doc::Blocks& blocks) {
  std::string page;
  doc::render_html(blocks, page);
  return page;
}

}  // namespace

TEST_CASE("render_html: whatever stands in a document is text", "[report]") {
  const doc::Line every{kHostileText,
                        doc::Quantity{1.0, kHostileText, kHostileText},
                        doc::Badge{doc::State::warn, kHostileText},
                        doc::Mark{doc::State::bad, kHostileText},
                        doc::Link{"#" + kHostileText, kHostileText},
                        doc::Soft{kHostileText},
                        doc::Symbol{kHostileText},
                        doc::Strong{kHostileText},
                        doc::Code{kHostileText}};
  doc::Table table{kHostileText, every};
  table.style = "list";
  table.columns = {{kHostileText, doc::Column::Kind::number, 0, kHostileText}};
  doc::Cell cell{every};
  cell.below = {every};
  cell.paragraphs = {every};
  cell.tiles = {
      {{doc::State::good, kHostileText}, every, {every}, "#" + kHostileText, kHostileText}};
  table.rows = {{{cell}, {kHostileText}, kHostileText}};
  doc::Facts facts{kHostileText, {{kHostileText, every}}, every};
  const std::string page = drawn_blocks(
      {doc::Paragraph{every}, doc::Heading{every}, doc::List{{every}, doc::State::bad}, facts,
       table, doc::Verdict{{doc::State::good, kHostileText}, every, {every}, 2},
       doc::Doubts{{every}},
       doc::Aspects{{{{doc::State::none, kHostileText}, kHostileText, {every}}}},
       doc::Signatures{{{kHostileText, kHostileText}}}, doc::Command{kHostileText},
       doc::Fold{kHostileText, {doc::Paragraph{every}}}, doc::Article{kHostileText, every, {}},
       doc::Sketches{{{kHostileText, {doc::State::good, kHostileText}, every, "{}"}}}});
  CHECK_THAT(page, !Contains("<script>") && !Contains("\"'&"));
  CHECK_THAT(page, Contains("&lt;script&gt;alert(1)"));
  std::string section;
  doc::render_html(doc::Section{kHostileText, kHostileText, {}}, section);
  CHECK_THAT(section, !Contains("<script>"));
}

TEST_CASE("render_html: rows and items beyond the most are counted", "[report]") {
  doc::Table table{"tests"};
  table.columns = {{"Name"}};
  table.most = 3;
  table.file = "fit.json";
  for (int i = 0; i < 5; ++i) table.rows.push_back({{"row " + std::to_string(i)}});
  const std::string page = drawn_blocks({table});
  CHECK_THAT(page, Contains("row 2") && !Contains("row 3") && Contains("2 more, in fit.json."));
  doc::List list;
  for (int i = 0; i < 250; ++i) list.items.push_back({"item " + std::to_string(i)});
  const std::string items = drawn_blocks({list});
  CHECK_THAT(items, Contains("item 99<") && !Contains("item 100<") && Contains("150 more."));
  list.items.resize(100);
  CHECK_THAT(drawn_blocks({list}), Contains("item 99<") && !Contains(" more."));
}

TEST_CASE("render_html: a number keeps its exact value beside what is shown", "[report]") {
  CHECK(doc::html({doc::Quantity{0.0508, "50.8", "mm"}}) ==
        "<data value=\"0.0508\">50.8</data> mm");
  CHECK(doc::html({doc::Quantity{}}) == "–");
}

TEST_CASE("render_html: a state has its mark and its words, never colour alone", "[report]") {
  CHECK(doc::html({doc::Badge{doc::State::warn, "weak"}}) ==
        "<span class=\"tag warn\"><span aria-hidden=\"true\">!</span> weak</span>");
  CHECK(doc::html({doc::Mark{doc::State::good, "passed"}}) ==
        "<span class=\"tag good\" role=\"img\" aria-label=\"passed\">✓</span>");
}

TEST_CASE("render_html: a table has a caption, scopes and a label for a screen reader",
          "[report]") {
  doc::Table table{"Numbers"};
  table.shape = doc::Table::Shape::cards;
  table.heading = 1;
  table.columns = {
      {"No."}, {"Name"}, {"Value", doc::Column::Kind::number}, {"Unit", doc::Column::Kind::unit}};
  table.rows = {{{"1", "mass", doc::Quantity{85.0, "85"}, "kg"}, {"well known"}}};
  const std::string page = drawn_blocks({table});
  CHECK_THAT(page, Contains("role=\"region\" aria-label=\"Numbers\""));
  CHECK_THAT(page, Contains("<caption class=\"hidden\">Numbers</caption>"));
  CHECK_THAT(page,
             Contains("<th scope=\"row\">mass</th>") && Contains("<th scope=\"col\" class=\"n\">"));
  // On a card the unit is beside the value.
  CHECK_THAT(page, Contains("data-label=\"Value\"><data value=\"85\">85</data><span "
                            "class=\"beside-value\"> kg</span></td>"));
  CHECK_THAT(page, Contains("<tr class=\"note\"><td colspan=\"4\">"));
}

TEST_CASE("render_html: what is empty leaves no trace", "[report]") {
  CHECK(drawn_blocks({doc::List{}, doc::Facts{}, doc::Gallery{}, doc::Doubts{}, doc::Signatures{}})
            .empty());
}
