#include "datasets/prepare/average.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "tests/datasets/position_of.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinAbs;
using Catch::WithinRel;
using rigcal::test::position_of;

namespace {

using Shape = std::function<double(double)>;

/// Response of a rig to a square reference of 10 Hz.
double square_response(double t) {
  const double phase = 10.0 * t - std::floor(10.0 * t);
  const double x = std::fmod(phase, 0.5) / 0.03;
  return (phase < 0.5 ? 1.0 : -1.0) * (1.0 - 2.0 * std::exp(-x) * (1.0 + x));
}

double sine_response(double t) { return std::sin(20.0 * std::numbers::pi * t); }

Repeat repeat_of(const std::string& source, const Shape& shape, double late_s, double noise_sd,
                 unsigned seed, int samples = 2000, double rate_hz = 1000.0) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  Repeat repeat;
  repeat.source = source;
  auto& x = repeat.values[Channel::position];
  for (int i = 0; i < samples; ++i) {
    repeat.time_s.push_back(i / rate_hz);
    x.push_back(shape(repeat.time_s.back() - late_s) + noise_sd * normal(engine));
  }
  return repeat;
}

std::vector<Repeat> jittered(const Shape& shape, const std::vector<double>& late_s,
                             double noise_sd) {
  std::vector<Repeat> repeats;
  for (std::size_t r = 0; r < late_s.size(); ++r)
    repeats.push_back(repeat_of("r" + std::to_string(r) + ".csv", shape, late_s[r], noise_sd,
                                static_cast<unsigned>(r + 1)));
  return repeats;
}

double rms(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  double squares = 0.0;
  for (std::size_t i = begin; i < end; ++i) squares += x[i] * x[i];
  return std::sqrt(squares / static_cast<double>(end - begin));
}

}  // namespace

TEST_CASE("average: mean, sd and count of three numbers", "[datasets]") {
  std::vector<Repeat> repeats;
  for (const double value : {1.0, 2.0, 6.0})
    repeats.push_back({"r", {0.0, 0.1}, {{Channel::position, {value, -value}}}});
  const Record record = average("c", repeats, {.align = false, .known_sd = {}});
  CHECK(record.condition == "c");
  CHECK(record.repeats == 3);
  CHECK_THAT(position_of(record).mean[0], WithinAbs(3.0, 1e-15));
  CHECK_THAT(position_of(record).mean[1], WithinAbs(-3.0, 1e-15));
  // The sample variance is (4 + 1 + 9) / 2 at both samples.
  CHECK_THAT(position_of(record).sd[0], WithinRel(std::sqrt(7.0), 1e-14));
  CHECK_THAT(position_of(record).pooled_sd, WithinRel(std::sqrt(7.0), 1e-14));
  CHECK_THAT(position_of(record).sd_of_mean, WithinRel(std::sqrt(7.0 / 3.0), 1e-14));
  CHECK(position_of(record).count == std::vector<int>{3, 3});
  // The value 6 is compared with 1.5, the mean of the others.
  CHECK_THAT(record.repeat_reports[2].deviation, WithinRel(4.5 / std::sqrt(7.0), 1e-14));
}

TEST_CASE("average: pooled standard deviation is that of the noise", "[datasets]") {
  for (const int n : {2, 3, 5, 12}) {
    CAPTURE(n);
    const auto repeats = jittered(sine_response, std::vector<double>(n, 0.0), 0.05);
    const Record record = average("c", repeats, {});
    // There are 2000 (n - 1) degrees of freedom, so the standard error is 1.6 % for n = 2.
    CHECK_THAT(position_of(record).pooled_sd, WithinRel(0.05, 0.05));
    CHECK_THAT(position_of(record).sd_of_mean, WithinRel(0.05 / std::sqrt(n), 0.05));
    CHECK(position_of(record).repeats == n);
    CHECK(record.warnings.empty());
    for (const auto& report : record.repeat_reports) CHECK_FALSE(report.outlier);
  }
}

