#include "datasets/checks/record_checks.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

using namespace rigcal::datasets;
using Catch::Contains;
using rigcal::model::ControllerKind;
using rigcal::model::PlantKind;

namespace {

/// Returns the warning for a 2 Hz sine with this time step.
std::string sampling_warning(double step_s, int samples, Condition condition = {}) {
  Record record;
  for (int i = 0; i < samples; ++i) record.time_s.push_back(step_s * i);
  if (!condition.frequency_hz) {
    condition.waveform = Waveform::sine;
    condition.frequency_hz = 2.0;
  }
  return drive_sampling_warning(condition, record);
}

}  // namespace

TEST_CASE("drive_sampling_warning: samples a period", "[datasets]") {
  CHECK(sampling_warning(0.005, 401).empty());
  CHECK(sampling_warning(0.125, 41).empty());  // four samples per period
  CHECK_THAT(sampling_warning(0.126, 41),
             Contains("3.97 samples a period of the sine of 2 Hz") && !Contains("ms"));
  CHECK_THAT(sampling_warning(5.0, 401),
             Contains("0.1 samples a period of the sine of 2 Hz") && Contains("in ms?"));
  CHECK_THAT(sampling_warning(5e-6, 401),
             Contains("0.004 of a period") && Contains("in s, not in ms?"));
  Condition chirp;
  chirp.waveform = Waveform::chirp;
  chirp.frequency_hz = 1.0;
  chirp.end_frequency_hz = 60.0;
  CHECK_THAT(sampling_warning(0.005, 401, chirp),
             Contains("3.33 samples a period of the chirp of 60 Hz"));
  chirp.end_frequency_hz = 40.0;
  CHECK(sampling_warning(0.005, 401, chirp).empty());
}

TEST_CASE("drive_sampling_warning: the stated duration", "[datasets]") {
  Condition recorded;
  recorded.waveform = Waveform::recorded;
  recorded.frequency_hz = 2.0;
  CHECK(sampling_warning(5.0, 401, recorded).empty());
  recorded.duration_s = 2.0;
  CHECK(sampling_warning(0.005, 401, recorded).empty());
  CHECK_THAT(sampling_warning(5.0, 401, recorded),
             Contains("lasts 2000 s, where the campaign states 2 s") && Contains("in ms?"));
  CHECK_THAT(sampling_warning(5e-6, 401, recorded), Contains("in s, not in ms?"));
}

namespace {

/// A piston that follows a command, which is 2 V from the first sample.
struct StartCase {
  Campaign campaign;
  Condition condition;
  Record record;
  StartCase() {
    campaign.rig.controller = ControllerKind::none;
    auto& u = record.channels[Channel::command].mean;
    auto& x = record.channels[Channel::position].mean;
    for (int i = 0; i < 100; ++i) {
      record.time_s.push_back(0.01 * i);
      u.push_back(i < 80 ? 2.0 : 0.0);
      x.push_back(i < 10 ? 0.1 : 0.1 + 0.001 * (i - 10));
    }
  }
  std::string proposed() const { return drive_start_proposal(campaign, condition, record); }
};

}  // namespace

TEST_CASE("drive_start: a record that begins at its step", "[datasets]") {
  CHECK_THAT(StartCase().proposed(),
             Contains("the first command is 2 V") && Contains("before = \"rest\""));
}

TEST_CASE("drive_start: nothing where the piston moves, the drive rests or the campaign knows",
          "[datasets]") {
  StartCase moving;
  for (std::size_t i = 0; i < 100; ++i)
    moving.record.channels[Channel::position].mean[i] = 0.001 * static_cast<double>(i);
  CHECK(moving.proposed().empty());
  StartCase resting;
  for (std::size_t i = 0; i < 5; ++i) resting.record.channels[Channel::command].mean[i] = 0.1;
  CHECK(resting.proposed().empty());
  StartCase stated;
  stated.campaign.before_stated = true;
  CHECK(stated.proposed().empty());
  StartCase generated;
  generated.condition.waveform = Waveform::square;
  CHECK(generated.proposed().empty());
  StartCase noise;
  for (std::size_t i = 0; i < 100; ++i)
    noise.record.channels[Channel::command].mean[i] = std::sin(1.7 * static_cast<double>(i) + 1.0);
  CHECK(noise.proposed().empty());
}

