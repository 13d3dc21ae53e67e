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