TEST_CASE("average: jittered repeats keep their amplitude and their noise", "[datasets]") {
  const std::vector<double> late_s{0.0143, -0.0098, 0.0037, -0.0121, 0.0039};  // mean 0
  for (const Shape& shape : {Shape(square_response), Shape(sine_response)}) {
    const auto repeats = jittered(shape, late_s, 0.01);
    const Record aligned = average("c", repeats, {});
    const Record plain = average("c", repeats, {.align = false, .known_sd = {}});
    std::vector<double> truth;
    for (const double t : aligned.time_s) truth.push_back(shape(t));
    const double size = rms(truth, 100, 1900);
    CHECK_THAT(rms(position_of(aligned).mean, 100, 1900) / size, WithinAbs(1.0, 0.002));
    CHECK(rms(position_of(plain).mean, 100, 1900) / size <
          0.9);  // without alignment, amplitude is lost
    // Interpolation reduces the standard deviation of white noise by up to 3 %.
    CHECK_THAT(position_of(aligned).pooled_sd, WithinRel(0.01, 0.05));
    for (std::size_t r = 0; r < late_s.size(); ++r) {
      CAPTURE(r);
      CHECK_THAT(aligned.repeat_reports[r].offset_s, WithinAbs(late_s[r], 2e-5));  // 0.02 samples
    }
    // Because the mean offset is zero, the mean equals the truth.
    for (std::size_t i = 100; i < 1900; ++i)
      CHECK_THAT(position_of(aligned).mean[i], WithinAbs(truth[i], 0.03));
  }
}

TEST_CASE("average: aligning neither invents nor removes a common delay", "[datasets]") {
  const std::vector<double> late_s{0.007, 0.003, 0.006, 0.004};  // mean 0.005
  const Record record = average("c", jittered(square_response, late_s, 0.005), {});
  double worst = 0.0;
  for (std::size_t i = 100; i < 1900; ++i)
    worst = std::max(
        worst, std::abs(position_of(record).mean[i] - square_response(record.time_s[i] - 0.005)));
  CHECK(worst < 0.02);
  CHECK_THAT(record.repeat_reports[0].offset_s, WithinAbs(0.002, 2e-5));
  CHECK_THAT(record.repeat_reports[1].offset_s, WithinAbs(-0.002, 2e-5));
}

TEST_CASE("average: one false start does not shift the others", "[datasets]") {
  const std::vector<double> late_s{0.0004, 0.04, -0.0004, 0.0002, -0.0002};
  const Record record = average("c", jittered(square_response, late_s, 0.005), {});
  CHECK_THAT(record.repeat_reports[0].offset_s, WithinAbs(0.0004, 3e-5));
  CHECK_THAT(record.repeat_reports[1].offset_s, WithinAbs(0.04, 3e-5));
}

TEST_CASE("average: repeats that start together are not interpolated", "[datasets]") {
  const auto repeats = jittered(sine_response, {0.0, 0.0, 0.0}, 0.05);
  const Record aligned = average("c", repeats, {});
  const Record plain = average("c", repeats, {.align = false, .known_sd = {}});
  REQUIRE(aligned.time_s.size() == plain.time_s.size());
  CHECK(position_of(aligned).mean == position_of(plain).mean);
  CHECK(position_of(aligned).count == std::vector<int>(2000, 3));
}

TEST_CASE("average: ends that not every repeat covers count fewer", "[datasets]") {
  const Record record = average("c", jittered(sine_response, {0.004, -0.001, -0.003}, 0.001), {});
  REQUIRE(record.time_s.size() == 2000);
  CHECK(position_of(record).count.front() == 1);  // only the late repeat covers the start
  CHECK(position_of(record).count[5] == 3);
  CHECK(position_of(record).count[1000] == 3);
  CHECK(position_of(record).count.back() == 2);
  CHECK(std::isnan(position_of(record).sd.front()));
  CHECK_THAT(position_of(record).pooled_sd, WithinRel(0.001, 0.06));
}

TEST_CASE("average: an outlier is named and stays in the mean", "[datasets]") {
  for (const int n : {3, 4, 5}) {
    CAPTURE(n);
    auto repeats = jittered(sine_response, std::vector<double>(n, 0.0), 0.01);
    for (double& value : repeats[1].values[Channel::position]) value += 0.2;
    const Record record = average("c", repeats, {});
    for (int r = 0; r < n; ++r) CHECK(record.repeat_reports[r].outlier == (r == 1));
    REQUIRE(record.warnings.size() == 1);
    CHECK_THAT(record.warnings[0], Contains("position: r1.csv") && Contains("stays in the mean"));
    const double mean =
        std::accumulate(position_of(record).mean.begin(), position_of(record).mean.end(), 0.0) /
        2000.0;
    CHECK_THAT(mean, WithinAbs(0.2 / n, 0.002));
  }
}

