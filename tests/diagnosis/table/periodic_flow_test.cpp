#include "diagnosis/table/periodic_flow.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "diagnosis/table/period_grid.hpp"
#include "metrics/mean_absolute.hpp"
#include "tests/diagnosis/leak_rig.hpp"

using namespace rigcal;
using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Waveform;

namespace {

constexpr std::array kFlows{model::Output::servo_flow, model::Output::leakage_flow};

/// Computes the share in the last of many periods with a separate, densely sampled simulation.
double long_run_share(const test::LeakRig& rig, Waveform waveform, double frequency_hz,
                      double coefficient, int periods, int samples) {
  model::SimulationInputs in;
  in.drive = waveform == Waveform::square ? model::Signal::square(0.0508, frequency_hz)
                                          : model::Signal::sine(0.0508, frequency_hz);
  std::vector<double> times{0.0};
  for (int i = 0; i < samples; ++i)
    times.push_back((periods - 1 + (i + 0.5) / samples) / frequency_hz);
  model::SimulationOptions options;
  options.tolerance = 1e-7;
  const auto run =
      model::simulate(rig.campaign.rig, rig.leaking(coefficient), {}, in, times, kFlows, options);
  REQUIRE(run.ok());
  // Samples are at midpoints, so that none falls on a jump.
  const auto rows = static_cast<Eigen::Index>(samples);
  return run.outputs.col(1).bottomRows(rows).cwiseAbs().sum() /
         run.outputs.col(0).bottomRows(rows).cwiseAbs().sum();
}

}  // namespace

TEST_CASE("period_grid: no interval spans a jump, and a constant has its own mean", "[calib]") {
  for (const Waveform waveform : {Waveform::sine, Waveform::square}) {
    const auto grid = diagnosis::period_grid(waveform, 0.2, 8);
    CHECK(grid.pieces == (waveform == Waveform::square ? 2 : 1));
    CHECK(grid.offset_s.size() == 9 * grid.pieces);
    for (std::size_t i = 1; i < grid.offset_s.size(); ++i) {
      CHECK(grid.offset_s[i] > grid.offset_s[i - 1]);
    }
    CHECK(grid.offset_s.back() < 0.2);
    CHECK_THAT(diagnosis::mean_absolute(grid, std::vector<double>(grid.offset_s.size(), -3.0)),
               WithinRel(3.0, 1e-12));
  }
  const auto square = diagnosis::period_grid(Waveform::square, 0.2, 8);
  CHECK(square.offset_s[8] < 0.1);
  CHECK(square.offset_s[9] == 0.1);
}

TEST_CASE("periodic_flow: agrees with a long run of its own", "[calib]") {
  const test::LeakRig rig;
  struct Case {
    Waveform waveform;
    double frequency_hz;
    int periods;
    int samples;
  };
  for (const Case& c :
       {Case{Waveform::sine, 10.0, 60, 4000}, Case{Waveform::square, 10.0, 60, 8000},
        Case{Waveform::square, 1.0, 12, 40000}}) {
    CAPTURE(to_string(c.waveform), c.frequency_hz);
    const auto flow =
        diagnosis::periodic_flow(rig.drive(c.waveform, c.frequency_hz), rig.leaking(0.25), {}, {});
    REQUIRE(flow.ok());
    const double share =
        long_run_share(rig, c.waveform, c.frequency_hz, 0.25, c.periods, c.samples);
    // Transient and sampling each cause an error of 2e-4 in both flows.
    CHECK_THAT(flow.share(), WithinRel(share, 6e-4));
  }
}

TEST_CASE("periodic_flow: half the samples do not move the share", "[calib]") {
  const test::LeakRig rig;
  for (const Waveform waveform : {Waveform::sine, Waveform::square}) {
    const auto drive = rig.drive(waveform, 1.0);
    diagnosis::PeriodicOptions options;
    const auto coarse = diagnosis::periodic_flow(drive, rig.leaking(0.3), {}, options);
    options.intervals = 2 * coarse.intervals;
    const auto fine = diagnosis::periodic_flow(drive, rig.leaking(0.3), {}, options);
    REQUIRE(coarse.ok());
    REQUIRE(fine.ok());
    CHECK(fine.intervals > coarse.intervals);
    CHECK_THAT(coarse.share(), WithinRel(fine.share(), options.tolerance));
  }
}

