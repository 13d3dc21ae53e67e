#include "common/printable.hpp"

#include <catch2/catch.hpp>
#include <string>

using rigcal::printable;

TEST_CASE("printable: what a terminal would obey is shown", "[common]") {
  struct Row {
    std::string text;
    const char* shown;
  };
  const std::string nul("a\0b", 3);
  for (const Row& row : {
           Row{"\x1b]0;owned\a", "\\u001B]0;owned\\u0007"},
           Row{"a\rb\tc\x7f", "a\\u000Db\\u0009c\\u007F"}, Row{nul, "a\\u0000b"},
           Row{"\u009b2J", "\\u009B2J"},  // C1 in UTF-8
           Row{"\x9b"
               "2J",
               "\\x9B2J"},  // as a single byte
           Row{"\u0080\u009f\u00a0", "\\u0080\\u009F\u00a0"},
           Row{"gpj\u202exslx", "gpj\\u202Exslx"},
           Row{"\u202a\u2066\u2069\u200e\u200f\u061c",
               "\\u202A\\u2066\\u2069\\u200E\\u200F\\u061C"},
           Row{"\u2028", "\\u2028"},
           Row{"\xff\xc0\xaf\xed\xa0\x80", "\\xFF\\xC0\\xAF\\xED\\xA0\\x80"},  // not UTF-8
           Row{"\xe0\x80\xaf\xf0\x80\x80\xaf",
               "\\xE0\\x80\\xAF\\xF0\\x80\\x80\\xAF"},       // more bytes than needed
           Row{"\xe2\x82", "\\xE2\\x82"},                    // truncated
           Row{"\xf4\x90\x80\x80", "\\xF4\\x90\\x80\\x80"},  // beyond Unicode
       })
    CHECK(printable(row.text) == row.shown);
}

TEST_CASE("printable: what is no more than text stays", "[common]") {
  for (const std::string text :
       {"", "line\nline\n", "Zylinder ü, Ω, 油圧, 🛠, \\ and 'quotes'"})
    CHECK(printable(text) == text);
}

TEST_CASE("printable: colours stay where they are wanted, and nothing beside them", "[common]") {
  const std::string green = "\x1b[32mPASS\x1b[0m \x1b[1mhead\x1b[0m \x1b[1;31mFAIL\x1b[0m";
  CHECK(printable(green, true) == green);
  CHECK(printable("\x1b[32mPASS") == "\\u001B[32mPASS");
  for (const char* other : {"8m", "2J", "41m", "38;5;1m", "1", "", "1;H", "7m"})
    CHECK(printable(std::string("\x1b[") + other, true) == std::string("\\u001B[") + other);
}
