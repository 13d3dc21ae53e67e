#include "model/signal/signal.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "tests/model/rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

struct Named {
  const char* name;
  Signal signal;
  double peak;
};

std::vector<Named> all_kinds() {
  return {
      {"constant", Signal::constant(-3.0), 3.0},
      {"sine", Signal::sine(2.0, 1.5), 2.0},
      {"ripple", Signal::ripple(5.0, 0.5, 3.0, 0.7), 5.5},
      {"square", Signal::square(2.0, 1.5), 2.0},
      {"chirp", Signal::chirp(2.0, 0.5, 4.0, 2.0, false), 2.0},
      {"falling chirp", Signal::chirp(2.0, 4.0, 0.5, 2.0, false), 2.0},
      {"logarithmic chirp", Signal::chirp(2.0, 0.5, 4.0, 2.0, true), 2.0},
      {"held", Signal::held({0.5, 1.0, 2.5}, {1.0, -4.0, 2.0}), 4.0},
      {"linear", Signal::linear({0.5, 1.0, 2.5}, {1.0, -4.0, 2.0}), 4.0},
  };
}

}  // namespace

TEST_CASE("signal: the slope is the derivative of the value", "[model]") {
  // Errors of a central difference with this step: h^2 / 6 of the third derivative, which is below
  // 4e4, and rounding / h, which is 1e-10.
  constexpr double kStep = 1e-5;
  for (const Named& row : all_kinds()) {
    for (const double t : {0.13, 0.71, 1.9, 2.2, 3.05}) {
      CAPTURE(row.name, t);
      const std::size_t segment = row.signal.segment_at(t);
      const SignalSample s = row.signal.sample(segment, t);
      const SignalSample after = row.signal.sample(segment, t + kStep);
      const SignalSample before = row.signal.sample(segment, t - kStep);
      CHECK_THAT(s.slope, WithinAbs((after.value - before.value) / (2.0 * kStep), 2e-6));
      CHECK(s.value == row.signal.value(t));
      CHECK(std::abs(s.value) <= row.peak);
    }
  }
}

TEST_CASE("signal: segments follow one another and begin where the one before ends", "[model]") {
  for (const Named& row : all_kinds()) {
    CAPTURE(row.name);
    for (std::size_t segment = 0; segment < 4; ++segment) {
      const double end = row.signal.segment_end(segment);
      if (end == kInfinity) break;
      CAPTURE(segment, end);
      CHECK(row.signal.segment_at(end) == segment + 1);
      CHECK(row.signal.segment_at(end - 1e-6) == segment);
      CHECK(row.signal.segment_end(segment + 1) > end);
    }
  }
}

TEST_CASE("signal: values by hand", "[model]") {
  struct Row {
    const char* name;
    Signal signal;
    double t, value;
  };
  const Signal held = Signal::held({0.5, 1.0, 2.5}, {1.0, -4.0, 2.0});
  const Signal linear = Signal::linear({0.5, 1.0, 2.5}, {1.0, -4.0, 2.0});
  for (const Row& row : {
           Row{"sine quarter", Signal::sine(2.0, 1.0), 0.25, 2.0},
           Row{"sine before 0", Signal::sine(2.0, 1.0), -0.25, -2.0},
           Row{"ripple", Signal::ripple(5.0, 0.5, 1.0, kPi / 2.0), 0.0, 5.5},
           Row{"square at 0", Signal::square(2.0, 1.0), 0.0, 2.0},
           Row{"square before its edge", Signal::square(2.0, 1.0), 0.499, 2.0},
           Row{"square at its edge", Signal::square(2.0, 1.0), 0.5, -2.0},
           Row{"square at its period", Signal::square(2.0, 1.0), 1.0, 2.0},
           Row{"square before 0", Signal::square(2.0, 1.0), -0.2, 2.0},
           Row{"held before the first", held, 0.0, 1.0},
           Row{"held at a sample", held, 1.0, -4.0},
           Row{"held just before", held, 0.999, 1.0},
           Row{"held at the end", held, 9.0, 2.0},
           Row{"linear before the first", linear, 0.0, 1.0},
           Row{"linear between", linear, 0.75, -1.5},
           Row{"linear after the last", linear, 9.0, 2.0},
           Row{"one sample", Signal::linear({1.0}, {7.0}), 0.0, 7.0},
       }) {
    CAPTURE(row.name);
    CHECK_THAT(row.signal.value(row.t), WithinAbs(row.value, 1e-14));
  }
}

TEST_CASE("square: rounded sample times at an edge get the new half period", "[model]") {
  for (const double frequency_hz : {0.1, 0.3, 1.0, 3.0, 7.0, 10.0, 30.0}) {
    const Signal square = Signal::square(1.0, frequency_hz);
    for (int k = 1; k < 400; ++k) {
      const double expected = k % 2 == 0 ? 1.0 : -1.0;
      const double edge =
          k * (0.5 / frequency_hz);  // rounded differently from the signal's own edges
      CAPTURE(frequency_hz, k);
      CHECK(square.value(edge) == expected);
      CHECK(square.value(std::nextafter(edge, 0.0)) == expected);
      CHECK(square.value(edge - 1e-6 / frequency_hz) == -expected);
    }
  }
}

