#include "report/page/calibration/shown_part.hpp"

#include <catch2/catch.hpp>
#include <cstddef>
#include <vector>

namespace rigcal::report {
namespace {

TEST_CASE("first_of_last_periods: two periods of a drive with a frequency, else all", "[report]") {
  std::vector<double> time_s;  // 10 s from 5 s on, 10 samples per second
  for (int i = 0; i <= 100; ++i) time_s.push_back(5.0 + 0.1 * i);
  calib::ConditionResult condition;
  CHECK(first_of_last_periods(condition, time_s) == 0);
  condition.frequency_hz.emplace(0.5);
  const std::size_t first = first_of_last_periods(condition, time_s);
  CHECK(time_s[first] == Approx(11.0).margin(0.101));
  condition.frequency_hz.emplace(0.1);  // two periods take longer than the record
  CHECK(first_of_last_periods(condition, time_s) == 0);
  condition.frequency_hz.emplace(0.0);
  CHECK(first_of_last_periods(condition, time_s) == 0);
  CHECK(first_of_last_periods(condition, {}) == 0);
}

TEST_CASE("shown_channel: the motion if it was compared, else what comes first", "[report]") {
  std::vector<calib::ConditionResult> conditions(2);
  CHECK(shown_channel(conditions).empty());
  conditions[0].channels.emplace_back().channel = datasets::Channel::load_pressure;
  conditions[0].channels.emplace_back().channel = datasets::Channel::pressure_a;
  CHECK(shown_channel(conditions) == "load_pressure");
  conditions[1].channels.emplace_back().channel = datasets::Channel::position;
  CHECK(shown_channel(conditions) == "position");
}

}  // namespace
}  // namespace rigcal::report
