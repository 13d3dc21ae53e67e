#include "report/text_table.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::report;

TEST_CASE("TextTable: columns are aligned, lines end without blanks", "[report]") {
  TextTable table({{"name"}, {"value", TextTable::Align::right}, {"note"}});
  CHECK(table.empty());
  table.add({"a", "1.5", ""});
  table.add({"longer", "12345.5", "x"});
  CHECK(table.text() ==
        "name      value  note\n"
        "a           1.5\n"
        "longer  12345.5  x\n");
}

TEST_CASE("text_width: characters, not bytes", "[report]") {
  CHECK(text_width("33 %") == 4);
  CHECK(text_width("\xc3\xa4\xe2\x82\xac") == 2);
}