TEST_CASE("periodic_flow: slopes are those of differences", "[calib]") {
  const test::LeakRig rig;
  const auto drive = rig.drive(Waveform::square, 1.0);
  diagnosis::PeriodicOptions options;
  options.simulation.tolerance = 1e-7;
  options.tolerance = 2e-5;
  const std::array free{model::parameter_index(rig.campaign.rig.plant, "leakage_coefficient"),
                        model::parameter_index(rig.campaign.rig.plant, "kp")};
  const auto flow = diagnosis::periodic_flow(drive, rig.leaking(0.3), free, options);
  REQUIRE(flow.ok());
  const char* const keys[] = {"leakage_coefficient", "kp"};
  for (Eigen::Index j = 0; j < 2; ++j) {
    CAPTURE(keys[j]);
    const double h = 1e-3;
    auto ahead = rig.leaking(0.3);
    auto behind = rig.leaking(0.3);
    ahead.set(keys[j], ahead[keys[j]] * (1.0 + h));
    behind.set(keys[j], behind[keys[j]] * (1.0 - h));
    const auto f = diagnosis::periodic_flow(drive, ahead, {}, options);
    const auto g = diagnosis::periodic_flow(drive, behind, {}, options);
    const double p = rig.leaking(0.3)[keys[j]];
    // The means are accurate to about 1e-5. A difference over 2e-3 is then accurate to half a
    // percent for a logarithmic derivative of about one.
    CHECK_THAT(p * flow.leak_slope(j) / flow.leak_flow_m3_per_s,
               WithinAbs(std::log(f.leak_flow_m3_per_s / g.leak_flow_m3_per_s) / (2.0 * h), 0.01));
    CHECK_THAT(
        p * flow.servo_slope(j) / flow.servo_flow_m3_per_s,
        WithinAbs(std::log(f.servo_flow_m3_per_s / g.servo_flow_m3_per_s) / (2.0 * h), 0.01));
  }
}

TEST_CASE("periodic_flow: a loop that cycles by itself is given up early", "[calib]") {
  const test::LeakRig rig;
  auto values = rig.leaking(0.0);
  values.set("mass", 60.0);
  values.set("damping", 1000.0);
  values.set("kp", 3000.0);
  values.set("ki", 0.0);
  values.set("kd", 0.0);
  auto drive = rig.drive(Waveform::sine, 2.0);
  drive.signal.amplitude = 0.0005;
  const auto flow = diagnosis::periodic_flow(drive, values, {}, {});
  CAPTURE(flow.periods, flow.failure);
  CHECK_FALSE(flow.ok());
  CHECK(flow.periods >= 256);
  CHECK(flow.periods < 1024);
}

TEST_CASE("periodic_flow: what does not become periodic is no result", "[calib]") {
  const test::LeakRig rig;
  // A constant load moves the position away over minutes: the time constant of the loop is 1000 s.
  auto values = rig.leaking(0.3);
  values.set("kp", 0.04);
  values.set("kd", 0.0);
  values.set("external_force", 500.0);
  diagnosis::PeriodicOptions options;
  options.most_periods = 64;
  const auto flow = diagnosis::periodic_flow(rig.drive(Waveform::sine, 10.0), values, {}, options);
  CHECK_FALSE(flow.ok());
  CHECK_THAT(flow.failure, Catch::Contains("not periodic after 64 periods"));
}

TEST_CASE("periodic_flow: a failed simulation says where and why", "[calib]") {
  const test::LeakRig rig;
  diagnosis::PeriodicOptions options;
  options.simulation.max_steps = 10;
  const auto flow =
      diagnosis::periodic_flow(rig.drive(Waveform::sine, 1.0), rig.leaking(0.3), {}, options);
  CHECK_FALSE(flow.ok());
  CHECK_THAT(flow.failure, Catch::Contains("too many steps at "));
}

TEST_CASE("periodic_series: the flows of its period are those of the means", "[calib]") {
  const test::LeakRig rig;
  const auto drive = rig.drive(Waveform::sine, 1.0);
  const auto flow = diagnosis::periodic_flow(drive, rig.leaking(0.5), {}, {});
  const auto series = diagnosis::periodic_series(drive, rig.leaking(0.5), {}, kFlows, flow.periods,
                                                 4000, model::SimulationOptions{.tolerance = 1e-6});
  REQUIRE(series.run.ok());
  REQUIRE(series.time_s.size() == 4000);
  CHECK(series.time_s.front() == 0.0);
  CHECK_THAT(series.run.outputs.col(0).cwiseAbs().mean(),
             WithinRel(flow.servo_flow_m3_per_s, 6e-4));
  CHECK_THAT(series.run.outputs.col(1).cwiseAbs().mean(), WithinRel(flow.leak_flow_m3_per_s, 6e-4));
}
