#include "model/solver/sensors.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>

#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

constexpr double kLag_s = 0.01;

/// Reading of a position x(t) by a sensor with the lag kLag_s.
template <typename F>
Eigen::VectorXd lagged(const std::vector<double>& samples_s, F x) {
  auto values = paper_rig();
  values.set("position_lag", kLag_s);
  const std::vector outputs{Output::position};
  const SensorTimes at = *sensor_times(outputs, values, {}, samples_s);
  Simulation run;
  run.outputs.resize(static_cast<Eigen::Index>(at.times_s.size()), 1);
  for (std::size_t i = 0; i < at.times_s.size(); ++i) {
    run.outputs(static_cast<Eigen::Index>(i), 0) = x(at.times_s[i]);
  }
  run.sensitivities.assign(1, Eigen::MatrixXd(run.outputs.rows(), 0));
  read_sensors(at, outputs, values, {}, run);
  return run.outputs.col(0);
}

}  // namespace

TEST_CASE("sensors: a lag follows a ramp one time constant late", "[model]") {
  const auto times = grid(0.0, 0.2, 21);
  const auto y = lagged(times, [](double t) { return 3.0 * t; });
  REQUIRE(y.size() == 21);
  for (Eigen::Index i = 0; i < y.size(); ++i) {
    const double t = times[static_cast<std::size_t>(i)];
    // Linear interpolation is exact for a ramp.
    CHECK_THAT(y(i), WithinAbs(3.0 * (t - kLag_s * (1.0 - std::exp(-t / kLag_s))), 1e-12));
  }
}

TEST_CASE("sensors: a lag weakens and delays a sine, however sparse the samples", "[model]") {
  const double omega = 100.0;
  for (const int samples : {201, 41}) {
    const auto times = grid(0.0, 1.0, samples);
    const auto y = lagged(times, [&](double t) { return std::sin(omega * t); });
    const double gain = 1.0 / std::sqrt(1.0 + std::pow(omega * kLag_s, 2));
    const double phase = std::atan(omega * kLag_s);
    for (Eigen::Index i = y.size() / 2; i < y.size(); ++i) {
      const double t = times[static_cast<std::size_t>(i)];
      CHECK_THAT(y(i), WithinAbs(gain * std::sin(omega * t - phase), 2e-3));
    }
  }
}

TEST_CASE("sensors: gain and offset make the reading, and the start is read back", "[model]") {
  Experiment e = two_chamber_rig();
  e.rig.initial = InitialState::given;
  e.outputs = {Output::position, Output::pressure_a, Output::velocity};
  e.set("initial_position", 0.021).set("initial_pressure_a", 3e6);
  const Simulation plain = e();
  e.set("position_gain", 1.1).set("position_offset", -0.001).set("pressure_a_gain", 0.9);
  e.set("initial_position", 0.021 * 1.1 - 0.001).set("initial_pressure_a", 2.7e6);
  const Simulation read = e();
  REQUIRE(plain.ok());
  REQUIRE(read.ok());
  // The loop sees the true position, so nothing changes except rounding.
  CHECK(peak(read.outputs.col(0) - (1.1 * plain.outputs.col(0).array() - 0.001).matrix()) < 1e-9);
  CHECK(peak(read.outputs.col(1) - 0.9 * plain.outputs.col(1)) < 1e-6 * peak(plain.outputs.col(1)));
  CHECK_THAT(read.outputs(0, 0), WithinRel(0.021 * 1.1 - 0.001, 1e-12));
}

TEST_CASE("sensors: more times than the samples are needed with a lag only", "[model]") {
  const auto times = grid(0.0, 1.0, 11);
  const std::vector outputs{Output::position, Output::velocity};
  CHECK_FALSE(sensor_times(outputs, paper_rig(), {}, times));
  auto values = paper_rig();
  values.set("position_lag", 1e6);
  const auto at = sensor_times(outputs, values, {}, times);
  REQUIRE(at);
  CHECK(at->times_s == times);
  CHECK(at->sample.back() == 10);
}

