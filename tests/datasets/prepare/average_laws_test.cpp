// Checks what averaging must do by definition, and the limits of its warnings. The mean, sd and
// distances of the records are known exactly, because they contain patterns of +1 and -1 instead of
// noise.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "datasets/prepare/average.hpp"
#include "tests/datasets/position_of.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::position_of;

namespace {

AverageOptions as_they_are() {
  AverageOptions options;
  options.align = false;
  return options;
}

/// Position during [first, first + samples) on a clock of 1 kHz.
Repeat on_clock(const std::string& source, long first, std::size_t samples, auto value) {
  Repeat repeat;
  repeat.source = source;
  for (std::size_t i = 0; i < samples; ++i) {
    repeat.time_s.push_back(1e-3 * static_cast<double>(first + static_cast<long>(i)));
    repeat.values[Channel::position].push_back(value(first + static_cast<long>(i)));
  }
  return repeat;
}

/// Repeats 1, -1, -1, 1. The rms over every four samples is 1, and every second difference is 2 or
/// -2.
double alternating(long i) { return i % 4 == 0 || i % 4 == 3 ? 1.0 : -1.0; }

double triangle(long i) { return std::abs(static_cast<double>(i % 200) - 100.0) / 100.0; }

std::size_t warnings_with(const Record& record, const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(record.warnings.begin(), record.warnings.end(),
                    [&](const std::string& each) { return each.find(text) != std::string::npos; }));
}

}  // namespace

TEST_CASE("average: the mean of equal values is that value, to the last bit", "[datasets]") {
  // In floating point, 0.1 + 0.1 + 0.1 is more than 0.3.
  const auto tenth = [](long) { return 0.1; };
  const std::vector<Repeat> repeats(3, on_clock("r", 0, 20, tenth));
  const Record record = average("c", repeats, as_they_are());
  CHECK(position_of(record).mean == std::vector<double>(20, 0.1));
  CHECK(position_of(record).sd == std::vector<double>(20, 0.0));
}

TEST_CASE("average: the sd of the mean is that of a repeat over the root of their number",
          "[datasets]") {
  for (const int n : {2, 4, 9}) {
    std::vector<Repeat> repeats;
    for (int r = 0; r < n; ++r)
      repeats.push_back(
          on_clock("r" + std::to_string(r), 0, 50, [&](long i) { return triangle(i) + 0.01 * r; }));
    const Record record = average("c", repeats, as_they_are());
    // The sample variance of 0, ..., n - 1 is n (n + 1) / 12.
    const double sd = 0.01 * std::sqrt(n * (n + 1) / 12.0);
    CHECK_THAT(position_of(record).pooled_sd, WithinRel(sd, 1e-9));
    CHECK_THAT(position_of(record).sd[7], WithinRel(sd, 1e-9));
    CHECK_THAT(position_of(record).sd_of_mean, WithinRel(sd / std::sqrt(n), 1e-9));
  }
}

TEST_CASE("average: samples that one repeat has alone tell no variance", "[datasets]") {
  std::vector<Repeat> repeats{
      on_clock("long", 0, 100, [](long i) { return triangle(i) - 0.01; }),
      on_clock("short", 0, 60, [](long i) { return triangle(i) + 0.01; }),
  };
  const Record record = average("c", repeats, as_they_are());
  CHECK_THAT(position_of(record).pooled_sd, WithinRel(0.01 * std::sqrt(2.0), 1e-9));
  CHECK(position_of(record).count[59] == 2);
  CHECK(position_of(record).count[60] == 1);
  CHECK(std::isnan(position_of(record).sd[60]));
}

TEST_CASE("average: copies of a record that start apart give the record back", "[datasets]") {
  const auto shape = [](double t) { return std::sin(40.0 * t) + 0.3 * std::sin(90.0 * t + 1.0); };
  std::vector<Repeat> repeats;
  const std::vector<double> late_s{0.0021, -0.0027, 0.0006};  // mean 0
  for (std::size_t r = 0; r < late_s.size(); ++r)
    repeats.push_back(on_clock("r" + std::to_string(r), 0, 2000,
                               [&](long i) { return shape(1e-3 * double(i) - late_s[r]); }));
  const Record record = average("c", repeats, {});
  for (std::size_t i = 50; i < 1950; ++i)
    CHECK_THAT(position_of(record).mean[i], WithinAbs(shape(record.time_s[i]), 2e-4));
  for (std::size_t r = 0; r < 3; ++r)
    CHECK_THAT(record.repeat_reports[r].offset_s, WithinAbs(late_s[r], 2e-6));
}

