#include "calib/design/drive_shape.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

namespace rigcal::calib {
namespace {

using datasets::DriveFamily;

Eigen::VectorXd point_of(DriveFamily family, double value) {
  return Eigen::VectorXd::Constant(drive_coordinates(family), value);
}

}  // namespace

TEST_CASE("drive shapes: within their range, from the beginning back to it", "[calib]") {
  const DriveGrid grid{1001, 100.0, 0.2, 10.0};
  for (const DriveFamily family : enumerators_like(DriveFamily{})) {
    for (const double value : {0.0, 0.3, 0.5, 0.77, 1.0}) {
      CAPTURE(datasets::to_string(family), value);
      const DriveShape shape = drive_shape(family, point_of(family, value), grid);
      REQUIRE(shape.values.size() == 1001);
      CHECK(shape.values.front() == 0.0);
      CHECK(std::abs(shape.values.back()) < 1e-12);
      for (const double each : shape.values) REQUIRE(std::abs(each) <= 1.0 + 1e-12);
      CHECK(shape.share >= 0.1 - 1e-12);
      CHECK(shape.share <= 1.0 + 1e-12);
      CHECK_FALSE(shape.parts.empty());
    }
  }
}

TEST_CASE("drive shapes: each coordinate changes the drive", "[calib]") {
  const DriveGrid grid{1001, 100.0, 0.2, 10.0};
  for (const DriveFamily family : enumerators_like(DriveFamily{})) {
    const DriveShape middle = drive_shape(family, point_of(family, 0.4), grid);
    for (Eigen::Index j = 0; j < drive_coordinates(family); ++j) {
      CAPTURE(datasets::to_string(family), j);
      Eigen::VectorXd point = point_of(family, 0.4);
      point(j) = 0.55;
      const DriveShape moved = drive_shape(family, point, grid);
      CHECK((moved.values != middle.values || moved.share != middle.share));
    }
  }
}

TEST_CASE("drive shapes: a chirp of one frequency is a sine", "[calib]") {
  const DriveGrid grid{2001, 200.0, 1.0, 4.0};
  Eigen::VectorXd point = point_of(DriveFamily::chirp, 0.5);  // 2 Hz at each end, no offset
  const DriveShape shape = drive_shape(DriveFamily::chirp, point, grid);
  double peak = 0.0;
  for (std::size_t i = 0; i < 2001; ++i)
    peak =
        std::max(peak, std::abs(std::sin(4.0 * std::acos(-1.0) * static_cast<double>(i) / 200.0)));
  for (std::size_t i = 200; i < 1800; ++i) {
    const double t = static_cast<double>(i) / 200.0;
    REQUIRE(shape.values[i] == Approx(std::sin(4.0 * std::acos(-1.0) * t) / peak).margin(1e-9));
  }
}

TEST_CASE("drive shapes: a chirp passes each octave in the same time", "[calib]") {
  const DriveGrid grid{8001, 800.0, 1.0, 4.0};
  Eigen::VectorXd point = point_of(DriveFamily::chirp, 0.5);
  point(2) = 0.0;  // 1 Hz at the beginning
  point(3) = 1.0;  // 4 Hz at the end
  const DriveShape shape = drive_shape(DriveFamily::chirp, point, grid);
  const auto reversals_until = [&](std::size_t end) {
    int count = 0;
    for (std::size_t i = 2; i < end; ++i) count += shape.values[i] * shape.values[i - 1] < 0.0;
    return count;
  };
  // In ten seconds the phase grows by 10 (4 - 1) / ln 4 turns, a third of them in the first half.
  const double turns = 30.0 / std::log(4.0);
  CHECK(std::abs(reversals_until(8000) - 2.0 * turns) <= 1.0);
  CHECK(std::abs(reversals_until(4000) - 2.0 * turns / 3.0) <= 1.0);
}

TEST_CASE("drive shapes: a pseudo-random sequence repeats itself after 2047 bits only", "[calib]") {
  // A bit has two samples and a rise has one, so every second sample is at full level.
  const DriveGrid grid{2 * 4096 + 1, 2.0, 0.1, 0.5};
  Eigen::VectorXd point = point_of(DriveFamily::prbs, 0.5);
  point(2) = 0.0;  // the shortest bit: 1 s
  point(3) = 0.0;  // the shortest rise: 0.5 s
  point(4) = 0.0;
  const DriveShape shape = drive_shape(DriveFamily::prbs, point, grid);
  std::vector<int> bits;
  for (std::size_t i = 1; i < shape.values.size(); i += 2)
    bits.push_back(shape.values[i] > 0.0 ? 1 : 0);
  // Every 11-bit word except the one with eleven equal bits occurs once in a period.
  std::set<int> words;
  for (std::size_t i = 0; i < 2047; ++i) {
    int word = 0;
    for (std::size_t k = 0; k < 11; ++k) word = 2 * word + bits[i + k];
    words.insert(word);
  }
  CHECK(words.size() == 2047);
  CHECK(std::equal(bits.begin(), bits.begin() + 2000, bits.begin() + 2047));
}

TEST_CASE("drive grid: the default band, and a stated one", "[calib]") {
  datasets::DesignSettings settings;
  settings.duration_s = 10.0;
  settings.sample_rate_hz = 100.0;
  const DriveGrid usual = drive_grid(settings);
  CHECK(usual.samples == 1001);
  CHECK(usual.lowest_hz == Approx(0.2));
  CHECK(usual.highest_hz == Approx(10.0));
  settings.band_hz = {1.0, 3.0};
  CHECK(drive_grid(settings).lowest_hz == 1.0);
  CHECK(drive_grid(settings).highest_hz == 3.0);
}

}  // namespace rigcal::calib
