#include "report/text/text_table.hpp"

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

TEST_CASE("TextTable: a narrow terminal gets what cannot be spared", "[report]") {
  TextTable table(
      {{"name"}, {"note", TextTable::Align::left, 1}, {"more", TextTable::Align::left, 2}});
  table.add({"a", "123456", "x"});
  CHECK(table.text(18) == table.text());
  CHECK(table.text(17) == "name  note\na     123456\n");
  CHECK(table.left_out(17) == std::vector<std::string>{"more"});
  CHECK(table.text(1) == "name\na\n");
  CHECK(table.left_out(0).empty());
}

TEST_CASE("text_width: characters, not bytes", "[report]") {
  CHECK(text_width("\x1b[32mPASS\x1b[0m") == 4);
  CHECK(text_width("\x1b[") == 0);
  CHECK(text_width("33 %") == 4);
  CHECK(text_width("\xc3\xa4\xe2\x82\xac") == 2);
}

TEST_CASE("wrapped: broken between words, later lines indented", "[report]") {
  CHECK(wrapped("  one two three", 9, 4) == "  one two\n    three");
  CHECK(wrapped("one two three", 0, 4) == "one two three");
  CHECK(wrapped("one two", 7, 2) == "one two");
  CHECK(wrapped("a verylongword b", 6, 2) == "a\n  verylongword\n  b");
}

TEST_CASE("TextTable: a name of several lines takes one", "[report]") {
  TextTable table({{"name"}, {"verdict"}});
  table.add({"a\nb\x1b[2J", "\x1b[1;32mPASS\x1b[0m"});
  CHECK(table.text() == "name     verdict\na b [2J  \x1b[1;32mPASS\x1b[0m\n");
}

TEST_CASE("TextTable: what is too wide follows in blocks, each with its keys", "[report]") {
  TextTable table({{"rig"}, {"level"}, {"first"}, {"second"}, {"third"}}, 2);
  table.add({"a", "0 %", "1", "2", "3"});
  CHECK(table.text(19) ==
        "rig  level  first\na    0 %    1\n"
        "rig  level  second\na    0 %    2\n"
        "rig  level  third\na    0 %    3\n");
  CHECK(table.text(26) ==
        "rig  level  first  second\na    0 %    1      2\n"
        "rig  level  third\na    0 %    3\n");
  CHECK(table.text(1) == table.text(19));  // narrower than a column, so each block has one column
  CHECK(table.text(0) == "rig  level  first  second  third\na    0 %    1      2       3\n");
}

TEST_CASE("TextTable: a column wider than the terminal is broken within itself", "[report]") {
  TextTable table({{"rig"}, {"estimates"}}, 1);
  table.add({"bench", "mass 85.01 kg bulk modulus"});
  table.add({"b", "x"});
  CHECK(table.text(23) ==
        "rig    estimates\nbench  mass 85.01 kg\n         bulk modulus\nb      x\n");
  CHECK(table.text(33) == table.text());
}

TEST_CASE("wrapped_lines: each line by itself, further ones deeper", "[report]") {
  CHECK(wrapped_lines("one two\n  three four\n\n", 9) == "one two\n  three\n    four\n\n");
  CHECK(wrapped_lines("one two", 5) == "one\n  two");
  CHECK(wrapped_lines("one two\n", 0) == "one two\n");
  CHECK(wrapped_lines("", 5).empty());
}