TEST_CASE("average: a commanded signal is never shifted beyond its levels", "[datasets]") {
  for (const Channel channel : {Channel::reference, Channel::command}) {
    std::vector<Repeat> repeats;
    for (const double late_s : {0.0004, -0.0004}) {
      Repeat repeat = on_clock(late_s > 0.0 ? "late" : "early", 0, 2000, [&](long i) {
        return std::sin(30.0 * (1e-3 * double(i) - late_s));
      });
      for (const double t : repeat.time_s)
        repeat.values[channel].push_back(std::sin(30.0 * (t - late_s)) < 0.0 ? -1.0 : 1.0);
      repeats.push_back(repeat);
    }
    const Record record = average("c", repeats, {});
    const auto& mean = record.channels.at(channel).mean;
    CHECK(std::abs(record.repeat_reports[0].offset_s) > 1e-4);  // the repeats were shifted
    CHECK(*std::max_element(mean.begin(), mean.end()) <= 1.0);
    CHECK(*std::min_element(mean.begin(), mean.end()) >= -1.0);
  }
}

TEST_CASE("average: of the spans that all channels cover the longest counts", "[datasets]") {
  auto front = on_clock("front", 0, 60, triangle);
  auto back = on_clock("back", 170, 30, triangle);
  auto whole = on_clock("whole", 0, 200, triangle);
  whole.values.clear();
  whole.values[Channel::force] = std::vector<double>(200, 3.0);
  const Record record = average("c", {whole, front, back}, as_they_are());
  REQUIRE(record.time_s.size() == 60);
  CHECK(record.time_s.front() == 0.0);
}

TEST_CASE("average: an sd that the campaign gives counts where the repeats tell none",
          "[datasets]") {
  AverageOptions options = as_they_are();
  options.known_sd[Channel::position] = 0.02;
  const std::vector<Repeat> same(2, on_clock("r", 0, 50, triangle));
  const Record record = average("c", same, options);
  CHECK(position_of(record).pooled_sd == 0.02);
  CHECK(position_of(record).sd_of_mean == 0.02);
  CHECK(warnings_with(record, "identical") == 1);
}

TEST_CASE("average: identical inputs are as they should be", "[datasets]") {
  std::vector<Repeat> repeats;
  for (const double noise : {0.01, -0.01}) {
    repeats.push_back(
        on_clock("r", 0, 50, [&](long i) { return triangle(i) + noise * alternating(i); }));
    repeats.back().values[Channel::reference] = std::vector<double>(50, 1.0);
  }
  CHECK(warnings_with(average("c", repeats, as_they_are()), "identical") == 0);
}

TEST_CASE(
    "average: two repeats are named where they differ by more than noise and 1 % of the range",
    "[datasets]") {
  // Each repeat has noise of +-noise, which the second differences estimate as 2 noise / sqrt(6).
  // The range is 1.
  const auto named = [](double noise, double apart, double ratio) {
    std::vector<Repeat> repeats;
    for (const int r : {0, 1})
      repeats.push_back(on_clock("r" + std::to_string(r), 0, 2000, [&](long i) {
        return triangle(i) + apart * r + noise * alternating(i + r);
      }));
    AverageOptions options = as_they_are();
    options.outlier_ratio = ratio;
    return warnings_with(average("c", repeats, options), "differ by") == 1;
  };
  CHECK_FALSE(named(0.0, 0.009, 3.0));  // less than 1 % of the range, whatever the noise
  CHECK(named(0.0, 0.011, 3.0));
  // alternating(i) and alternating(i + 1) differ by 0, 2, 0, 2, which has an rms of sqrt(2). Since
  // |x[i-1] - 2 x[i] + x[i+1]| is 2 everywhere, the noise estimate of each is sd = 2 / sqrt(6).
  const double noise = 0.05;
  const double expected = std::sqrt(2.0) * noise * 2.0 / std::sqrt(6.0);
  const auto apart_of = [&](double distance) {
    return std::sqrt(distance * distance - 2.0 * noise * noise);
  };
  CHECK_FALSE(named(noise, apart_of(2.9 * expected), 3.0));
  CHECK(named(noise, apart_of(3.1 * expected), 3.0));
}

