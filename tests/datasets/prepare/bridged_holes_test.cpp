#include "datasets/prepare/bridged_holes.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "common/error.hpp"
#include "datasets/prepare/average.hpp"
#include "datasets/prepare/time_holes.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::Contains;

namespace {

double position_at(double t) { return std::sin(t); }

/// Samples every 0.1 s up to 10 s, except those from `first` to `last`.
Repeat torn(const std::string& name, int first, int last) {
  Repeat repeat;
  repeat.source = name;
  for (int i = 0; i <= 100; ++i) {
    if (i >= first && i <= last) continue;
    repeat.time_s.push_back(0.1 * i);
    repeat.values[Channel::position].push_back(position_at(0.1 * i));
    repeat.values[Channel::command].push_back(i < 50 ? 1.0 : -1.0);
  }
  repeat.holes = time_holes(repeat.time_s);
  return repeat;
}

/// Lacks a long part first, then a short one.
Repeat torn_twice() {
  Repeat repeat = torn("twice.csv", 45, 52);
  constexpr std::ptrdiff_t kRow = 70 - 8;
  const auto erase = [](std::vector<double>& x) {
    x.erase(x.begin() + kRow, x.begin() + kRow + 3);
  };
  erase(repeat.time_s);
  for (auto& [channel, values] : repeat.values) erase(values);
  repeat.holes = time_holes(repeat.time_s);
  return repeat;
}

Campaign bridging(double longest_s) {
  Campaign campaign;
  campaign.rig.controller = model::ControllerKind::none;
  campaign.longest_bridge_s = longest_s;
  ChannelSetting command;
  command.role = ChannelRole::input;
  campaign.channels[Channel::command] = command;
  return campaign;
}

Repeat bridged(Repeat repeat, double longest_s = 1.0) {
  bridge_holes(bridging(longest_s), repeat);
  return repeat;
}

}  // namespace

TEST_CASE("bridge_holes: what is missing is put in and marked", "[datasets]") {
  const Repeat repeat = bridged(torn("a.csv", 45, 48));
  REQUIRE(repeat.time_s.size() == 101);
  CHECK(repeat.holes.empty());
  for (std::size_t i = 0; i < 101; ++i) {
    CAPTURE(i);
    CHECK(std::abs(repeat.time_s[i] - 0.1 * static_cast<double>(i)) < 1e-12);
    CHECK(repeat.bridged[i] == (i >= 45 && i <= 48));
  }
  // A stepwise input keeps its value, whereas a measured signal is interpolated.
  const Repeat stepped = bridged(torn("b.csv", 47, 52));  // the step from 1 to -1 is in the hole
  CHECK(stepped.values.at(Channel::command)[52] == 1.0);
  CHECK(stepped.values.at(Channel::command)[53] == -1.0);
  const auto& x = repeat.values.at(Channel::position);
  CHECK(std::abs(x[45] - (0.8 * x[44] + 0.2 * x[49])) < 1e-12);
  REQUIRE(bridged_notes({repeat}).size() == 1);
  CHECK_THAT(bridged_notes({repeat})[0],
             Contains("a.csv: holes bridged: 4 samples are missing in 1 place") &&
                 Contains("between 4.4 s and 4.9 s"));
  CHECK_THAT(bridged_notes({bridged(torn_twice())}).at(0),
             Contains("11 samples are missing in 2 places, the longest between 4.4 s and 5.3 s"));
  // An input that is linear between its samples is so in a hole, too.
  Campaign linear = bridging(1.0);
  linear.channels[Channel::command].interpolation = Interpolation::linear;
  Repeat ramp = torn("b.csv", 47, 52);
  bridge_holes(linear, ramp);
  CHECK(std::abs(ramp.values.at(Channel::command)[47] - (1.0 - 2.0 / 7.0)) < 1e-12);
}

TEST_CASE("bridge_holes: only on request, and no further than it", "[datasets]") {
  Repeat untouched = torn("a.csv", 45, 48);
  bridge_holes(Campaign(), untouched);
  CHECK(untouched.bridged.empty());
  CHECK(untouched.holes.size() == 1);
  const Repeat longer = bridged(torn("a.csv", 45, 48), 0.4);
  CHECK(longer.bridged.empty());
  CHECK(longer.holes.size() == 1);
  CHECK(bridged(torn("a.csv", 45, 48), 0.5).holes.empty());
  CHECK(bridged(torn("a.csv", -1, -1)).bridged.empty());
  CHECK_THROWS_AS(bridged(torn("a.csv", 10, 90), 100.0), InputError);
}

TEST_CASE("bridge_holes: one lost sample is no hole, and bridged all the same", "[datasets]") {
  const Repeat repeat = bridged(torn("a.csv", 30, 30));
  CHECK(repeat.time_s.size() == 101);
  CHECK(repeat.bridged[30]);
}

TEST_CASE("average: repeats that lost samples in different places", "[datasets]") {
  const std::vector<Repeat> repeats{bridged(torn("a.csv", 45, 48)),
                                    bridged(torn("b.csv", 47, 60), 2.0),
                                    bridged(torn("c.csv", 80, 80))};
  const Record record = average("x", repeats, {});
  REQUIRE(record.time_s.size() == 101);
  const Series& x = record.channels.at(Channel::position);
  for (std::size_t i = 0; i < 101; ++i) {
    CAPTURE(i);
    CHECK(std::abs(x.mean[i] - position_at(record.time_s[i])) < 1e-12);
  }
  CHECK(x.count[44] == 3);
  CHECK(x.count[46] == 2);
  CHECK(x.count[47] == 1);
  CHECK(x.count[80] == 2);
  CHECK_FALSE(guessed_drive_warning(bridging(1.0), Condition(), record).size() > 0);
}

TEST_CASE("average: what no repeat has is in no record, and its drive is a guess", "[datasets]") {
  const std::vector<Repeat> repeats{bridged(torn("a.csv", 45, 52)), bridged(torn("b.csv", 47, 55))};
  const Record record = average("x", repeats, {});
  CHECK(record.time_s.size() == 101 - 6);
  CHECK(std::abs(record.time_s[47] - 5.3) < 1e-12);
  CHECK_THAT(guessed_drive_warning(bridging(2.0), Condition(), record),
             Contains("command was not recorded in 1 hole") &&
                 Contains("between 4.6 s and 5.3 s") && Contains("its last value"));
  Record twice;
  twice.time_s = torn_twice().time_s;
  CHECK_THAT(guessed_drive_warning(bridging(2.0), Condition(), twice),
             Contains("in 2 holes, the longest between 4.4 s and 5.3 s"));
  Condition generated;
  generated.waveform = Waveform::sine;
  CHECK(guessed_drive_warning(bridging(2.0), generated, record).empty());
}

TEST_CASE("forget_bridged: a shift by a part of a sample takes both neighbours", "[datasets]") {
  std::vector<double> row(5, 1.0);
  forget_bridged(row, {false, false, true, false, false}, 0.5);
  CHECK(std::isnan(row[1]));
  CHECK(std::isnan(row[2]));
  CHECK(row[0] == 1.0);
  CHECK(row[3] == 1.0);
  std::vector<double> whole(5, 1.0);
  forget_bridged(whole, {false, false, true, false, false}, -1.0);
  CHECK(std::isnan(whole[3]));
  CHECK(whole[2] == 1.0);
}
