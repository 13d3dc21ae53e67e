#include "datasets/prepare/recognised_drive.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

using namespace rigcal::datasets;
using Catch::Contains;
using rigcal::model::Signal;

namespace {

struct Sampled {
  std::vector<double> time_s;
  std::vector<double> drive;
};

Sampled sampled(const Signal& signal, double step = 0.0, double rate_hz = 1000.0,
                int count = 4001) {
  Sampled result;
  for (int i = 0; i < count; ++i) {
    const double t = i / rate_hz;
    const double value = signal.value(t);
    result.time_s.push_back(t);
    result.drive.push_back(step > 0.0 ? step * std::round(value / step) : value);
  }
  return result;
}

std::optional<RecognisedDrive> recognised(const Sampled& s, double sd = 0.0) {
  return recognised_drive(s.time_s, s.drive, "m", sd);
}

double farthest(const Sampled& s, const Signal& signal) {
  double result = 0.0;
  for (std::size_t i = 0; i < s.drive.size(); ++i)
    result = std::max(result, std::abs(s.drive[i] - signal.value(s.time_s[i])));
  return result;
}

}  // namespace

TEST_CASE("recognised_drive: a sine, so that it repeats itself", "[datasets]") {
  for (const double step : {0.0, 1e-6, 24.4e-6}) {
    CAPTURE(step);
    const auto found = recognised(sampled(Signal::sine(0.0508, 3.7), step));
    REQUIRE(found);
    CHECK_THAT(found->name, Contains("sine of 3.7 Hz"));
    CHECK(found->signal.period_s() == 1.0 / 3.7);
    CHECK(found->signal.reverses());
  }
  const Sampled off = sampled(Signal::ripple(0.01, 0.05, 2.3, 0.7), 1e-6);
  const auto found = recognised(off);
  REQUIRE(found);
  CHECK(farthest(off, found->signal) < 0.75e-6);
}

TEST_CASE("recognised_drive: a square wave, to its edges", "[datasets]") {
  for (const double f : {0.1, 10.0, 0.7}) {
    CAPTURE(f);
    const Sampled square = sampled(Signal::square(0.004, f), 0.0, 1000.0, 25'001);
    const auto found = recognised(square);
    REQUIRE(found);
    CHECK(found->signal.period_s() == 1.0 / f);
    CHECK(farthest(square, found->signal) == 0.0);
  }
  Sampled late = sampled(Signal::square(0.004, 10.0));
  late.drive[51] = late.drive[50] = late.drive[49];  // one edge is later than its instant
  CHECK_FALSE(recognised(late));
}

TEST_CASE("recognised_drive: a sample at the instant of an edge has either level", "[datasets]") {
  // Hopsan writes 0 at t = 0, and at an edge what its solver has there.
  const Sampled exact = sampled(Signal::square(0.004, 10.0));
  Sampled hopsan = exact;
  hopsan.drive[0] = 0.0;
  for (const std::size_t edge : {50U, 300U, 350U}) hopsan.drive[edge] = hopsan.drive[edge - 1];
  hopsan.drive[1000] = 0.0;
  const auto found = recognised(hopsan);
  REQUIRE(found);
  CHECK(found->signal.period_s() == 1.0 / 10.0);
  CHECK(found->farthest == 0.0);

  Sampled away = hopsan;
  away.drive[75] = 0.0;  // not at an edge
  CHECK_FALSE(recognised(away));
  Sampled beyond = hopsan;
  beyond.drive[50] = 0.0041;
  CHECK_FALSE(recognised(beyond));
  // All edges are a sample late: the drive was, or its recording.
  Sampled all = exact;
  for (std::size_t edge = 50; edge < all.drive.size(); edge += 50)
    all.drive[edge] = exact.drive[edge - 1];
  CHECK_FALSE(recognised(all));
}

TEST_CASE("recognised_drive: chirps, linear and logarithmic", "[datasets]") {
  for (const bool logarithmic : {false, true}) {
    CAPTURE(logarithmic);
    const Sampled chirp = sampled(Signal::chirp(0.01, 0.5, 20.0, 4.0, logarithmic), 1e-7);
    const auto found = recognised(chirp);
    REQUIRE(found);
    CHECK_THAT(found->name, Contains(logarithmic ? "logarithmic chirp" : "linear chirp"));
    CHECK(farthest(chirp, found->signal) < 1e-7);
  }
}

TEST_CASE("recognised_drive: what is no generated signal is none", "[datasets]") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  Sampled noisy = sampled(Signal::sine(0.05, 2.0));
  for (double& x : noisy.drive) x += 5e-5 * normal(random);
  CHECK_FALSE(recognised(noisy));
  CHECK(recognised(noisy, 5e-5));  // the campaign attributes it to sensor noise
  CHECK_FALSE(recognised(noisy, 1e-5));
  // Every sample is off by twice the stated noise: no sample is too far, but all together are.
  Sampled zigzag = sampled(Signal::sine(0.05, 2.0));
  for (std::size_t i = 0; i < zigzag.drive.size(); ++i)
    zigzag.drive[i] += i % 2 == 0 ? 2e-5 : -2e-5;
  CHECK_FALSE(recognised(zigzag, 1e-5));
  CHECK(recognised(zigzag, 2e-5));
  CHECK(recognised(sampled(Signal::sine(0.05, 2.0), 5e-4)));
  CHECK_FALSE(recognised(sampled(Signal::sine(0.05, 2.0), 5e-3)));  // ten steps show no waveform
  Sampled clipped = sampled(Signal::sine(0.05, 2.0), 1e-6);
  for (double& x : clipped.drive) x = std::min(x, 0.0499);
  CHECK_FALSE(recognised(clipped));
  Sampled paused = sampled(Signal::sine(0.05, 2.0), 1e-6);
  std::fill(paused.drive.begin() + 3500, paused.drive.end(), 0.0);
  CHECK_FALSE(recognised(paused));
  Sampled constant = sampled(Signal::constant(0.01));
  CHECK_FALSE(recognised(constant));
  Sampled pulses = sampled(Signal::constant(-1.0));
  for (const std::size_t i : {100U, 350U, 900U}) pulses.drive[i] = 1.0;
  CHECK_FALSE(recognised(pulses));
}

TEST_CASE("recognise_drive: a note says so, and the channel's key prevents it", "[datasets]") {
  Campaign campaign;
  campaign.rig.controller = rigcal::model::ControllerKind::pid;
  campaign.channels[Channel::reference].channel = Channel::reference;
  Condition condition;
  const Sampled s = sampled(Signal::sine(0.05, 2.0), 1e-6);
  Record record;
  record.time_s = s.time_s;
  record.channels[Channel::reference].mean = s.drive;
  Record kept = record;
  recognise_drive(campaign, condition, record);
  REQUIRE(record.generated_drive);
  REQUIRE(record.notes.size() == 1);
  CHECK_THAT(record.notes[0],
             Contains("reference is a sine of 2 Hz") && Contains("recognise = false"));
  campaign.channels[Channel::reference].recognise = false;
  recognise_drive(campaign, condition, kept);
  CHECK_FALSE(kept.generated_drive);
  CHECK(kept.notes.empty());
}
