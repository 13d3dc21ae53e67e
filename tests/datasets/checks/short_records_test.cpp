#include "datasets/checks/short_records.hpp"

#include <catch2/catch.hpp>

using namespace rigcal::datasets;
using Catch::Contains;

namespace {

Condition sine_condition(double frequency_hz, std::optional<double> duration_s = {}) {
  Condition condition;
  condition.waveform = Waveform::sine;
  condition.frequency_hz = frequency_hz;
  condition.amplitude = 0.05;
  condition.duration_s = duration_s;
  return condition;
}

/// Whether each record, with one duration per condition, is reported as short.
std::vector<bool> told(const std::vector<Condition>& conditions, const std::vector<double>& s) {
  std::vector<RecordLength> lengths;
  for (std::size_t i = 0; i < s.size(); ++i) lengths.push_back({&conditions[i], s[i]});
  std::vector<bool> result;
  for (const std::string& text : short_records(lengths)) result.push_back(!text.empty());
  return result;
}

using Told = std::vector<bool>;

}  // namespace

TEST_CASE("short_records: against the duration that the campaign states", "[datasets]") {
  CHECK(told({sine_condition(1.0, 20.0)}, {18.9}) == Told{true});
  CHECK(told({sine_condition(1.0, 20.0)}, {19.1}) == Told{false});
  CHECK(told({sine_condition(1.0)}, {1.0}) == Told{false});
  const Condition half = sine_condition(1.0, 20.0);
  CHECK_THAT(short_records({{&half, 10.0}}).at(0), Contains("after 10 s of the 20 s"));
}

TEST_CASE("short_records: against other conditions of the same signal", "[datasets]") {
  const std::vector<Condition> same(4, sine_condition(1.0));
  CHECK(told(same, {20.0, 19.5, 14.9, 20.0}) == Told{false, false, true, false});
  CHECK(told(same, {20.0, 19.5, 15.1, 20.0}) == Told{false, false, false, false});
  // With two long and two short records, or a single long one, the intended length is unclear.
  CHECK(told(same, {20.0, 10.0, 10.0, 20.0}) == Told{false, false, false, false});
  CHECK(told(same, {20.0, 10.0, 10.0, 10.0}) == Told{false, false, false, false});
  CHECK(told({same.begin(), same.begin() + 2}, {20.0, 10.0}) == Told{false, false});
  // A different signal has a different length.
  std::vector<Condition> mixed = same;
  mixed[2] = sine_condition(2.0);
  CHECK(told(mixed, {20.0, 20.0, 10.0, 20.0}) == Told(4, false));
  std::vector<Condition> recorded(4);
  CHECK(told(recorded, {20.0, 20.0, 10.0, 20.0}) == Told(4, false));
  CHECK_THAT(short_records({{&same[0], 20.0}, {&same[1], 20.0}, {&same[2], 10.0}}).at(2),
             Contains("after 10 s, where 2 other conditions of the same signal last 20 s"));
}