TEST_CASE("sensors: at its limit a reading depends on nothing", "[model]") {
  Experiment e = two_chamber_rig();
  e.outputs = {Output::position, Output::pressure_a};
  e.free = {parameter_index(PlantKind::two_chamber, "mass"),
            parameter_index(PlantKind::two_chamber, "position_gain")};
  e.set("position_gain", 1.0);
  const Simulation free = e();
  REQUIRE(free.ok());
  const double limit = 0.5 * free.outputs.col(0).maxCoeff();
  e.set("position_maximum", limit);
  const Simulation limited = e();
  REQUIRE(limited.ok());
  int reached = 0;
  for (Eigen::Index i = 0; i < free.outputs.rows(); ++i) {
    const bool beyond = free.outputs(i, 0) > limit;
    reached += beyond ? 1 : 0;
    CHECK(limited.outputs(i, 0) == (beyond ? limit : free.outputs(i, 0)));
    CHECK(limited.sensitivities[0].row(i).isZero() == (beyond || i == 0));
  }
  CHECK(reached > 0);
  CHECK(reached < free.outputs.rows());
  CHECK(limited.outputs.col(1) == free.outputs.col(1));  // the loop sees the true position
}

TEST_CASE("sensors: the shortest lag is followed by eight times and more", "[model]") {
  auto values = paper_rig();
  values.set("position_lag", 0.1);
  values.set("load_pressure_lag", 0.0021);
  const std::vector outputs{Output::position, Output::load_pressure};
  const auto at = sensor_times(outputs, values, {}, grid(0.0, 0.1, 11));
  REQUIRE(at);
  // There are 10 ms between samples: 8 * 10 / 2.1 = 38.1 pieces per interval.
  CHECK(at->times_s.size() == 10 * 39 + 1);
}

TEST_CASE("sensors: a free lag of zero reads the quantity, and its slope is the sensitivity",
          "[model]") {
  const double omega = 100.0;
  auto values = paper_rig();
  values.set("position_lag", 0.0);
  const std::vector outputs{Output::position};
  const std::vector<int> free{parameter_index(values.plant, "position_lag")};
  const auto samples_s = grid(0.0, 0.2, 21);
  CHECK_FALSE(sensor_times(outputs, values, {}, samples_s));
  const auto at = sensor_times(outputs, values, free, samples_s);
  REQUIRE(at);
  Simulation run;
  run.outputs.resize(static_cast<Eigen::Index>(at->times_s.size()), 1);
  for (Eigen::Index i = 0; i < run.outputs.rows(); ++i)
    run.outputs(i, 0) = std::sin(omega * at->times_s[static_cast<std::size_t>(i)]);
  run.sensitivities.assign(1, Eigen::MatrixXd::Zero(run.outputs.rows(), 1));
  read_sensors(at, outputs, values, free, run);
  REQUIRE(run.outputs.rows() == 21);
  for (Eigen::Index i = 1; i < 21; ++i) {
    const double t = samples_s[static_cast<std::size_t>(i)];
    CHECK(run.outputs(i, 0) == std::sin(omega * t));
    // The slope is that over the last half microsecond: 1e4 / 2 times that.
    CHECK_THAT(run.sensitivities[0](i, 0), WithinAbs(-omega * std::cos(omega * t), 5e-3));
  }
}

TEST_CASE("sensors: a lag of a fraction of the sampling interval is as good as any", "[model]") {
  const double omega = 100.0;
  const auto samples_s = grid(0.0, 0.2, 21);
  const std::vector outputs{Output::position, Output::load_pressure};
  for (const auto& [position_s, pressure_s] :
       {std::pair{1e-5, 2e-4}, std::pair{2e-4, 1e-5}, std::pair{1e-6, 5e-3}}) {
    auto values = paper_rig();
    values.set("position_lag", position_s);
    values.set("load_pressure_lag", pressure_s);
    const auto at = sensor_times(outputs, values, {}, samples_s);
    REQUIRE(at);
    CHECK(std::is_sorted(at->times_s.begin(), at->times_s.end(), std::less_equal<>()));
    Simulation run;
    run.outputs.resize(static_cast<Eigen::Index>(at->times_s.size()), 2);
    for (Eigen::Index i = 0; i < run.outputs.rows(); ++i)
      run.outputs.row(i).setConstant(std::sin(omega * at->times_s[static_cast<std::size_t>(i)]));
    run.sensitivities.assign(2, Eigen::MatrixXd(run.outputs.rows(), 0));
    read_sensors(at, outputs, values, {}, run);
    for (Eigen::Index k = 0; k < 2; ++k) {
      const double lag_s = k == 0 ? position_s : pressure_s;
      const double gain = 1.0 / std::sqrt(1.0 + std::pow(omega * lag_s, 2));
      for (Eigen::Index i = 11; i < 21; ++i) {
        const double t = samples_s[static_cast<std::size_t>(i)];
        const double expected = gain * std::sin(omega * t - std::atan(omega * lag_s));
        CAPTURE(lag_s, t);
        CHECK_THAT(run.outputs(i, k), WithinAbs(expected, 8e-3 * omega * lag_s));
      }
    }
  }
}
