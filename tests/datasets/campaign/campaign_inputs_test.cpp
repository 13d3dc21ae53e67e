#include <catch2/catch.hpp>

#include "datasets/campaign/campaign.hpp"

using namespace rigcal::datasets;

TEST_CASE("inputs_of: a measured channel acts on the rig where its role says so", "[datasets]") {
  Campaign campaign;
  Condition condition;
  condition.waveform = Waveform::sine;
  condition.amplitude = 1.0;
  condition.frequency_hz = 2.0;
  Record record;
  record.time_s = {0.0, 1.0};
  record.channels[Channel::force].mean = {100.0, 300.0};
  const auto force_of = [&](ChannelRole role, Interpolation interpolation) {
    ChannelSetting setting;
    setting.channel = Channel::force;
    setting.role = role;
    setting.interpolation = interpolation;
    campaign.channels[Channel::force] = setting;
    return inputs_of(campaign, condition, values_in(campaign, condition), &record).external_load;
  };
  CHECK_FALSE(force_of(ChannelRole::output, Interpolation::hold));
  CHECK_FALSE(force_of(ChannelRole::ignore, Interpolation::hold));
  CHECK(force_of(ChannelRole::input, Interpolation::hold)->value(0.5) == 100.0);
  CHECK(force_of(ChannelRole::input, Interpolation::linear)->value(0.5) == 200.0);
}
