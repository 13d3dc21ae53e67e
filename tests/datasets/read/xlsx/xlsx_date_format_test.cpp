#include "datasets/read/xlsx/xlsx_date_format.hpp"

#include <catch2/catch.hpp>

using rigcal::datasets::is_date_format;

TEST_CASE("xlsx_date_format: formats of dates, and of numbers that look like them", "[datasets]") {
  for (const char* code : {"dd.mm.yyyy", "d/m/yy h:mm", "[h]:mm:ss", "[ss].000", "mm:ss.0",
                           "[$-407]d. mmmm yyyy", "hh:mm AM/PM", "\"at\" hh"}) {
    CAPTURE(code);
    CHECK(is_date_format(code));
  }
  for (const char* code : {"General", "0.00", "#,##0.00 \"mm/s\"", "0.00\\s", "0.0_d", "[Red]0.00",
                           "[>=100]0;0.0", "0.00E+00", "0%", "# ?/?", "[$EUR]0.00", "0\"", "["}) {
    CAPTURE(code);
    CHECK_FALSE(is_date_format(code));
  }
  CHECK(is_date_format(14L));
  CHECK(is_date_format(47L));
  CHECK_FALSE(is_date_format(0L));
  CHECK_FALSE(is_date_format(11L));
  CHECK_FALSE(is_date_format(49L));
}