TEST_CASE("drive_start: in a loop neutral is where the piston is", "[datasets]") {
  StartCase loop;
  loop.campaign.rig.controller = ControllerKind::pid;
  auto& r = loop.record.channels[Channel::reference].mean;
  r.assign(100, 0.2);
  CHECK_THAT(loop.proposed(),
             Contains("the first reference is 0.2 m") && Contains("the position 0.1 m"));
  r.assign(100, 0.1);
  CHECK(loop.proposed().empty());
}

namespace {

struct TravelCase {
  Campaign campaign;
  Condition condition;
  Record record;
  explicit TravelCase(double travel_m, ControllerKind controller = ControllerKind::pid) {
    campaign.rig.controller = controller;
    campaign.channels[Channel::position].channel = Channel::position;
    condition.waveform = Waveform::sine;
    condition.amplitude = 0.05;
    record.channels[Channel::position].mean = {0.0, travel_m, 0.5 * travel_m};
  }
  std::string told() const { return travel_warning(campaign, condition, record); }
};

}  // namespace

TEST_CASE("travel_warning: against the reference", "[datasets]") {
  CHECK(TravelCase(0.1).told().empty());
  CHECK(TravelCase(0.9).told().empty());
  CHECK_THAT(TravelCase(100.0).told(),
             Contains("100 m of travel, where the reference covers 0.1 m: is the unit"));
  CHECK_THAT(TravelCase(1e-4).told(),
             Contains("0.0001 m of travel, where the reference covers 0.1 m"));
  TravelCase recorded(144.0);
  recorded.condition.waveform = Waveform::recorded;
  CHECK_THAT(recorded.told(), Contains("position: 144 m of travel: is the unit"));
  recorded.record.channels[Channel::reference].mean = {0.0, 144.0};
  CHECK(recorded.told().empty());
  recorded.record.channels[Channel::reference].mean = {0.0, 0.144};
  CHECK_THAT(recorded.told(), Contains("the reference covers 0.144 m"));
}

TEST_CASE("travel_warning: a step that the record does not show in its reference", "[datasets]") {
  TravelCase step(0.05);
  step.condition.waveform = Waveform::recorded;
  step.record.channels[Channel::reference].mean = {0.0502, 0.0499, 0.0501};
  CHECK(step.told().empty());
  step.record.channels[Channel::position].mean = {0.0, 50.0};
  CHECK_THAT(step.told(), Contains("50 m of travel, where the reference covers 0.0502 m"));
  step.record.channels[Channel::position].mean = {0.0, 5e-7};
  CHECK_THAT(step.told(), Contains("the reference covers 0.0003 m"));
}

TEST_CASE("travel_warning: without a reference, and in counts", "[datasets]") {
  CHECK(TravelCase(19.0, ControllerKind::none).told().empty());
  CHECK_THAT(TravelCase(144.0, ControllerKind::none).told(),
             Contains("144 m of travel: is the unit"));
  TravelCase counts(30000.0, ControllerKind::none);
  counts.campaign.channels[Channel::position].in_counts = true;
  CHECK(counts.told().empty());
}

TEST_CASE("travel_warning: beyond the stroke", "[datasets]") {
  TravelCase test(0.5, ControllerKind::none);
  test.campaign.rig.plant = PlantKind::two_chamber;
  ParameterSetting stroke;
  stroke.index = rigcal::model::parameter_index(PlantKind::two_chamber, "stroke");
  stroke.value = 0.4;
  test.campaign.parameters.push_back(stroke);
  CHECK_THAT(test.told(), Contains("0.5 m of travel, beyond the stroke of 0.4 m"));
  test.campaign.parameters[0].value = 0.47;
  CHECK(test.told().empty());
  test.campaign.parameters[0].fit = true;  // the true stroke may be longer
  test.campaign.parameters[0].value = 0.4;
  CHECK(test.told().empty());
}

namespace {

/// A loop on position that states a sine of 1 Hz and 20 mm, or the open loop that the command
/// drives.
struct DriveCase {
  Campaign campaign;
  Condition condition;
  Record record;
  explicit DriveCase(ControllerKind controller = ControllerKind::pid) {
    campaign.rig.controller = controller;
    condition.waveform = Waveform::sine;
    condition.frequency_hz = 1.0;
    condition.amplitude = controller == ControllerKind::pid ? 0.02 : 2.0;
    for (int i = 0; i < 400; ++i) record.time_s.push_back(0.01 * i);
  }
  void fill(Channel channel, double (*value)(double)) {
    auto& mean = record.channels[channel].mean;
    mean.clear();
    for (const double t : record.time_s) mean.push_back(value(t));
  }
  std::string stated() const { return stated_drive_warning(campaign, condition, record); }
  std::string mirrored() const { return mirrored_motion_warning(campaign, condition, record); }
};

constexpr double kTurn = 6.283185307179586;

}  // namespace

