#include "report/text/estimate_text.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using namespace rigcal::report;
using rigcal::Range;

namespace {

double number_of(const std::string& text) { return std::stod(text); }

/// Returns the place value of the last digit in a text; for a whole number, of its last non-zero
/// digit.
double step_of(const std::string& text) {
  const std::size_t exponent = std::min(text.find('e'), text.size());
  const int power = exponent < text.size() ? std::stoi(text.substr(exponent + 1)) : 0;
  const std::string digits = text.substr(0, exponent);
  const std::size_t point = digits.find('.');
  if (point != std::string::npos)
    return std::pow(10.0, power - static_cast<double>(digits.size() - point - 1));
  return std::pow(10.0,
                  power + static_cast<double>(digits.size() - 1 - digits.find_last_not_of('0')));
}

/// Returns the number of significant digits in a text.
int significant_digits(const std::string& text) {
  const std::string digits = text.substr(0, text.find('e'));
  int count = 0;
  bool begun = false;
  for (const char c : digits) {
    if (c < '0' || c > '9') continue;
    begun = begun || c != '0';
    count += begun ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("estimate: the digits that its uncertainty supports, two of its own at least",
          "[report]") {
  CHECK(matched(85.0114, 0.051) == "85.011");
  CHECK(matched(168.2, 40.0) == "168");
  CHECK(matched(66.9, 5000.0) == "67");
  CHECK(matched(10.0, 1e9) == "10");
  CHECK(matched(3.8e-13, 1.2e-13) == "3.8e-13");
  CHECK(matched(-3.84e-13, 1.2e-14) == "-3.84e-13");
  CHECK(matched(0.00123456, 1e-5) == "0.001235");
  CHECK(matched(2.5e6, 1e5) == "2.50e+06");
  CHECK(matched(0.0, 1.0) == "0");
  CHECK(matched(-0.0, 1.0) == "0");
  CHECK(matched(1.0 / 3.0, 0.0) == "0.333333");
  CHECK(matched(std::nan(""), 1.0) == "-");
}

TEST_CASE("estimate: rounding crosses no bound", "[report]") {
  CHECK(matched(14.96, 30.0, {0.0, 14.97}) == "14.96");
  CHECK(matched(0.123456, 5.0, {0.123456, 9.0}) == "0.1235");
  CHECK(matched(0.123444, 5.0, {0.0, 0.123444}) == "0.12");
  CHECK(matched(0.123456, 5.0, {0.0, 0.123456}) == "0.12");
  CHECK(matched(0.1876543219, 5.0, {0.1876543219, 9.0}) == "0.19");
  CHECK(matched(0.1111111111, 5.0, {0.1111111111, 9.0}) == "0.1111112");
  CHECK(matched(10.04, 500.0, {10.02, 500.0}) == "10.04");
  const EstimateText text = estimate_text(10.0, Range{8.2, 9000.0}, {10.0, 500.0});
  CHECK(text.value == "10");
  CHECK(number_of(text.low) <= 10.0);
}

TEST_CASE("estimate: of any value, error and bounds the text is true", "[report]") {
  std::mt19937_64 random(20261125);  // NOLINT: a fixed seed makes runs reproducible
  std::uniform_real_distribution<double> power(-15.0, 9.0);
  std::uniform_real_distribution<double> ratio(-6.0, 6.0);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto check = [](const std::string& text, double value, const Range& allowed) {
    CAPTURE(text, value, allowed.low, allowed.high);
    constexpr double kUnitsSlack = 1e-12;
    const double read = number_of(text);
    REQUIRE(read >= allowed.low - kUnitsSlack * std::abs(allowed.low));
    REQUIRE(read <= allowed.high + kUnitsSlack * std::abs(allowed.high));
    REQUIRE(read != 0.0);
    REQUIRE(std::abs(read - value) < step_of(text));
    REQUIRE(text.size() <= 13);
    REQUIRE((significant_digits(text) >= 2));
  };
  for (int i = 0; i < 20'000; ++i) {
    const double value = std::pow(10.0, power(random)) * (unit(random) < 0.2 ? -1.0 : 1.0);
    const double error = std::abs(value) * std::pow(10.0, ratio(random));
    // Values are often at a bound, as undetermined estimates are.
    const double below = unit(random) < 0.3 ? 0.0 : std::abs(value) * std::pow(10.0, ratio(random));
    const double above = unit(random) < 0.3 ? 0.0 : std::abs(value) * std::pow(10.0, ratio(random));
    const Range bounds{value - below, value + above};
    if (bounds.high - bounds.low < 1e-5 * std::abs(value)) continue;  // narrower than in any file
    const Range ci95{value - error, value + error};
    const EstimateText text = estimate_text(value, ci95, bounds);
    check(text.value, value, {std::max(bounds.low, ci95.low), std::min(bounds.high, ci95.high)});
    check(text.low, ci95.low, {ci95.low < bounds.low ? kAnywhere.low : bounds.low, value});
    check(text.high, ci95.high, {value, ci95.high > bounds.high ? kAnywhere.high : bounds.high});
  }
}