TEST_CASE("average: of two repeats that disagree neither is named the wrong one", "[datasets]") {
  auto repeats = jittered(sine_response, {0.0, 0.0}, 0.01);
  for (double& value : repeats[1].values[Channel::position]) value += 0.3;
  const Record record = average("c", repeats, {});
  REQUIRE(record.warnings.size() == 1);
  CHECK_THAT(record.warnings[0],
             Contains("r0.csv and r1.csv") && Contains("unknown which one is wrong"));
  CHECK_FALSE(record.repeat_reports[0].outlier);
  CHECK_FALSE(record.repeat_reports[1].outlier);
}

TEST_CASE("average: hum and coarse steps are named", "[datasets]") {
  std::vector<Repeat> repeats;
  for (unsigned r = 0; r < 5; ++r) {
    repeats.push_back(repeat_of("r" + std::to_string(r), sine_response, 0.0, 0.01, r));
    for (std::size_t i = 0; i < repeats[r].time_s.size(); ++i) {
      repeats[r].values[Channel::position][i] +=
          0.05 * std::sin(100.0 * std::numbers::pi * repeats[r].time_s[i] + 2.5 * r);
    }
  }
  CHECK_THAT(average("hum", repeats, {}).warnings.front(),
             Contains("position: hum of the mains, 50 Hz with an amplitude of 0.05"));
  for (unsigned r = 0; r < 5; ++r) {
    repeats[r] = repeat_of("r" + std::to_string(r), sine_response, 0.0, 0.01, r);
    for (double& x : repeats[r].values[Channel::position]) x = std::round(x / 0.04) * 0.04;
  }
  CHECK_THAT(average("steps", repeats, {}).warnings.front(),
             Contains("position: readings come in steps of 0.04 m, and the repeats differ by"));
}

TEST_CASE("average: a single repeat has no false standard deviation", "[datasets]") {
  const auto repeats = jittered(sine_response, {0.0}, 0.01);
  const Record unknown = average("c", repeats, {});
  CHECK(position_of(unknown).sd.empty());
  CHECK(std::isnan(position_of(unknown).pooled_sd));
  CHECK(std::isnan(position_of(unknown).sd_of_mean));
  CHECK(position_of(unknown).mean == repeats[0].values.at(Channel::position));
  REQUIRE(unknown.warnings.size() == 1);

  AverageOptions options;
  options.known_sd[Channel::position] = 0.02;
  options.repeats_averaged = 5;  // the sd is that of the samples in the file
  const Record known = average("c", repeats, options);
  CHECK(position_of(known).pooled_sd == 0.02);
  CHECK(position_of(known).sd_of_mean == 0.02);
  CHECK(position_of(known).repeats == 5);
  CHECK(known.repeats == 5);
  CHECK(known.warnings.empty());
}

TEST_CASE("average: identical repeats tell no noise", "[datasets]") {
  const auto one = jittered(sine_response, {0.0}, 0.0);
  const Record record = average("c", {one[0], one[0]}, {});
  CHECK(std::isnan(position_of(record).sd_of_mean));
  CHECK_THAT(record.warnings.at(0), Contains("identical"));
}

TEST_CASE("average: of three repeats two are one recording", "[datasets]") {
  const auto repeats = jittered(sine_response, {0.0, 0.0}, 0.01);
  auto copy = repeats[0];
  copy.source = "copy.csv";
  const Record record = average("c", {repeats[0], repeats[1], copy}, {});
  REQUIRE(record.warnings.size() == 1);
  CHECK_THAT(record.warnings[0], Contains("position: r0.csv and copy.csv are identical"));
  // The other repeat is not to blame.
  for (const RepeatReport& report : record.repeat_reports) CHECK_FALSE(report.outlier);

  auto off = jittered(sine_response, {0.0, 0.0, 0.0, 0.0}, 0.01);
  for (double& x : off[3].values[Channel::position]) x += 0.2;
  off.push_back(off[0]);
  const Record with_outlier = average("c", off, {});
  CHECK(with_outlier.repeat_reports[3].outlier);
  CHECK(with_outlier.warnings.size() == 2);
}

