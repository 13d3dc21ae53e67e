#include "datasets/prepare/single_repeats.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/prepare/repeatability.hpp"
#include "datasets/synthetic/noise.hpp"
#include "model/simulate.hpp"
#include "tests/support/paper_rig.hpp"

using namespace rigcal::datasets;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr std::size_t kSingleSamples = 400;

double slope_and_ring(double t) { return 2.0 * t + std::sin(40.0 * t); }

/// A motion on a clock of 1 kHz that starts at `first_s`, raised by `level`.
Repeat starting_at(double first_s, double level) {
  Repeat repeat;
  repeat.source = "from " + std::to_string(first_s);
  for (std::size_t i = 0; i < kSingleSamples; ++i) {
    const double t = first_s + 1e-3 * static_cast<double>(i);
    repeat.time_s.push_back(t);
    repeat.values[Channel::position].push_back(slope_and_ring(t) + level);
    repeat.values[Channel::command].push_back(t < 0.2 ? 0.0 : 1.0);
  }
  return repeat;
}

constexpr double kStepNoise_m = 5e-5;

/// A square wave of 10 mm on the paper's rig at a fraction of its supply pressure, with noise.
Repeat square_at_supply(double fraction, const std::string& source) {
  namespace model = rigcal::model;
  auto values = model::ParameterValues::defaults(model::PlantKind::load_pressure);
  for (const auto& [key, value] : rigcal::test::kPaperRig) values.set(key, value);
  values.set("supply_pressure", fraction * values["supply_pressure"]);
  values.set("kp", 400.0);  // the piston arrives within a half period
  Repeat repeat;
  repeat.source = source;
  for (std::size_t i = 0; i < kSingleSamples; ++i)
    repeat.time_s.push_back(1e-3 * static_cast<double>(i));
  model::SimulationInputs inputs;
  inputs.drive = model::Signal::square(0.01, 4.0);
  const auto outputs = std::to_array({model::Output::position});
  const auto run = model::simulate(model::Rig{}, values, {}, inputs, repeat.time_s, outputs);
  REQUIRE(run.ok());
  auto stream = random_stream(1, {source});
  for (std::size_t i = 0; i < kSingleSamples; ++i)
    repeat.values[Channel::position].push_back(run.outputs(static_cast<Eigen::Index>(i), 0) +
                                               normal(stream, kStepNoise_m));
  return repeat;
}

}  // namespace

TEST_CASE("repeat_records: a repeat far from the others is left out on request only",
          "[datasets]") {
  Campaign campaign;
  campaign.alignment = Alignment::none;
  Condition condition;
  condition.id = "c";
  std::vector<Repeat> repeats;
  for (const double level : {0.010, -0.010, 0.005, -0.005, 0.400})
    repeats.push_back(starting_at(0.0, level));
  repeats.back().source = "the bad one";
  const auto level_of = [](const Record& record) {
    return record.channels.at(Channel::position).mean[100] - slope_and_ring(0.1);
  };
  const RepeatRecords all = repeat_records(campaign, condition, repeats);
  CHECK(all.singles.size() == 5);
  CHECK_THAT(level_of(all.average), WithinAbs(0.08, 1e-9));
  campaign.leave_out_outliers = true;
  const RepeatRecords without = repeat_records(campaign, condition, repeats);
  CHECK(without.singles.size() == 4);
  CHECK(without.average.repeats == 4);
  CHECK_THAT(level_of(without.average), WithinAbs(0.0, 1e-9));
  REQUIRE_FALSE(without.average.warnings.empty());
  CHECK_THAT(without.average.warnings.front(),
             Catch::Contains("the bad one") && Catch::Contains("left out"));
  CHECK_THAT(all.average.warnings.front(),
             Catch::Contains("the bad one") && Catch::Contains("stays in the mean"));
}

