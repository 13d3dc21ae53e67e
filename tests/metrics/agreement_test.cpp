#include "metrics/agreement.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "metrics/metric_table.hpp"

using namespace rigcal::metrics;
using Catch::Contains;
using Catch::WithinRel;

namespace {

using Values = std::vector<double>;

// The metrics promise a relative error of 1e-12 wherever the value is well conditioned.
constexpr double kRelative = 1e-12;

// Uses 113 bits and the textbook formulas, which have nothing in common with the code under test.
__extension__ using Quad = __float128;

Quad quad_sqrt(Quad x) {
  if (x == Quad{0}) return x;
  Quad root = static_cast<Quad>(std::sqrt(static_cast<long double>(x)));
  for (int i = 0; i < 3; ++i) root = (root + x / root) / Quad{2};
  return root;
}

std::map<std::string, double> quad_metrics(const Values& measured, const Values& simulated) {
  const auto n = static_cast<Quad>(measured.size());
  Quad mean_y = 0, mean_s = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    mean_y += static_cast<Quad>(measured[i]) / n;
    mean_s += static_cast<Quad>(simulated[i]) / n;
  }
  Quad yy = 0, ss = 0, ys = 0, ee = 0, square = 0, absolute = 0, largest = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const Quad y = static_cast<Quad>(measured[i]) - mean_y;
    const Quad s = static_cast<Quad>(simulated[i]) - mean_s;
    const Quad e = static_cast<Quad>(measured[i]) - static_cast<Quad>(simulated[i]);
    const Quad size = e < 0 ? -e : e;
    yy += y * y, ss += s * s, ys += y * s, ee += (y - s) * (y - s);
    square += e * e, absolute += size;
    if (size > largest) largest = size;
  }
  const auto [low, high] = std::minmax_element(measured.begin(), measured.end());
  const Quad d = mean_y - mean_s;
  const Quad range = static_cast<Quad>(*high) - static_cast<Quad>(*low);
  const std::map<std::string, Quad> exact{
      {"rho2", 1 - ee / yy},
      {"r", ys / quad_sqrt(yy * ss)},
      {"ccc", (ss + yy - ee) / (ss + yy + n * d * d)},  // eq. 17 as printed
      {"absolute_error_percent", 100 * absolute / n / range},
      {"rmse", quad_sqrt(square / n)},
      {"nrmse_fit_percent", 100 * (1 - quad_sqrt(square / yy))},
      {"maximum_error", largest}};
  std::map<std::string, double> result;
  for (const auto& [name, value] : exact) result[name] = static_cast<double>(value);
  return result;
}

void check_against(const std::map<std::string, double>& expected, const Values& measured,
                   const Values& simulated) {
  const Agreement all = agreement(measured, simulated);
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    CHECK_THAT(all.*metric.value, WithinRel(expected.at(std::string(metric.name)), kRelative));
  }
}

Values normal_values(std::size_t n, double mean, double sd, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> draw(mean, sd);
  Values values(n);
  for (double& value : values) value = draw(generator);
  return values;
}

Values sum(const Values& a, const Values& b) {
  Values result = a;
  for (std::size_t i = 0; i < a.size(); ++i) result[i] += b[i];
  return result;
}

const Values kMeasured{1.0, 2.0, 3.0, 4.0, 5.0};
const Values kSimulated{1.1, 1.9, 3.3, 4.2, 4.4};

}  // namespace

TEST_CASE("agreement: golden vectors in exact arithmetic", "[metrics]") {
  std::ifstream file(RIGCAL_SOURCE_DIR "/tests/golden/metrics.txt");
  std::string comment, word, name;
  std::getline(file, comment);
  int cases = 0;
  std::size_t n = 0;
  while (file >> word >> name >> n) {
    REQUIRE(word == "case");
    CAPTURE(name);
    Values measured(n), simulated(n);
    file >> word;
    for (double& value : measured) file >> value;
    file >> word;
    for (double& value : simulated) file >> value;
    std::map<std::string, double> expected;
    for (std::size_t i = 0; i < kMetrics.size() + 1; ++i) {
      file >> word;
      file >> expected[word];
    }
    REQUIRE(file);
    check_against(expected, measured, simulated);
    CHECK_THAT(unexplained_variance(measured, simulated),
               WithinRel(expected.at("unexplained_variance"), kRelative));
    ++cases;
  }
  CHECK(cases == 15);
}

