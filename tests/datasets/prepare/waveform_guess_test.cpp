#include "datasets/prepare/waveform_guess.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "datasets/synthetic/noise.hpp"
#include "model/signal/signal.hpp"

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::Contains;
using Catch::WithinRel;

namespace {

constexpr double kGuessRate_hz = 500.0;

std::vector<double> times(double duration_s) {
  std::vector<double> t;
  for (int i = 0; i <= duration_s * kGuessRate_hz; ++i) t.push_back(i / kGuessRate_hz);
  return t;
}

/// Guesses the waveform of a signal with an amplitude of 4, noise of 0.5 % of it, and an offset.
WaveformGuess guess_of(const model::Signal& signal, double duration_s, double offset = 0.0) {
  auto stream = random_stream(4, {"waveform"});
  const auto t = times(duration_s);
  std::vector<double> x;
  for (const double time_s : t) x.push_back(offset + signal.value(time_s) + normal(stream, 0.02));
  return guess_waveform(t, x);
}

}  // namespace

TEST_CASE("guess_waveform: sine and square with frequency and amplitude", "[datasets]") {
  const double f = GENERATE(0.37, 2.0, 11.0);
  const WaveformGuess sine = guess_of(model::Signal::sine(4.0, f), 8.0);
  CHECK(sine.waveform == Waveform::sine);
  CHECK_THAT(sine.frequency_hz.value(), WithinRel(f, 5e-3));
  CHECK_THAT(sine.amplitude.value(), WithinRel(4.0, 0.01));
  CHECK(sine.can_be_generated);
  const WaveformGuess square = guess_of(model::Signal::square(4.0, f), 8.0);
  CHECK(square.waveform == Waveform::square);
  CHECK_THAT(square.frequency_hz.value(), WithinRel(f, 5e-3));
  CHECK_THAT(square.amplitude.value(), WithinRel(4.0, 0.03));
  CHECK_THAT(square.description, Contains("a square of"));
}

TEST_CASE("guess_waveform: an offset or a phase is told, not generated", "[datasets]") {
  const WaveformGuess shifted = guess_of(model::Signal::sine(4.0, 1.0), 8.0, 3.0);
  CHECK(shifted.waveform == Waveform::sine);
  CHECK_FALSE(shifted.can_be_generated);
  const auto late = model::Signal::ripple(0.0, 4.0, 1.0, 0.5 * std::numbers::pi);
  CHECK_FALSE(guess_of(late, 8.0).can_be_generated);
}

TEST_CASE("guess_waveform: chirps, steps, constants and noise", "[datasets]") {
  const WaveformGuess chirp = guess_of(model::Signal::chirp(4.0, 0.5, 5.0, 10.0, false), 10.0);
  CHECK(chirp.waveform == Waveform::chirp);
  CHECK(chirp.frequency_hz.value() < 1.5);
  CHECK(chirp.end_frequency_hz.value() > 4.0);

  const auto t = times(6.0);
  std::vector<double> steps;
  for (const double time_s : t) steps.push_back(time_s < 1.0 ? 0.0 : time_s < 3.0 ? 2.0 : -2.0);
  const WaveformGuess step = guess_waveform(t, steps);
  CHECK(step.waveform == Waveform::recorded);
  CHECK_FALSE(step.frequency_hz);
  CHECK(step.description == "2 steps");

  const std::vector<double> still(t.size(), 1.0);
  CHECK(guess_waveform(t, still).description == "constant");
  CHECK(guess_waveform({}, {}).waveform == Waveform::recorded);

  auto stream = random_stream(4, {"noise"});
  const auto noise = white_noise(stream, t.size(), 1.0);
  CHECK(guess_waveform(t, noise).waveform == Waveform::recorded);
}

TEST_CASE("guess_waveform: a few periods tell the frequency between the samples", "[datasets]") {
  // At 11.3 Hz and 500 Hz sampling, one period has 44.2 samples, and three have 133.
  const auto t = times(0.4);
  std::vector<double> x;
  for (const double time_s : t) x.push_back(std::sin(2.0 * std::numbers::pi * 11.3 * time_s + 0.7));
  CHECK_THAT(guess_waveform(t, x).frequency_hz.value(), WithinRel(11.3, 1e-3));
}

TEST_CASE("guess_waveform: a sine explains 98 % of its variance", "[datasets]") {
  const auto t = times(8.0);
  for (const double third : {0.1, 0.2}) {
    std::vector<double> x;
    for (const double time_s : t) {
      const double angle = 2.0 * std::numbers::pi * time_s;
      x.push_back(std::sin(angle) + third * std::sin(3.0 * angle));
    }
    // The fundamental has 1 / (1 + third^2) of the variance: 99 % and 96 %.
    const WaveformGuess guess = guess_waveform(t, x);
    CHECK((guess.waveform == Waveform::sine) == (third == 0.1));
  }
}
