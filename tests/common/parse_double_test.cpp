#include "common/parse_double.hpp"

#include <fmt/format.h>

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include "tests/support/sanitized.hpp"

using rigcal::parse_double;

namespace {

constexpr int kDraws = rigcal::test::kSanitized ? 20'000 : 500'000;

/// Whether both functions read the same bits from the text, stop at the same place, and report the
/// same error.
bool same_as_standard(const std::string& text) {
  double expected = -7.0;  // the value is unchanged if nothing is read
  double value = -7.0;
  const char* const end = text.data() + text.size();
  const auto [standard_rest, standard_error] = std::from_chars(text.data(), end, expected);
  const auto [rest, error] = parse_double(text.data(), end, value);
  return rest == standard_rest && error == standard_error &&
         std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(expected);
}

/// Returns the exact decimal text of the number half way between a double and the next one.
std::string half_way_above(double x) {
  const double next = std::nextafter(x, std::numeric_limits<double>::infinity());
  const long double middle = 0.5L * (static_cast<long double>(x) + static_cast<long double>(next));
  return fmt::format("{:.25f}", middle);
}

}  // namespace

TEST_CASE("parse_double: what loggers write, and what they should not", "[common]") {
  for (const char* text :
       {"0",
        "-0",
        "1",
        "-1",
        "0.001",
        "-12.75",
        "007.50",
        "1.",
        ".5",
        "-.5",
        "-",
        "",
        ".",
        "+1",
        " 1",
        "1 ",
        "1,5",
        "1.5,2",
        "1.5x",
        "1..5",
        "0x10",
        "1e5",
        "1.5E-3",
        "1e",
        "1.5e+",
        "inf",
        "-nan",
        "1e400",
        "1e-400",
        "9007199254740991",
        "9007199254740992",
        "9007199254740993",
        "9007199254740992.0",
        "900719925474.0993",
        "1234567890123456789",
        "9999999999999999999",
        "18446744073709551615",
        "18446744073709551616",
        "0.1234567890123456789",
        "0.12345678901234567890",
        "0.000000000000000001",
        "0.0000000000000000001",
        "100000000000000000000000000000000000000",
        "0.30000000000000004",
        "179769313486231580793728971405303415079934132710037826936173778980444"}) {
    CAPTURE(text);
    CHECK(same_as_standard(text));
  }
}

TEST_CASE("parse_double: decimal numbers of any length, as std::from_chars", "[common]") {
  std::mt19937_64 engine(20);
  const auto up_to = [&](int most) { return std::uniform_int_distribution<int>(0, most)(engine); };
  int wrong = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    std::string text(static_cast<std::size_t>(up_to(1)), '-');
    for (int k = up_to(11); k >= 0; --k) text += static_cast<char>('0' + up_to(9));
    if (up_to(7) > 0) text += '.';
    for (int k = up_to(12); k > 0; --k) text += static_cast<char>('0' + up_to(9));
    if (up_to(15) == 0) text += fmt::format("e{}", up_to(60) - 30);
    if (!same_as_standard(text) && ++wrong == 1) FAIL(text);
  }
  CHECK(wrong == 0);
}

TEST_CASE("parse_double: shortest texts of doubles read back to the same bits", "[common]") {
  std::mt19937_64 engine(21);
  std::uniform_real_distribution<double> exponent(-12.0, 12.0);
  for (int draw = 0; draw < kDraws; ++draw) {
    const double x = std::pow(10.0, exponent(engine)) * (draw % 2 == 0 ? 1.0 : -1.0);
    double back = 0.0;
    const std::string text = fmt::format("{}", x);
    parse_double(text.data(), text.data() + text.size(), back);
    if (std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(back)) FAIL(text);
  }
}

TEST_CASE("parse_double: half way between two doubles", "[common]") {
  std::mt19937_64 engine(22);
  std::uniform_real_distribution<double> size(1.0, 1e6);
  for (int draw = 0; draw < kDraws / 10; ++draw) {
    std::string text = half_way_above(size(engine));
    CAPTURE(text);
    REQUIRE(same_as_standard(text));
    text.back() = '1';  // slightly above
    REQUIRE(same_as_standard(text));
    REQUIRE(same_as_standard(text.substr(0, 19)));
    REQUIRE(same_as_standard(text.substr(0, 17)));
  }
}
