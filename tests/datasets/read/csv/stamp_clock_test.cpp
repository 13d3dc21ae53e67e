#include "datasets/read/csv/stamp_clock.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

using namespace rigcal::datasets;

namespace {

struct ClockSeconds {
  std::vector<std::optional<double>> seconds;
  std::string doubt;
};

ClockSeconds clock_seconds(const std::vector<std::string>& texts) {
  StampClock clock;
  ClockSeconds result;
  for (const std::string& text : texts) result.seconds.push_back(clock.seconds(*time_stamp(text)));
  result.doubt = clock.doubt();
  return result;
}

}  // namespace

TEST_CASE("StampClock: one order of day and month in all dates of a file", "[datasets]") {
  using Seconds = std::vector<std::optional<double>>;
  const Seconds midnight{0.0, 1.0, 2.0};
  // A number above 12 decides, wherever it is.
  for (const auto& texts : std::vector<std::vector<std::string>>{
           {"31/12/2024 23:59:59", "01/01/2025 00:00:00", "01/01/2025 00:00:01"},
           {"12/31/2024 23:59:59", "01/01/2025 00:00:00", "01/01/2025 00:00:01"},
           {"12/07/2024 23:59:59", "13/07/2024 00:00:00", "13/07/2024 00:00:01"},
           {"07/12/2024 23:59:59", "07/13/2024 00:00:00", "07/13/2024 00:00:01"},
           {"12.07.2024 23:59:59", "13.07.2024 00:00:00", "13.07.2024 00:00:01"},
           {"2024-07-03 23:59:59", "2024-07-04 00:00:00", "2024-07-04 00:00:01"}}) {
    CAPTURE(texts[0]);
    const ClockSeconds found = clock_seconds(texts);
    CHECK(found.seconds == midnight);
    CHECK(found.doubt.empty());
  }
  // Without one, a day has passed and not a month.
  for (const auto& texts : std::vector<std::vector<std::string>>{
           {"01/02/2024 23:59:59", "02/02/2024 00:00:00", "02/02/2024 00:00:01"},
           {"01/02/2024 23:59:59", "01/03/2024 00:00:00", "01/03/2024 00:00:01"},
           {"03.04.24 23:59:59", "04.04.24 00:00:00", "04.04.24 00:00:01"}}) {
    CAPTURE(texts[0]);
    const ClockSeconds found = clock_seconds(texts);
    CHECK(found.seconds == midnight);
    CHECK_FALSE(found.doubt.empty());
  }
  // The order does not change again.
  const ClockSeconds other =
      clock_seconds({"12/07/2024 23:59:59", "13/07/2024 00:00:00", "07/14/2024 00:00:00"});
  CHECK_FALSE(other.seconds.back());
  // One date alone leaves the order open.
  const ClockSeconds day = clock_seconds({"01/02/2024 10:00:00", "01/02/2024 10:00:05"});
  CHECK(day.seconds == Seconds{0.0, 5.0});
  CHECK(day.doubt.empty());
}

TEST_CASE("StampClock: times of day pass midnight, and do not go back", "[datasets]") {
  using Seconds = std::vector<std::optional<double>>;
  CHECK(clock_seconds({"23:59:59.5", "00:00:00.5", "00:00:01"}).seconds == Seconds{0.0, 1.0, 1.5});
  CHECK(clock_seconds({"12:00:01", "12:00:00"}).seconds == Seconds{0.0, -1.0});
  CHECK_FALSE(clock_seconds({"23:59:59", "2024-03-01 00:00:00"}).seconds.back());
}
