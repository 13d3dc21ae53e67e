#include "common/calendar.hpp"

#include <catch2/catch.hpp>

using rigcal::date_of;
using rigcal::day_of;

TEST_CASE("calendar: days since 1970-01-01", "[common]") {
  CHECK(day_of("1970-01-01") == 0);
  CHECK(day_of("1969-12-31") == -1);
  CHECK(day_of("2000-03-01") == 11017);  // 2000 was a leap year; date -ud 2000-03-01 +%s / 86400
  CHECK(day_of("2026-11-24") == 20781);
}

TEST_CASE("calendar: what is no date", "[common]") {
  for (const char* text : {"", "today", "2026-11", "2026-02-29", "2026-13-01"})
    CHECK_FALSE(day_of(text).has_value());
}

TEST_CASE("calendar: the date of a day, and of an hour within it", "[common]") {
  for (const char* text : {"1969-12-31", "2000-02-29", "2026-11-24"})
    CHECK(date_of(*day_of(text)) == text);
  CHECK(date_of(0.99) == "1970-01-01");
  CHECK(date_of(-0.01) == "1969-12-31");
}
