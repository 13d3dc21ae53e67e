#include "datasets/checks/sensor_doubts.hpp"

#include <catch2/catch.hpp>

namespace rigcal::datasets {
namespace {

using Catch::Contains;
using Fields = ReportSettings::Fields;

Campaign tested_on(const std::string& date) {
  Campaign campaign;
  Condition condition;
  condition.id = "sine";
  condition.date = date;
  campaign.conditions = {condition};
  ChannelSetting position;
  campaign.channels[Channel::position] = position;
  return campaign;
}

}  // namespace

TEST_CASE("sensor doubts: a due date counts by the day of the test", "[datasets]") {
  Campaign campaign = tested_on("2026-02-26");
  campaign.report.sensors = {Fields{{"channel", "position"}, {"due", "2026-02-26"}}};
  CHECK(sensor_doubts(campaign).empty());
  campaign.report.sensors = {
      Fields{{"channel", "position"}, {"serial_number", "7"}, {"due", "2026-02-25"}}};
  REQUIRE(sensor_doubts(campaign).size() == 1);
  CHECK(sensor_doubts(campaign)[0].code == "sensor_overdue");
  CHECK(sensor_doubts(campaign)[0].grave);
  campaign.conditions[0].use = Use::ignore;
  CHECK(sensor_doubts(campaign).empty());
  campaign.report.sensors = {
      Fields{{"channel", "position"}, {"calibrated", "2024-01-31"}, {"due", "2023-01-31"}}};
  CHECK(sensor_doubts(campaign).at(0).code == "sensor_dates");
}

TEST_CASE("sensor doubts: an uncertainty that counts nowhere is told", "[datasets]") {
  Campaign campaign = tested_on("2026-02-26");
  const auto words = [&](const char* channel, const char* uncertainty) {
    campaign.report.sensors = {Fields{{"channel", channel}, {"uncertainty", uncertainty}}};
    const auto doubts = sensor_doubts(campaign);
    return doubts.empty() ? std::string() : doubts[0].words;
  };
  CHECK(words("position", "0.02 mm (k = 2)").empty());
  CHECK_THAT(words("position", "0.02 mm"), Contains("\"0.02 mm\", is not used"));
  CHECK_THAT(words("Position", "0.02 mm (k = 2)"), Contains("did you mean \"position\""));
  CHECK(words("oil temperature in the tank", "0.5 K").empty());  // it is not used in any result
  ChannelSetting supply;
  supply.role = ChannelRole::input;
  supply.gain_sd = 0.01;
  campaign.channels[Channel::supply_pressure] = supply;
  campaign.report.sensors.clear();
  REQUIRE(sensor_doubts(campaign).size() == 1);
  CHECK_FALSE(sensor_doubts(campaign)[0].grave);
}

}  // namespace rigcal::datasets
