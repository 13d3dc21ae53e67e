#include "datasets/checks/travel.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace rigcal::datasets;
using Catch::Contains;
using rigcal::model::ControllerKind;
using rigcal::model::PlantKind;

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