TEST_CASE("chirp: phase and frequency are continuous where the sweep ends", "[model]") {
  for (const bool logarithmic : {false, true}) {
    CAPTURE(logarithmic);
    const Signal chirp = Signal::chirp(1.0, 0.5, 8.0, 2.3, logarithmic);
    const SignalSample before = chirp.sample(0, 2.3);
    const SignalSample after = chirp.sample(1, 2.3);
    CHECK_THAT(after.value, WithinAbs(before.value, 1e-12));
    CHECK_THAT(after.slope, WithinAbs(before.slope, 1e-10));
    CHECK(chirp.value(0.0) == 0.0);
    // d/dt A sin(phase) at 0 is A 2 pi f0; after the sweep the period is 1 / f1.
    CHECK_THAT(chirp.sample(0, 0.0).slope, WithinRel(2.0 * kPi * 0.5, 1e-14));
    CHECK_THAT(chirp.value(3.0 + 1.0 / 8.0), WithinAbs(chirp.value(3.0), 1e-12));
  }
  // Number of cycles in a linear sweep: (f0 + f1) / 2 times its length. In a logarithmic sweep:
  // (f1 - f0) T / ln(f1 / f0).
  CHECK_THAT(Signal::chirp(1.0, 1.0, 2.0, 1.5, false).value(1.5),
             WithinAbs(std::sin(2.0 * kPi * 2.25), 1e-12));
  CHECK_THAT(Signal::chirp(1.0, 1.0, 2.0, 1.5, true).value(1.5),
             WithinAbs(std::sin(2.0 * kPi * 1.5 / std::log(2.0)), 1e-12));
  // With the same frequency at both ends, either sweep is a sine.
  CHECK_THAT(Signal::chirp(1.0, 2.0, 2.0, 1.0, true).value(0.3),
             WithinAbs(Signal::sine(1.0, 2.0).value(0.3), 1e-12));
}

TEST_CASE("signal: no step may skip an oscillation", "[model]") {
  CHECK(Signal::sine(1.0, 10.0).max_step() <= 0.1 / 4.0);
  CHECK(Signal::chirp(1.0, 20.0, 1.0, 5.0, false).max_step() <= 0.05 / 4.0);
  CHECK(Signal::constant(1.0).max_step() == kInfinity);
  CHECK(Signal::square(1.0, 10.0).max_step() == kInfinity);  // breakpoints limit the steps
}

TEST_CASE("signal: refuses what is not a signal", "[model]") {
  CHECK_THROWS_AS(Signal::held({}, {}), std::invalid_argument);
  CHECK_THROWS_AS(Signal::held({0.0, 1.0}, {0.0}), std::invalid_argument);
  CHECK_THROWS_AS(Signal::linear({0.0, 0.0}, {0.0, 1.0}), std::invalid_argument);
  CHECK_THROWS_AS(Signal::held({0.0, kNaN}, {0.0, 1.0}), std::invalid_argument);
  CHECK_THROWS_AS(Signal::chirp(1.0, 1.0, 2.0, 0.0, false), std::invalid_argument);
  CHECK_THROWS_AS(Signal::chirp(1.0, 0.0, 2.0, 1.0, true), std::invalid_argument);
  for (const double frequency_hz : {-1.0, kNaN, kInfinity}) {
    CHECK_THROWS_AS(Signal::sine(1.0, frequency_hz), std::invalid_argument);
    CHECK_THROWS_AS(Signal::square(1.0, frequency_hz), std::invalid_argument);
    CHECK_THROWS_AS(Signal::chirp(1.0, 1.0, frequency_hz, 1.0, false), std::invalid_argument);
  }
}

TEST_CASE("Signal::shaped: a shape in pieces, of any amplitude and frequency", "[model]") {
  // Up, then constant, then down twice as far within half a period: 0, 1, 1, -1 at the ends of the
  // pieces.
  static constexpr PeriodicShape kShape{4,
                                        [](int piece, double phase) {
                                          if (piece == 0) return SignalSample{4.0 * phase, 4.0};
                                          if (piece == 1) return SignalSample{1.0, 0.0};
                                          if (piece == 2)
                                            return SignalSample{1.0 - 8.0 * (phase - 0.5), -8.0};
                                          return SignalSample{-1.0 + 4.0 * (phase - 0.75), 4.0};
                                        },
                                        false};
  const Signal signal = Signal::shaped(kShape, 3.0, 0.5);
  CHECK(signal.period_s() == std::optional(2.0));
  CHECK_FALSE(signal.reverses());
  for (std::size_t k = 0; k < 9; ++k) {
    const double end = 0.5 * static_cast<double>(k + 1);
    CHECK(signal.segment_end(k) == Approx(end));
    CHECK(signal.segment_at(end) == k + 1);  // at an edge, the later piece
    CHECK(signal.segment_at(end - 1e-3) == k);
  }
  CHECK(signal.value(0.25) == Approx(1.5));
  CHECK(signal.value(0.75) == Approx(3.0));
  CHECK(signal.value(1.25) == Approx(0.0).margin(1e-12));
  CHECK(signal.value(4.25) == Approx(1.5));  // two periods later
  CHECK(signal.sample(6, 3.25).slope == Approx(3.0 * 0.5 * -8.0));
  CHECK(signal.value(-0.1) == Approx(-0.6));  // the first piece continues before zero
  CHECK(signal.max_step() == kInfinity);
  CHECK_THROWS_AS(Signal::shaped(kShape, 1.0, -1.0), std::invalid_argument);
}
