#include "datasets/prepare/alignment.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "datasets/synthetic/noise.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinAbs;

namespace {

constexpr double kClock_s = 1e-3;

/// A motion of several periods with noise. It begins `late` samples later, on a clock that starts
/// at `first_s`.
Repeat moved(const std::string& source, double late, double noise_sd = 0.0, double first_s = 0.0,
             double dt = kClock_s) {
  auto stream = random_stream(3, {source});
  Repeat repeat;
  repeat.source = source;
  for (int i = 0; i < 2000; ++i) {
    const double t = first_s + dt * i;
    const double at = t / kClock_s - late;
    repeat.time_s.push_back(t);
    repeat.values[Channel::position].push_back(
        std::sin(0.03 * at) + 0.4 * std::sin(0.11 * at + 1.0) + normal(stream, noise_sd));
  }
  return repeat;
}

}  // namespace

TEST_CASE("align: what comes later is shifted back, relative to the mean", "[datasets]") {
  const auto aligned = align({moved("a", 0.0), moved("b", 3.0), moved("c", 1.5)}, true);
  // The mean is 1.5 samples late.
  CHECK_THAT(aligned.offset_s[0] / kClock_s, WithinAbs(-1.5, 1e-3));
  CHECK_THAT(aligned.offset_s[1] / kClock_s, WithinAbs(1.5, 1e-3));
  CHECK_THAT(aligned.offset_s[2] / kClock_s, WithinAbs(0.0, 1e-3));
  // Sample i of the common time base is at index i + shift of the repeat.
  CHECK_THAT(aligned.shift[0], WithinAbs(-1.5, 1e-3));
  CHECK_THAT(aligned.shift[1], WithinAbs(1.5, 1e-3));
  CHECK(aligned.shift[2] == 0.0);
}

TEST_CASE("align: shifts from a fiftieth of a sample on are made", "[datasets]") {
  // Each shift is half the distance, because offsets are relative to their mean.
  const auto apart = align({moved("a", 0.0), moved("b", 0.1)}, true);
  CHECK_THAT(apart.shift[1], WithinAbs(0.05, 2e-3));
  CHECK_THAT(apart.shift[0], WithinAbs(-0.05, 2e-3));
  const auto together = align({moved("a", 0.0), moved("b", 0.02)}, true);
  CHECK(together.shift == std::vector<double>{0.0, 0.0});
}

TEST_CASE("align: a shift within three of its standard deviations is not made", "[datasets]") {
  int made = 0;
  for (int draw = 0; draw < 60; ++draw) {
    const std::string number = std::to_string(draw);
    const auto aligned =
        align({moved("a" + number, 0.0, 0.5), moved("b" + number, 0.0, 0.5)}, true);
    made += aligned.shift[0] != 0.0 || aligned.shift[1] != 0.0 ? 1 : 0;
    CHECK(std::abs(aligned.offset_s[0]) > 0.0);
  }
  CHECK(made <= 3);
}

TEST_CASE("align: two clean repeats are told apart beside a noisy one", "[datasets]") {
  for (int draw = 0; draw < 5; ++draw) {
    const auto aligned = align(
        {moved("noisy" + std::to_string(draw), 0.0, 1.5), moved("b", 0.0), moved("c", 0.4)}, true);
    CHECK_THAT((aligned.offset_s[2] - aligned.offset_s[1]) / kClock_s, WithinAbs(0.4, 1e-3));
  }
}

TEST_CASE("align: the central repeat is no better known than the others", "[datasets]") {
  // With two repeats, a random delay is divided equally between them, which makes it no more
  // significant.
  for (int draw = 0; draw < 40; ++draw) {
    const std::string number = std::to_string(draw);
    const auto aligned =
        align({moved("c" + number, 0.0, 0.3), moved("d" + number, 0.0, 0.3)}, true);
    CHECK((aligned.shift[0] == 0.0) == (aligned.shift[1] == 0.0));
  }
}

TEST_CASE("align: a clock that starts later is no delay", "[datasets]") {
  // The clock starts ten samples later, and the motion is late by two samples.
  const auto aligned = align({moved("a", 0.0), moved("b", 2.0, 0.0, 10.0 * kClock_s)}, true);
  CHECK_THAT(aligned.offset_s[1] / kClock_s, WithinAbs(1.0, 1e-3));
  CHECK_THAT(aligned.shift[0], WithinAbs(-1.0, 1e-3));
  CHECK_THAT(aligned.shift[1], WithinAbs(-10.0 + 1.0, 1e-3));
}

TEST_CASE("align: rates that drift apart by a tenth of a sample are two rates", "[datasets]") {
  const auto drifting = [](double samples) {
    return std::vector<Repeat>{moved("a", 0.0),
                               moved("b", 0.0, 0.0, 0.0, kClock_s * (1.0 + samples / 2000.0))};
  };
  CHECK_NOTHROW(align(drifting(0.08), true));
  CHECK_THROWS_WITH(align(drifting(0.12), true), Contains("at the same rate"));
}

TEST_CASE("align: samples within a quarter of an interval of their place are even", "[datasets]") {
  for (const double off : {0.24, 0.26}) {
    std::vector<Repeat> repeats{moved("a", 0.0), moved("b", 1.0)};
    for (Repeat& repeat : repeats) repeat.time_s[700] += off * kClock_s;
    CHECK(align(repeats, true).warnings.size() == (off > 0.25 ? 1U : 0U));
  }
}

TEST_CASE("align: all repeats are shifted or none", "[datasets]") {
  int shifted = 0;
  int insignificant = 0;
  for (int draw = 0; draw < 20; ++draw) {
    std::vector<Repeat> repeats;
    for (int r = 0; r < 6; ++r)
      repeats.push_back(moved("s" + std::to_string(6 * draw + r), r == 0 ? 2.5 : 0.0, 0.5));
    const auto aligned = align(repeats, true);
    if (aligned.shift[0] == 0.0) continue;
    ++shifted;
    for (std::size_t r = 0; r < repeats.size(); ++r) {
      const double offset = aligned.offset_s[r] / kClock_s;
      insignificant += std::abs(offset) > 0.02 && std::abs(offset) < 0.8 ? 1 : 0;
      CHECK_THAT(aligned.shift[r], WithinAbs(std::abs(offset) > 0.02 ? offset : 0.0, 1e-9));
      CHECK_THAT(aligned.shifted_s[r] / kClock_s, WithinAbs(aligned.shift[r], 1e-9));
    }
  }
  CHECK(shifted > 10);
  CHECK(insignificant > 20);  // which would not have been shifted by themselves
}
