#include "report/store/csv_fields.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>

using namespace rigcal::report;

TEST_CASE("csv_text: quotes where commas, quotes and line ends ask for them", "[report]") {
  CHECK(csv_text("plain text") == "plain text");
  CHECK(csv_text("a,b") == "\"a,b\"");
  CHECK(csv_text("a \"b\"") == "\"a \"\"b\"\"\"");
  CHECK(csv_text("a\nb") == "\"a\nb\"");
  CHECK(csv_text("").empty());
}

TEST_CASE("csv_text: what a spreadsheet would run is text", "[report]") {
  for (const char* text : {"=cmd|' /C calc'!A0", "+1+cmd", "-2+3", "@SUM(A1)", "\tx", "-", "+"})
    CHECK(csv_text(text) == "'" + std::string(text));
  CHECK(csv_text("=HYPERLINK(\"a\",\"b\")") == "\"'=HYPERLINK(\"\"a\"\",\"\"b\"\")\"");
  CHECK(csv_text("\rx") == "\"'\rx\"");
  for (const char* number : {"-1.5", "+2e-3", "-0"}) CHECK(csv_text(number) == number);
  CHECK(csv_text("33 % - open") == "33 % - open");
}

TEST_CASE("csv_number: nothing for what is no number", "[report]") {
  CHECK(csv_number(0.1) == "0.1");
  CHECK(csv_number(std::numeric_limits<double>::quiet_NaN()).empty());
  CHECK(csv_number(-std::numeric_limits<double>::infinity()).empty());
}

TEST_CASE("csv_status: one comment line with all reasons", "[report]") {
  CHECK(csv_status("failed", {"no start", "no\nend"}) == "# status: failed: no start; no end\n");
}
