#include "datasets/checks/drive_start.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

using namespace rigcal::datasets;
using Catch::Contains;
using rigcal::model::ControllerKind;

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
