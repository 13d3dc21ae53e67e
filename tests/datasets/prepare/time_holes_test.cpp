#include "datasets/prepare/time_holes.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/datasets/reading.hpp"

using namespace rigcal::datasets;
using Catch::Contains;

namespace {

/// Samples every 0.1 s, except those between 2 s and 4 s.
std::vector<double> with_a_hole() {
  std::vector<double> time_s;
  for (int i = 0; i <= 100; ++i)
    if (i <= 20 || i >= 40) time_s.push_back(0.1 * i);
  return time_s;
}

struct TornRecord {
  Campaign campaign;
  Condition condition;
  std::vector<Repeat> repeats;
  TornRecord() {
    condition.id = "steps";
    condition.waveform = Waveform::sine;
    campaign.rig.controller = rigcal::model::ControllerKind::pid;
    Repeat whole{"a.csv", {0.0, 0.1, 0.2, 0.3}, {}};
    Repeat torn{"b.csv", with_a_hole(), {}};
    torn.holes = time_holes(torn.time_s);
    repeats = {whole, torn};
  }
  std::vector<std::string> told(const std::vector<TimeWindow>& windows) const {
    return holes_in_what_counts(campaign, condition, repeats, windows);
  }
};

}  // namespace

TEST_CASE("time_holes: steps above three times the median", "[datasets]") {
  const auto holes = time_holes(with_a_hole());
  REQUIRE(holes.size() == 1);
  CHECK(holes[0].row == 22);
  CHECK(holes[0].from_s == 2.0);
  CHECK(holes[0].to_s == 4.0);
  // Jitter of a third of the interval, one missing sample out of three, and too few samples to
  // judge.
  CHECK(time_holes({0.0, 1.3, 2.0, 3.0, 4.3, 5.0}).empty());
  CHECK(time_holes({0.0, 1.0, 2.0, 5.0, 6.0, 7.0}).empty());
  CHECK(time_holes({0.0, 1.0, 2.0, 5.1, 6.0, 7.0}).size() == 1);
  CHECK(time_holes({0.0, 1.0}).empty());
  CHECK(time_holes({}).empty());
}

TEST_CASE("holes_in_what_counts: one repeat alone, with its file, row and times", "[datasets]") {
  const auto told = TornRecord().told({});
  REQUIRE(told.size() == 1);
  CHECK_THAT(told[0], Contains("b.csv: samples are missing before sample 22") &&
                          Contains("between 2 s and 4 s"));
}

TEST_CASE("holes_in_what_counts: windows leave them out", "[datasets]") {
  TornRecord test;
  CHECK(test.told({{0.0, 2.0}, {4.0, 10.0}}).empty());
  CHECK(test.told({{0.0, 1.0}}).empty());
  CHECK(test.told({{0.0, 2.1}}).size() == 1);
  CHECK(test.told({{3.0, 10.0}}).size() == 1);
  CHECK(test.told({{2.5, 3.5}}).size() == 1);
  // The command during the hole is unknown, and it displaces the piston permanently.
  test.condition.waveform = Waveform::recorded;
  CHECK(test.told({{0.0, 2.0}, {4.0, 10.0}}).empty());
  test.campaign.rig.controller = rigcal::model::ControllerKind::none;
  CHECK(test.told({{0.0, 2.0}, {4.0, 10.0}}).size() == 1);
  CHECK(test.told({{0.0, 2.0}}).empty());
}

TEST_CASE("require_no_holes: the condition and the first of them", "[datasets]") {
  Campaign campaign;
  Record record;
  record.condition = "steps";
  Condition condition;
  condition.id = "steps";
  condition.where = {"campaign.toml", 12, 1};
  campaign.conditions.push_back(condition);
  CHECK_NOTHROW(require_no_holes(campaign, record));
  record.holes = {"b.csv: samples are missing"};
  CHECK_THROWS_WITH(
      require_no_holes(campaign, record),
      Contains("campaign.toml:12:1: condition \"steps\": b.csv: samples are missing"));
}