TEST_CASE("agreement: random vectors as in 113-bit arithmetic", "[metrics]") {
  const double offset = GENERATE(0.0, -3.0, 1e9);
  const double scale = GENERATE(1.0, 1e-6, 1e5);
  const double noise = GENERATE(1.0, 0.1, 1e-3);
  const std::size_t n = GENERATE(2, 3, 10, 1023, 1025, 20000);
  CAPTURE(offset, scale, noise, n);
  const Values measured = normal_values(n, offset, scale, n);
  const Values simulated = sum(measured, normal_values(n, 0.0, noise * scale, n + 1));
  check_against(quad_metrics(measured, simulated), measured, simulated);
}

TEST_CASE("agreement: tiny and huge scales lose nothing", "[metrics]") {
  const double scale = GENERATE(1e-300, 1e-150, 1e-100, 1e100, 1e150, 1e300);
  CAPTURE(scale);
  const Values measured = normal_values(500, 0.0, scale, 1);
  const Values simulated = sum(measured, normal_values(500, 0.0, 0.1 * scale, 2));
  check_against(quad_metrics(measured, simulated), measured, simulated);
}

// Integer samples, in a unit that is a power of two, have exact sums in 128 bits.
TEST_CASE("agreement: 1e7 samples on an offset of 1e9 as in integer arithmetic", "[metrics]") {
  __extension__ using Integer = __int128;
  constexpr std::size_t kCount = 10'000'000;
  constexpr double kUnit = 0x1p-20;
  constexpr std::int64_t kOffset = 1'000'000'000LL << 20;
  std::mt19937_64 generator(7);
  Values measured(kCount), simulated(kCount);
  Integer y = 0, s = 0, yy = 0, ss = 0, ys = 0, square = 0, absolute = 0;
  std::int64_t low = std::numeric_limits<std::int64_t>::max(), high = 0, largest = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const auto a = static_cast<std::int64_t>(generator() % 4'000'000);
    const auto b = a + static_cast<std::int64_t>(generator() % 4'001);
    measured[i] = static_cast<double>(kOffset + a) * kUnit;
    simulated[i] = static_cast<double>(kOffset + b) * kUnit;
    y += a, s += b;
    yy += Integer{a} * a, ss += Integer{b} * b, ys += Integer{a} * b;
    square += Integer{b - a} * (b - a), absolute += b - a;
    low = std::min(low, a), high = std::max(high, a), largest = std::max(largest, b - a);
  }
  // n^2 times the moments, in squared units, is below 1e7 * 1e7 * 2e13 = 2e27, hence exact.
  const Integer n = kCount;
  const auto real = [](Integer value) { return static_cast<long double>(value); };
  const Integer var_y = n * yy - y * y, var_s = n * ss - s * s, cov = n * ys - y * s;
  const Integer var_e = var_y + var_s - 2 * cov;
  const std::map<std::string, long double> exact{
      {"rho2", real(var_y - var_e) / real(var_y)},
      {"r", real(cov) / std::sqrt(real(var_y)) / std::sqrt(real(var_s))},
      {"ccc", real(2 * cov) / real(var_y + var_s + (y - s) * (y - s))},
      {"absolute_error_percent", 100.0L * real(absolute) / real(n * (high - low))},
      {"rmse", static_cast<long double>(kUnit) * std::sqrt(real(square) / real(n))},
      {"nrmse_fit_percent", 100.0L * (1.0L - std::sqrt(real(n * square) / real(var_y)))},
      {"maximum_error", static_cast<long double>(kUnit) * real(largest)}};
  std::map<std::string, double> expected;
  for (const auto& [name, value] : exact) expected[name] = static_cast<double>(value);
  check_against(expected, measured, simulated);
  CHECK_THAT(unexplained_variance(measured, simulated),
             WithinRel(static_cast<double>(real(var_e) / real(var_y)), kRelative));
}