TEST_CASE("average: channels of different repeats are averaged over their carriers", "[datasets]") {
  auto repeats = jittered(sine_response, {0.0, 0.0, 0.0}, 0.01);
  repeats[0].values[Channel::pressure_a] = std::vector<double>(2000, 1e5);
  repeats[1].values[Channel::pressure_a] = std::vector<double>(2000, 3e5);
  repeats[2].values[Channel::pressure_b] = std::vector<double>(2000, 7e5);
  const Record record = average("c", repeats, {});
  CHECK(position_of(record).repeats == 3);
  CHECK(record.channels.at(Channel::pressure_a).repeats == 2);
  CHECK(record.channels.at(Channel::pressure_a).mean[5] == 2e5);
  CHECK(record.channels.at(Channel::pressure_b).repeats == 1);
  CHECK(record.channels.at(Channel::pressure_b).sd.empty());
  CHECK(record.channels.count(Channel::force) == 0);
}

TEST_CASE("average: aligned on the reference where it is recorded", "[datasets]") {
  auto repeats = jittered(sine_response, {0.0, 0.0}, 0.0);
  // Both references start alike. The second rig lags by 3 ms, and this lag must not be removed.
  for (Repeat& repeat : repeats)
    repeat.values[Channel::reference] =
        jittered(sine_response, {0.0}, 0.0)[0].values.at(Channel::position);
  repeats[1].values[Channel::position] =
      jittered(sine_response, {0.003}, 0.0)[0].values.at(Channel::position);
  const Record record = average("c", repeats, {});
  CHECK_THAT(record.repeat_reports[0].offset_s, WithinAbs(0.0, 1e-6));
  CHECK_THAT(record.repeat_reports[1].offset_s, WithinAbs(0.0, 1e-6));
}

TEST_CASE("average: time columns that start apart are put on the first", "[datasets]") {
  auto repeats = jittered(sine_response, {0.0, 0.0}, 0.0);
  // The second file begins 10.25 samples later, on the same clock.
  Repeat& second = repeats[1];
  for (std::size_t i = 0; i < second.time_s.size(); ++i) {
    second.time_s[i] += 0.01025;
    second.values[Channel::position][i] = sine_response(second.time_s[i]);
  }
  const Record record = average("c", repeats, {.align = false, .known_sd = {}});
  CHECK(position_of(record).count.front() == 1);
  CHECK(position_of(record).count[11] == 2);
  for (std::size_t i = 30; i < 2000; ++i)
    CHECK_THAT(position_of(record).mean[i], WithinAbs(sine_response(record.time_s[i]), 2e-4));
}

TEST_CASE("average: a short repeat is used as far as it goes and named", "[datasets]") {
  auto repeats = jittered(sine_response, {0.0, 0.0, 0.0}, 0.01);
  repeats[2].time_s.resize(1500);
  repeats[2].values[Channel::position].resize(1500);
  const Record record = average("c", repeats, {});
  CHECK(position_of(record).count[1400] == 3);
  CHECK(position_of(record).count[1600] == 2);
  REQUIRE(record.warnings.size() == 1);
  CHECK_THAT(record.warnings[0], Contains("r2.csv covers 75 %"));
}

TEST_CASE("average: incompatible repeats are named", "[datasets]") {
  const auto first = repeat_of("first.csv", sine_response, 0.0, 0.0, 1);
  const auto dense = repeat_of("dense.csv", sine_response, 0.0, 0.0, 1, 2000, 1250.0);
  CHECK_THROWS_WITH(average("c", {first, dense}, {}),
                    Contains("first.csv") && Contains("dense.csv") && Contains("0.0008 s"));
  auto later = first;
  later.source = "later.csv";
  for (double& t : later.time_s) t += 100.0;
  CHECK_THROWS_WITH(average("c", {first, later}, {}), Contains("later.csv") && Contains("overlap"));
  auto ragged = first;
  ragged.values[Channel::force] = {1.0};
  CHECK_THROWS_AS(average("c", {ragged}, {}), std::invalid_argument);
  CHECK_THROWS_AS(average("c", {}, {}), std::invalid_argument);
  auto uneven = first;
  uneven.time_s[5] += 0.0004;
  CHECK_THROWS_WITH(average("c", {first, uneven}, {}), Contains("equidistant"));
  CHECK(average("c", {uneven, uneven}, {}).time_s == uneven.time_s);
}
