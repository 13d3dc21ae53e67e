#include "datasets/checks/sensor_warnings.hpp"

#include <catch2/catch.hpp>

#include "tests/datasets/sensor_signals.hpp"

using namespace rigcal::datasets;
using namespace rigcal::test;
using Catch::Contains;
using Kind = SensorFault::Kind;

namespace {

Campaign closed_loop() {
  Campaign campaign;
  campaign.rig.controller = rigcal::model::ControllerKind::pid;
  return campaign;
}

/// A condition with a 2.5 Hz sine that lasts 4 s at 1 kHz.
Condition condition() {
  Condition result;
  result.id = "a";
  result.waveform = Waveform::sine;
  result.frequency_hz = 2.5;
  result.amplitude = 1.0;
  return result;
}

Repeat repeat_of(const std::string& source, Samples position) {
  Repeat repeat;
  repeat.source = source;
  repeat.time_s = samples(position.size(), [](double i) { return 1e-3 * i; });
  repeat.values[Channel::position] = std::move(position);
  return repeat;
}

Samples motion() { return with_noise(sine_signal(4000, 400.0), 0.002); }

/// The motion with samples 1000 to 1199 frozen.
Samples interrupted() {
  Samples x = motion();
  std::fill_n(x.begin() + 1000, 200, x[1000]);
  return x;
}

}  // namespace

TEST_CASE("sensor_warnings: one for each channel and kind, with the longest run", "[datasets]") {
  const std::vector<Repeat> repeats{
      repeat_of("a1.csv", clipped(motion(), -2.0, 0.8)),
      repeat_of("a2.csv", clipped(motion(), -2.0, 0.8)),
      repeat_of("a3.csv", interrupted()),
      repeat_of("a4.csv", motion()),
  };
  const auto texts = sensor_warnings(sensor_faults(closed_loop(), condition(), repeats), {});
  REQUIRE(texts.size() == 2);
  CHECK_THAT(texts[0], Contains("position: stays at exactly its highest value") &&
                           Contains("(0.8 m)") && Contains("in 2 repeats") && Contains("a1.csv"));
  CHECK_THAT(texts[1], Contains("position: does not change while the drive does") &&
                           Contains("200 samples in 1 repeat, the longest run a3.csv from 1 s to "
                                    "1.199 s"));
}

TEST_CASE("sensor_warnings: only of what counts", "[datasets]") {
  const auto faults =
      sensor_faults(closed_loop(), condition(), {repeat_of("a.csv", interrupted())});
  REQUIRE(faults.size() == 1);
  CHECK(faults[0].kind == Kind::frozen);
  CHECK(sensor_warnings(faults, {{0.0, 0.9}, {1.3, 4.0}}).empty());
  CHECK(sensor_warnings(faults, {{0.0, 0.9}, {1.1, 4.0}}).size() == 1);
}

TEST_CASE("sensor_faults: the drive is the recorded one, or a generated sine or square",
          "[datasets]") {
  const Repeat broken = repeat_of("a.csv", interrupted());
  Condition recorded = condition();
  recorded.waveform = Waveform::recorded;
  CHECK(sensor_faults(closed_loop(), recorded, {broken}).empty());
  Repeat with_reference = broken;
  with_reference.values[Channel::reference] = sine_signal(4000, 400.0);
  CHECK(sensor_faults(closed_loop(), recorded, {with_reference}).size() == 1);
  with_reference.values[Channel::reference] = Samples(4000, 0.5);  // at rest
  CHECK(sensor_faults(closed_loop(), recorded, {with_reference}).empty());
}

TEST_CASE("sensor_faults: what is commanded may stand at its limit", "[datasets]") {
  Repeat repeat = repeat_of("a.csv", motion());
  repeat.values[Channel::command] = clipped(sine_signal(4000, 400.0), -0.5, 0.5);
  repeat.values[Channel::reference] = sine_signal(4000, 400.0);
  CHECK(sensor_faults(closed_loop(), condition(), {repeat}).empty());
  repeat.values[Channel::pressure_a] = clipped(motion(), -0.5, 2.0);
  const auto faults = sensor_faults(closed_loop(), condition(), {repeat});
  REQUIRE_FALSE(faults.empty());
  CHECK(faults[0].channel == Channel::pressure_a);
  CHECK(faults[0].kind == Kind::clipped_at_lowest);
}
