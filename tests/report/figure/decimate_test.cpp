#include "report/figure/decimate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using rigcal::report::Bars;
using rigcal::report::Buckets;
using rigcal::report::buckets;
using rigcal::report::column_bars;
using rigcal::report::Quantised;
using rigcal::report::quantised;
using rigcal::report::thinned;
using rigcal::report::thinned_times;
using rigcal::report::thinned_where;

TEST_CASE("decimate: a single peak among many samples stays", "[report]") {
  std::vector<double> values(30'000, 0.0);
  values[17'321] = 5.0;
  values[4'444] = -3.0;
  const Buckets thin = buckets(values.size(), 1000);
  const std::vector<double> drawn = thinned(values, thin);
  CHECK(drawn.size() == thin.points());
  CHECK(drawn.size() <= 1002);
  CHECK(*std::max_element(drawn.begin(), drawn.end()) == 5.0);
  CHECK(*std::min_element(drawn.begin(), drawn.end()) == -3.0);
}

TEST_CASE("thinned_where: a band stays about its mean", "[report]") {
  const std::vector<double> mean{0, 9, 1, 2, 5, 3};
  const std::vector<double> sd{1, 2, 3, 4, 5, 6};
  const auto thin = buckets(mean.size(), 4);
  REQUIRE(thin.size == 3);
  CHECK(thinned(mean, thin) == std::vector<double>{0, 9, 2, 5});
  CHECK(thinned_where(sd, mean, thin) == std::vector<double>{1, 2, 4, 5});
}

TEST_CASE("decimate: few samples stay as they are", "[report]") {
  const std::vector<double> values{1.0, 5.0, 2.0};
  const Buckets thin = buckets(values.size(), 1000);
  CHECK(thinned(values, thin) == values);
  CHECK(thinned_times(values, thin) == values);
  CHECK(buckets(0, 10).points() == 0);
}

TEST_CASE("decimate: a smooth curve stays smooth", "[report]") {
  // Drawing minimum and maximum at common times would turn a rising curve into a staircase.
  std::vector<double> time(5000);
  std::vector<double> sine(time.size());
  for (std::size_t i = 0; i < time.size(); ++i) {
    time[i] = 1e-3 * static_cast<double>(i);
    sine[i] = std::sin(time[i]);
  }
  const Buckets thin = buckets(time.size(), 200);
  const std::vector<double> x = thinned_times(time, sine, thin);
  const std::vector<double> y = thinned(sine, thin);
  REQUIRE(x.size() == y.size());
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(y[i] == std::sin(x[i]));
  CHECK(std::is_sorted(x.begin(), x.end()));
  // A bucket without finite values keeps its times.
  std::fill(sine.begin(), sine.begin() + 100, std::nan(""));
  const std::vector<double> gap = thinned_times(time, sine, thin);
  CHECK(std::all_of(gap.begin(), gap.end(), [](double t) { return std::isfinite(t); }));
  CHECK(std::is_sorted(gap.begin(), gap.end()));
}

TEST_CASE("decimate: times and values have the same shape, in order", "[report]") {
  for (const std::size_t n : {11U, 100U, 101U, 999U}) {
    std::vector<double> time(n);
    for (std::size_t i = 0; i < n; ++i) time[i] = 0.1 * static_cast<double>(i);
    const Buckets thin = buckets(n, 10);
    const std::vector<double> times = thinned_times(time, thin);
    CHECK(times.size() == thinned(time, thin).size());
    CHECK(times.size() == thin.points());
    CHECK(std::is_sorted(times.begin(), times.end()));
  }
}

TEST_CASE("decimate: what is missing stays missing", "[report]") {
  const double nan = std::nan("");
  std::vector<double> values(100, nan);
  values[70] = 2.0;
  const std::vector<double> drawn = thinned(values, buckets(values.size(), 10));
  CHECK(std::isnan(drawn.front()));
  CHECK(std::count(drawn.begin(), drawn.end(), 2.0) == 2);
}

TEST_CASE("decimate: quantised values keep 1/131068 of the range", "[report]") {
  const std::vector<double> values{-1.0, 0.123456, 3.0, std::nan("")};
  const Quantised q = quantised(values);
  CHECK(q.low == -1.0);
  CHECK_THAT(q.step, Catch::WithinRel(4.0 / 65534.0, 1e-12));
  // Little endian: 0x0000, 0x47e6 (18406 steps), 0xfffe, 0xffff
  CHECK(q.base64 == "AADmR/7///8=");
}

TEST_CASE("decimate: constant, empty and huge ranges are no special case", "[report]") {
  CHECK(quantised(std::vector<double>{2.0, 2.0}).step == 0.0);
  CHECK(quantised(std::vector<double>{2.0, 2.0}).base64 == "AAAAAA==");
  CHECK(quantised({}).base64.empty());
  const double most = std::numeric_limits<double>::max();
  CHECK(std::isfinite(quantised(std::vector<double>{-most, most}).step));
}

TEST_CASE("column_bars: one bar a column, which no line joins to the next", "[report]") {
  std::vector<double> values(1000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = i % 2 == 0 ? 1.0 : 3.0;
  values[123] = 9.0;
  std::fill(values.begin() + 500, values.begin() + 520, std::nan(""));
  const Bars bars = column_bars(values, 50);
  REQUIRE(bars.x.size() == 3 * 49);  // the column without values has no bar
  for (std::size_t i = 0; i < bars.x.size(); i += 3) {
    CHECK(bars.x[i] == bars.x[i + 1]);
    CHECK(bars.y[i] == 1.0);
    CHECK(bars.y[i + 1] == (i == 18 ? 9.0 : 3.0));
    CHECK(std::isnan(bars.y[i + 2]));
  }
  CHECK(bars.x.front() == 10.0);
  CHECK(column_bars({}, 50).x.empty());
}
