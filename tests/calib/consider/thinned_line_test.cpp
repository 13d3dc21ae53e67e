#include "calib/consider/thinned_line.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

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

}  // namespace rigcal::calib