TEST_CASE("stated_drive_warning: the recorded reference is another signal", "[datasets]") {
  DriveCase loop;
  CHECK(loop.stated().empty());  // not recorded
  loop.fill(Channel::reference, [](double t) { return 0.02 * std::sin(kTurn * t); });
  CHECK(loop.stated().empty());
  // A shift by one sample, and noise.
  loop.fill(Channel::reference, [](double t) {
    return 0.02 * std::sin(kTurn * (t - 0.01)) + 1e-4 * std::sin(431.0 * t);
  });
  CHECK(loop.stated().empty());
  loop.fill(Channel::reference, [](double t) { return 0.02 * std::sin(kTurn * t - 0.15); });
  CHECK_THAT(loop.stated(), Contains("the recorded reference is not the sine") &&
                                Contains("waveform = \"recorded\""));
  // A triangle has 99 % of its variance in the first harmonic.
  loop.fill(Channel::reference,
            [](double t) { return 0.02 * 4.0 / kTurn * std::asin(std::sin(kTurn * t)); });
  CHECK_FALSE(loop.stated().empty());
  // What the windows leave out does not count.
  loop.fill(Channel::reference, [](double t) { return t < 3 ? 0.02 * std::sin(kTurn * t) : 0.0; });
  CHECK_FALSE(loop.stated().empty());
  loop.record.windows = {{0.0, 2.9}};
  CHECK(loop.stated().empty());
  loop.record.windows.clear();
  loop.condition.waveform = Waveform::recorded;
  CHECK(loop.stated().empty());
}

TEST_CASE("stated_drive_warning: the edges of a square wave", "[datasets]") {
  DriveCase loop;
  loop.condition.waveform = Waveform::square;
  loop.fill(Channel::reference,
            [](double t) { return std::sin(kTurn * (t + 0.005)) >= 0.0 ? 0.02 : -0.02; });
  CHECK(loop.stated().empty());
  loop.fill(Channel::reference,
            [](double t) { return std::sin(kTurn * (t - 0.05)) >= 0.0 ? 0.02 : -0.02; });
  CHECK_FALSE(loop.stated().empty());
}

TEST_CASE("mirrored_motion_warning: a sensor of the wrong sign in a loop", "[datasets]") {
  DriveCase loop;
  loop.fill(Channel::position, [](double t) { return 0.1 - 0.018 * std::sin(kTurn * t - 0.3); });
  CHECK_THAT(loop.mirrored(),
             Contains("the position moves against the reference") && Contains("gain = -1"));
  loop.fill(Channel::position, [](double t) { return 0.1 + 0.018 * std::sin(kTurn * t - 0.3); });
  CHECK(loop.mirrored().empty());
  // A loop beyond its bandwidth lags by half a period and hardly moves.
  loop.fill(Channel::position, [](double t) { return -0.006 * std::sin(kTurn * t); });
  CHECK(loop.mirrored().empty());
  loop.record.channels.clear();
  CHECK(loop.mirrored().empty());
}

TEST_CASE("mirrored_motion_warning: a sensor of the wrong sign in an open loop", "[datasets]") {
  DriveCase open(ControllerKind::none);
  open.fill(Channel::position, [](double t) { return 0.05 * std::cos(kTurn * t) + 0.01 * t; });
  CHECK_THAT(open.mirrored(), Contains("the position moves against the command"));
  open.fill(Channel::position, [](double t) { return -0.05 * std::cos(kTurn * t) + 0.01 * t; });
  CHECK(open.mirrored().empty());
  // A fast sine that lags by half a period looks mirrored.
  open.condition.frequency_hz = 4.0;
  open.fill(Channel::position, [](double t) { return 0.01 * std::cos(4.0 * kTurn * t); });
  CHECK(open.mirrored().empty());
  open.condition.frequency_hz = 1.0;
  open.record.time_s.resize(50);  // too few blocks
  open.fill(Channel::position, [](double t) { return 0.05 * std::cos(kTurn * t); });
  CHECK(open.mirrored().empty());
}
