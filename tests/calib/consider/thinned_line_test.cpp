#include "calib/consider/thinned_line.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/model/rig.hpp"

namespace rigcal::calib {
namespace {

std::vector<double> milliseconds(int samples) {
  std::vector<double> time_s;
  for (int i = 0; i < samples; ++i) time_s.push_back(1e-3 * i);
  return time_s;
}

/// Number of straight pieces between the first and the last sample.
std::size_t pieces_of(const model::Signal& signal, double end_s) {
  return signal.segment_at(end_s) - 1;
}

double largest_error(const model::Signal& signal, const std::vector<double>& time_s,
                     const std::vector<double>& value) {
  double largest = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i)
    largest = std::max(largest, std::abs(signal.value(time_s[i]) - value[i]));
  return largest;
}

}  // namespace

TEST_CASE("thinned line: a slow sine takes as few pieces as its curvature allows", "[calib]") {
  const auto time_s = milliseconds(10001);
  std::vector<double> value;
  for (const double t : time_s) value.push_back(3.0 * std::sin(2.0 * std::numbers::pi * 0.1 * t));
  const model::Signal line = thinned_line(time_s, value);
  CHECK(largest_error(line, time_s, value) <= kThinnedError * 6.0 * (1.0 + 1e-9));
  // Where the sine is curved most, a chord of length h is off by w^2 h^2 / 8 of the amplitude, and
  // a period takes 2 pi / sqrt(8 * 2 * kThinnedError) = 157 chords.
  CHECK(pieces_of(line, time_s.back()) < 157);
  CHECK(pieces_of(line, time_s.back()) > 50);
}

TEST_CASE("thinned line: edges stay where they are", "[calib]") {
  const auto time_s = milliseconds(1000);
  std::vector<double> value;
  for (std::size_t i = 0; i < time_s.size(); ++i) value.push_back(i / 250 % 2 == 0 ? 0.5 : -0.5);
  const model::Signal line = thinned_line(time_s, value);
  CHECK(largest_error(line, time_s, value) <= kThinnedError);
  CHECK(pieces_of(line, time_s.back()) == 7);  // four levels and three edges
}

TEST_CASE("thinned line: noise and short records keep their samples", "[calib]") {
  const auto time_s = milliseconds(50);
  std::vector<double> value;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    value.push_back(std::sin(static_cast<double>(i * i)));
  const model::Signal line = thinned_line(time_s, value);
  CHECK(pieces_of(line, time_s.back()) == 49);
  CHECK(largest_error(line, time_s, value) < 1e-12);
  CHECK(thinned_line(std::vector{0.0}, std::vector{2.0}).value(1.0) == 2.0);
  CHECK(thinned_line(std::vector{0.0, 1.0}, std::vector{2.0, 4.0}).value(0.5) == 3.0);
}

TEST_CASE("repeating line: a play repeats from its first reversal, and spares periods", "[calib]") {
  model::Experiment experiment;
  experiment.set("kd", 0.394).set("derivative_filter", 100.0);
  experiment.times_s = model::grid(0.0, 5.0, 5001);
  experiment.outputs = {model::Output::position};
  const auto& time_s = experiment.times_s;
  std::vector<double> value;
  for (const double t : time_s)
    value.push_back(std::exp(-5.0 * t) + std::sin(2.0 * std::numbers::pi * t));
  const std::vector<model::SampledPeriod> periods{{0.5, 500, true}, {1.0, 1000, false}};
  const model::Signal line = repeating_line(time_s, value, periods, Reverses::yes);
  REQUIRE(line.repetition());
  CHECK(line.repetition()->reversed);
  // The decay is within kThinnedError of the range after 1.7 s.
  CHECK(line.repetition()->from_s > 1.0);
  CHECK(line.repetition()->from_s < 2.0);
  CHECK(largest_error(line, time_s, value) < 3.0 * kThinnedError * 2.5);
  const double from_s = line.repetition()->from_s;
  for (const double t : {from_s + 0.01, from_s + 0.2, from_s + 0.4, from_s + 1.3})
    CHECK(std::abs(line.value(t + 0.5) + line.value(t)) < 1e-9);
  // A signal that does not reverse has only the whole period.
  const model::Signal even = repeating_line(time_s, value, periods, Reverses::no);
  REQUIRE(even.repetition());
  CHECK(even.repetition()->period_s == 1.0);
  // A sweep has none.
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::sin(2.0 * time_s[i] * time_s[i]);
  CHECK_FALSE(repeating_line(time_s, value, periods, Reverses::yes).repetition());

  experiment.inputs.drive = model::Signal::sine(0.02, 1.0);
  const auto command = [&](const model::Signal& error, bool steady) {
    model::Experiment with = experiment;
    with.inputs.spool_error = error;
    with.options.periodic_steady_state = steady;
    return with();
  };
  for (std::size_t i = 0; i < value.size(); ++i)
    value[i] = 0.05 * std::cos(2.0 * std::numbers::pi * time_s[i]);
  const model::Signal error = repeating_line(time_s, value, periods, Reverses::yes);
  const model::Simulation spared = command(error, true);
  const model::Simulation whole = command(error, false);
  REQUIRE(spared.ok());
  REQUIRE(whole.ok());
  CHECK(spared.steps < whole.steps);
  CHECK(model::difference(spared.outputs, whole.outputs) < 1e-4);
}

}  // namespace rigcal::calib