TEST_CASE("average: an outlier lies outlier_ratio times as far as is typical", "[datasets]") {
  const auto outliers_at = [](double apart) {
    std::vector<Repeat> repeats;
    // The median of the five is 0, so the distances are 0.01, 0.01, 0, `apart` and about 0.01; the
    // last differs slightly so that it is not a copy of the first.
    const std::vector<double> level{-0.01, 0.01, 0.0, apart, -0.0100001};
    for (std::size_t r = 0; r < level.size(); ++r)
      repeats.push_back(on_clock("r" + std::to_string(r), 0, 100,
                                 [&](long i) { return triangle(i) + level[r]; }));
    AverageOptions options = as_they_are();
    options.outlier_ratio = 3.0;
    const Record record = average("c", repeats, options);
    return std::count_if(record.repeat_reports.begin(), record.repeat_reports.end(),
                         [](const RepeatReport& report) { return report.outlier; });
  };
  CHECK(outliers_at(0.029) == 0);
  CHECK(outliers_at(0.031) == 1);
}

TEST_CASE("average: the deviation of a repeat is that of its worst channel", "[datasets]") {
  std::vector<Repeat> repeats;
  for (const int r : {0, 1, 2}) {
    repeats.push_back(on_clock(
        "r", 0, 100, [&](long i) { return triangle(i) + (r == 2 ? 0.3 : 0.0) + 0.001 * r; }));
    // The force comes after the position, and has no outlier.
    repeats.back().values[Channel::force] = std::vector<double>(100, static_cast<double>(r));
  }
  const Record record = average("c", repeats, as_they_are());
  // Positions are 0, 0.001, 0.302. The deviation is the distance of the last from the mean of the
  // others, over the sd.
  const double mean = 0.303 / 3.0;
  const double sd =
      std::sqrt((mean * mean + std::pow(mean - 0.001, 2) + std::pow(0.302 - mean, 2)) / 2.0);
  CHECK_THAT(record.repeat_reports[2].deviation, WithinRel((0.302 - 0.0005) / sd, 1e-6));
  // Forces are 0, 1, 2 with an sd of 1. The first is 1.5 from the mean of the others.
  CHECK_THAT(record.repeat_reports[0].deviation, WithinRel(1.5, 1e-6));
}

TEST_CASE("average: gaps and overlengths are named beyond a hundredth of the record",
          "[datasets]") {
  const auto warnings_of = [](long first, std::size_t samples) {
    return average(
        "c", {on_clock("whole", 0, 1000, triangle), on_clock("other", first, samples, triangle)},
        as_they_are());
  };
  CHECK(warnings_with(warnings_of(0, 991), "covers") == 0);
  CHECK(warnings_with(warnings_of(0, 989), "other covers 98.9 %") == 1);
  CHECK(warnings_with(warnings_of(9, 991), "covers") == 0);
  CHECK(warnings_with(warnings_of(11, 989), "other covers 98.9 %") == 1);
  CHECK(warnings_with(warnings_of(0, 1009), "longer") == 0);
  CHECK(warnings_with(warnings_of(0, 1011), "other is longer") == 1);
  CHECK(warnings_with(warnings_of(0, 1011), "1000 of its samples") == 1);
}

TEST_CASE("average: deviations are each repeat less the mean at its sample", "[datasets]") {
  std::vector<Repeat> repeats{on_clock("a", 0, 50, [](long i) { return triangle(i) + 0.01; }),
                              on_clock("b", 0, 50, [](long i) { return triangle(i) - 0.01; })};
  AverageOptions options = as_they_are();
  options.keep_deviations = true;
  const Record record = average("c", repeats, options);
  const auto& deviations = position_of(record).deviations;
  REQUIRE(deviations.size() == 2);
  for (std::size_t i = 0; i < 50; ++i) {
    CHECK_THAT(deviations[0][i], WithinAbs(0.01, 1e-12));
    CHECK_THAT(deviations[1][i], WithinAbs(-0.01, 1e-12));
  }
}
