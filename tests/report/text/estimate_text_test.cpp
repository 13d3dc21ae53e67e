#include "report/text/estimate_text.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

using namespace rigcal::report;
using rigcal::Range;

namespace {

/// Returns the text with an exponent instead of a power of ten.
std::string with_exponent(std::string text) {
  const std::vector<std::pair<std::string, std::string>> written{
      {"×10", "e"}, {"⁻", "-"}, {"⁰", "0"}, {"¹", "1"}, {"²", "2"}, {"³", "3"},
      {"⁴", "4"},   {"⁵", "5"}, {"⁶", "6"}, {"⁷", "7"}, {"⁸", "8"}, {"⁹", "9"}};
  for (const auto& [from, to] : written)
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;)
      text.replace(at, from.size(), to);
  return text;
}

double number_of(const std::string& text) { return std::stod(with_exponent(text)); }

/// Returns the place value of the last digit in a text; for a whole number, of its last non-zero
/// digit.
double step_of(const std::string& printed) {
  const std::string text = with_exponent(printed);
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
  const std::string plain = with_exponent(text);
  const std::string digits = plain.substr(0, plain.find('e'));
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
  CHECK(matched(3.8e-13, 1.2e-13) == "3.8×10⁻¹³");
  CHECK(matched(-3.84e-13, 1.2e-14) == "-3.84×10⁻¹³");
  CHECK(matched(0.00123456, 1e-5) == "0.001235");
  CHECK(matched(0.00079, 0.00079) == "0.00079");
  CHECK(matched(2.5e6, 1e5) == "2.50×10⁶");
  CHECK(matched(0.0, 1.0) == "0");
  CHECK(matched(-0.0, 1.0) == "0");
  CHECK(matched(1.0 / 3.0, 0.0) == "0.333333");
  CHECK(matched(std::nan(""), 1.0) == "-");
}

TEST_CASE("uncertainty_text: the decimals of the value, not a power of ten", "[report]") {
  CHECK(uncertainty_text(0.0000791, 0.57123) == "0.000079");
  CHECK(uncertainty_text(0.00002, 0.998) == "0.000020");
  CHECK(uncertainty_text(0.051, 85.0114) == "0.051");
  CHECK(uncertainty_text(22.3, 1234.0) == "22");
  CHECK(uncertainty_text(1.2e-13, 3.8e-13) == "1.2×10⁻¹³");
  CHECK(uncertainty_text(1e-9, 0.5) == "1.0×10⁻⁹");  // the value has no such decimals
  CHECK(uncertainty_text(1e-5, 0.0) == "1.0×10⁻⁵");
  CHECK(uncertainty_text(std::nan(""), 1.0) == "-");
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
    REQUIRE(with_exponent(text).size() <= 13);
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
