#include "datasets/read/csv/time_stamp.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::datasets;

TEST_CASE("time_stamp: dates with a time of day, and times of day", "[datasets]") {
  const auto stamp = time_stamp("2024-03-01T12:00:01.25");
  REQUIRE(stamp);
  CHECK(stamp->time_s == Approx(43201.25));
  CHECK(*time_stamp("2024-03-01 00:00:00")->day_first -
            *time_stamp("2024-02-28 00:00:00")->day_first ==
        2);
  CHECK(time_stamp("12:00:01,25")->time_s == Approx(43201.25));
  CHECK(time_stamp("12:00:01")->day_first == 0);
  CHECK_FALSE(time_stamp("12:00:01")->has_date);
  CHECK(time_stamp("2024/03/01 12:00:01Z")->day_first == stamp->day_first);
  CHECK(time_stamp("2024.03.01 12:00:01")->month_first == stamp->day_first);
  CHECK(time_stamp("\"2024-03-01 12:00:01+01:00\"")->time_s == Approx(43201.0));
  for (const char* text : {"1.3.2024 9:00:01", "1/3/2024 9:00:01", "01-03-24 9:00:01"}) {
    CAPTURE(text);
    CHECK(time_stamp(text)->day_first == stamp->day_first);
    CHECK(*time_stamp(text)->month_first == *stamp->day_first - 58);
  }
  CHECK(time_stamp("01-Mar-2024 9:00:01")->day_first == stamp->day_first);
  CHECK(time_stamp("01-MAR-2024 9:00:01")->month_first == stamp->day_first);
  CHECK(time_stamp("31/12/2024 9:00:01")->day_first ==
        time_stamp("12/31/2024 9:00:01")->month_first);
  CHECK_FALSE(time_stamp("31/12/2024 9:00:01")->month_first);
  CHECK(time_stamp("12:00:01 AM")->time_s == Approx(1.0));
  CHECK(time_stamp("12:00:01.5 pm")->time_s == Approx(43201.5));
  CHECK(time_stamp("3/1/2024 1:00:00 PM")->time_s == Approx(46800.0));
  CHECK(is_date("28.11.2024"));
  CHECK_FALSE(is_date("28.11.2024 12:00:00"));
  CHECK_FALSE(is_date("28.11"));
  for (const char* text :
       {"", "2024-03-01", "2024-02-30 12:00:00", "2024-13-01 12:00:00", "12:00", "24:00:00",
        "12:60:00", "13:00:00 pm", "0:00:00 AM", "32.03.2024 12:00:00", "1:2:3",
        "13/13/2024 12:00:00", "2024-03-01 12:00:00+1", "2024-03-01  12:00:00", "12:00:00.5x"}) {
    CAPTURE(text);
    CHECK_FALSE(time_stamp(text));
  }
}