TEST_CASE("rho2: its distance from 1 keeps all digits", "[metrics]") {
  // Residuals of 1e-6 and 1e-9 of the signal. Computing 1 - rho2 would resolve 1e-12 only to 1e-4,
  // and 1e-18 not at all.
  const double noise = GENERATE(1e-6, 1e-9);
  const double offset = GENERATE(0.0, 1e3);
  const Values measured = normal_values(1000, offset, 1.0, 3);
  const Values simulated = sum(measured, normal_values(1000, 0.0, noise, 4));
  Quad mean_e = 0, mean_y = 0, ee = 0, yy = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    mean_y += static_cast<Quad>(measured[i]) / 1000;
    mean_e += (static_cast<Quad>(measured[i]) - static_cast<Quad>(simulated[i])) / 1000;
  }
  for (std::size_t i = 0; i < 1000; ++i) {
    const Quad y = static_cast<Quad>(measured[i]) - mean_y;
    const Quad e = static_cast<Quad>(measured[i]) - static_cast<Quad>(simulated[i]) - mean_e;
    yy += y * y, ee += e * e;
  }
  const auto expected = static_cast<double>(ee / yy);
  CHECK_THAT(unexplained_variance(measured, simulated), WithinRel(expected, kRelative));
  CHECK(rho2(measured, simulated) == static_cast<double>(1 - ee / yy));
}

TEST_CASE("agreement: equals the single functions bit for bit", "[metrics]") {
  const std::uint64_t seed = GENERATE(range(1, 20));
  const Values measured = normal_values(100 + seed, 2.0, 1.0, seed);
  const Values simulated = sum(measured, normal_values(100 + seed, 0.1, 0.3, seed + 100));
  const Agreement all = agreement(measured, simulated);
  for (const MetricSpec& metric : kMetrics) {
    CAPTURE(metric.name);
    CHECK(all.*metric.value == metric.compute(measured, simulated));
  }
}

TEST_CASE("agreement: of a signal with itself is perfect, exactly", "[metrics]") {
  const auto [offset, sd] =
      GENERATE(table<double, double>({{0.0, 1.0}, {0.0, 1e-150}, {1e9, 1.0}, {1e9, 1e-3}}));
  const Values signal = normal_values(997, offset, sd, 5);
  const Agreement all = agreement(signal, signal);
  CHECK(all.rho2 == 1.0);
  CHECK(all.r == 1.0);
  CHECK(all.ccc == 1.0);
  CHECK(all.absolute_error_percent == 0.0);
  CHECK(all.rmse == 0.0);
  CHECK(all.nrmse_fit_percent == 100.0);
  CHECK(all.maximum_error == 0.0);
}

TEST_CASE("concordance: eq. 17 as printed equals Lin's form", "[metrics]") {
  const auto mean = [](const Values& v) {
    double total = 0.0;
    for (const double x : v) total += x;
    return total / static_cast<double>(v.size());
  };
  const auto var = [&](Values v) {
    const double m = mean(v);
    for (double& x : v) x = (x - m) * (x - m);
    return mean(v);
  };
  Values e = kMeasured;
  for (std::size_t i = 0; i < e.size(); ++i) e[i] -= kSimulated[i];
  const double d = mean(kMeasured) - mean(kSimulated);
  const double printed =
      (var(kSimulated) + var(kMeasured) - var(e)) / (var(kSimulated) + var(kMeasured) + d * d);
  // For five samples of order 1, there are a few roundings of 1e-16.
  CHECK_THAT(concordance(kMeasured, kSimulated), WithinRel(printed, 1e-14));
}

TEST_CASE("agreement: what each metric is blind to", "[metrics]") {
  // Powers of two are used, so that shifting and scaling do not round.
  Values shifted = kMeasured, doubled = kMeasured;
  for (double& value : shifted) value += 0.5;
  for (double& value : doubled) value *= 2.0;
  CHECK(rho2(kMeasured, shifted) == 1.0);
  CHECK(correlation(kMeasured, shifted) == 1.0);
  // The variances are 2 and the offset is 0.5, which gives 4 / (4 + 0.25), up to a few roundings.
  CHECK_THAT(concordance(kMeasured, shifted), WithinRel(4.0 / 4.25, 1e-15));
  CHECK(correlation(kMeasured, doubled) == 1.0);
  CHECK(rho2(kMeasured, doubled) == 0.0);
  CHECK(concordance(kMeasured, doubled) < 0.5);
}

TEST_CASE("agreement: a constant simulated signal has a rho2 and a concordance, but no R",
          "[metrics]") {
  const Values flat(kMeasured.size(), GENERATE(0.1, 3.0, 1e9));
  CHECK(rho2(kMeasured, flat) == 0.0);
  CHECK(unexplained_variance(kMeasured, flat) == 1.0);
  CHECK(concordance(kMeasured, flat) == 0.0);
  CHECK(rmse(kMeasured, flat) > 0.0);
  CHECK_THROWS_WITH(correlation(kMeasured, flat),
                    Contains("correlation: the simulated signal is constant"));
  CHECK_THROWS_AS(correlation(kMeasured, flat), std::domain_error);
  CHECK_THROWS_AS(agreement(kMeasured, flat), std::domain_error);
}