TEST_CASE("repeat_records: a repeat at 10 % less supply is named, and left out on request",
          "[datasets]") {
  Campaign campaign;
  Condition condition;
  condition.id = "c";
  // The supply of the others varies by as much as a regulated one does.
  const std::vector<Repeat> good{square_at_supply(1.002, "first"),
                                 square_at_supply(0.997, "second"), square_at_supply(1.0, "third"),
                                 square_at_supply(1.004, "fifth")};
  std::vector<Repeat> repeats = good;
  repeats.insert(repeats.begin() + 3, square_at_supply(0.9, "fourth"));
  const auto distance_from_good = [&](const Record& record) {
    const std::vector<double> truth =
        repeat_records(campaign, condition, good).average.channels.at(Channel::position).mean;
    const std::vector<double>& mean = record.channels.at(Channel::position).mean;
    double largest = 0.0;
    for (std::size_t i = 20; i + 20 < std::min(mean.size(), truth.size()); ++i)
      largest = std::max(largest, std::abs(mean[i] - truth[i]));
    return largest;
  };
  const Record all = repeat_records(campaign, condition, repeats).average;
  CHECK(outliers(all) == std::vector<std::string>{"fourth"});
  REQUIRE(all.warnings.size() == 1);
  CHECK_THAT(all.warnings[0], Catch::Contains("fourth") && Catch::Contains("stays in the mean"));
  CHECK(all.repeats == 5);
  CHECK(distance_from_good(all) > kStepNoise_m);  // the noise of the mean is half of it

  campaign.leave_out_outliers = true;
  const RepeatRecords without = repeat_records(campaign, condition, repeats);
  CHECK(without.average.repeats == 4);
  CHECK(without.singles.size() == 4);
  CHECK_THAT(without.average.warnings.at(0),
             Catch::Contains("fourth") && Catch::Contains("left out"));
  CHECK(distance_from_good(without.average) == 0.0);

  const RepeatRecords nothing_bad = repeat_records(campaign, condition, good);
  CHECK(nothing_bad.average.repeats == 4);
  CHECK(outliers(nothing_bad.average).empty());
}

TEST_CASE("repeat_records: each repeat on the time base of the average, with the sd of one",
          "[datasets]") {
  Campaign campaign;
  campaign.alignment = Alignment::none;
  Condition condition;
  condition.id = "c";
  const double level = 0.01;
  // The second repeat begins 30 samples later, and its clock is half a sample off.
  const RepeatRecords records =
      repeat_records(campaign, condition, {starting_at(0.0, -level), starting_at(0.0305, level)});
  const Record& average = records.average;
  REQUIRE(records.singles.size() == 2);
  const double sd = level * std::sqrt(2.0);
  CHECK_THAT(average.channels.at(Channel::position).sd_of_mean, WithinRel(level, 1e-3));
  for (std::size_t r = 0; r < 2; ++r) {
    const Record& single = records.singles[r];
    CHECK(single.time_s == average.time_s);
    const Series& position = single.channels.at(Channel::position);
    // A single repeat has the uncertainty of one repeat, not that of the mean.
    CHECK_THAT(position.pooled_sd, WithinRel(sd, 1e-3));
    CHECK_THAT(position.sd_of_mean, WithinRel(sd, 1e-3));
    for (std::size_t i = 60; i < 380; ++i)
      CHECK_THAT(position.mean[i],
                 WithinAbs(slope_and_ring(single.time_s[i]) + (r == 0 ? -level : level), 1e-4));
    // Interpolation does not take a command beyond its levels.
    for (const double value : single.channels.at(Channel::command).mean) {
      CHECK(value >= 0.0);
      CHECK(value <= 1.0);
    }
  }
  CHECK(records.covered[0].start_s == average.time_s.front());
  CHECK_THAT(records.covered[1].start_s, WithinAbs(0.031, 1e-9));
  // Times that the repeat does not cover get its nearest sample.
  const auto& late = records.singles[1].channels.at(Channel::position).mean;
  CHECK(late[0] == late[31]);
  CHECK(late[30] == late[31]);
  CHECK(std::abs(late[31]) > 0.1);
}

TEST_CASE("repeat_records: one repeat, or an averaged file, has no singles", "[datasets]") {
  Campaign campaign;
  Condition condition;
  condition.id = "c";
  CHECK(repeat_records(campaign, condition, {starting_at(0.0, 0.0)}).singles.empty());
}