TEST_CASE("agreement: a constant measured signal is refused wherever it divides", "[metrics]") {
  // The mean of these samples does not round to their value, but they are constant all the same.
  const Values flat(7, GENERATE(0.0, 0.1, 1e9 + 0.1, 1e-310));
  const Values moving = normal_values(7, 0.0, 1.0, 6);
  for (const Values& simulated : {moving, flat}) {
    for (const MetricSpec& metric : kMetrics) {
      if (metric.unit == "channel") continue;
      CAPTURE(metric.name);
      CHECK_THROWS_AS(metric.compute(flat, simulated), std::domain_error);
      CHECK_THROWS_WITH(metric.compute(flat, simulated),
                        Contains("the measured signal is constant"));
    }
    CHECK_THROWS_AS(unexplained_variance(flat, simulated), std::domain_error);
    CHECK_THROWS_AS(agreement(flat, simulated), std::domain_error);
  }
  CHECK(rmse(flat, flat) == 0.0);
  CHECK(maximum_error(flat, flat) == 0.0);
}

TEST_CASE("agreement: one differing bit is not constant", "[metrics]") {
  Values measured(1000, 1e9);
  measured[500] = std::nextafter(1e9, 2e9);
  const Values simulated(1000, 1e9);
  CHECK(rho2(measured, simulated) == 0.0);
  CHECK(rho2(measured, measured) == 1.0);
}

TEST_CASE("agreement: signals that cannot be compared are refused by name", "[metrics]") {
  const auto refuses = [](const Values& measured, const Values& simulated, const char* message) {
    for (const MetricSpec& metric : kMetrics) {
      CAPTURE(metric.name);
      CHECK_THROWS_AS(metric.compute(measured, simulated), std::invalid_argument);
      CHECK_THROWS_WITH(metric.compute(measured, simulated), Contains(message));
    }
    CHECK_THROWS_AS(agreement(measured, simulated), std::invalid_argument);
    CHECK_THROWS_AS(unexplained_variance(measured, simulated), std::invalid_argument);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  refuses({}, {}, "the measured signal has 0 samples, expected at least 2");
  refuses({1.0}, {1.0}, "the measured signal has 1 samples, expected at least 2");
  refuses({1.0, 2.0}, {1.0, 2.0, 3.0}, "the measured signal has 2 samples and the simulated one 3");
  refuses({1.0, nan, 2.0}, {1.0, 2.0, 3.0}, "measured[1] is nan, expected a finite value");
  refuses({1.0, 2.0, 3.0}, {1.0, 2.0, infinity}, "simulated[2] is inf, expected a finite value");
  refuses({1.0, 2.0, 3.0}, {-infinity, 2.0, 1.0}, "simulated[0] is -inf, expected a finite value");
}

TEST_CASE("agreement: a result beyond the doubles is refused, not infinite", "[metrics]") {
  const double largest = std::numeric_limits<double>::max();
  CHECK_THROWS_AS(rmse(Values{largest, 0.0}, Values{-largest, 0.0}), std::domain_error);
  CHECK_THROWS_AS(maximum_error(Values{largest, 0.0}, Values{-largest, 0.0}), std::domain_error);
  CHECK_THROWS_WITH(rho2(Values{1e-200, 2e-200}, Values{1e200, -1e200}),
                    Contains("rho2: the result is beyond the largest double"));
  CHECK(correlation(Values{1e-200, 2e-200}, Values{1e200, -1e200}) == -1.0);
  CHECK(rho2(Values{largest, -largest}, Values{largest, -largest}) == 1.0);
}

TEST_CASE("allowed_rms: an error of this size leaves just the limit of rho2", "[metrics]") {
  std::vector<double> measured;
  std::vector<double> simulated;
  for (int i = 0; i < 400; ++i) {
    measured.push_back(3.0 + std::sin(2.0 * std::numbers::pi * 0.01 * i));
    simulated.push_back(measured.back() + (i % 2 == 0 ? 0.125 : -0.125));
  }
  const double limit = rho2(measured, simulated);
  CHECK_THAT(allowed_rms(measured, limit), WithinRel(0.125, 1e-9));
  CHECK(allowed_rms(measured, 1.0) == 0.0);
  CHECK(allowed_rms(std::vector<double>{1.0}, 0.9) == 0.0);
}
