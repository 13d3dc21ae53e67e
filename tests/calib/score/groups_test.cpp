#include "calib/score/groups.hpp"

#include <catch2/catch.hpp>

using Catch::WithinRel;
using namespace rigcal;

namespace {

datasets::Condition condition(const char* id, datasets::Waveform waveform, double frequency_hz) {
  datasets::Condition c;
  c.id = id;
  c.waveform = waveform;
  c.frequency_hz = frequency_hz;
  c.leak_level = "66 %";
  return c;
}

calib::ConditionScore score(const char* id, double rho2) {
  calib::ConditionScore s;
  s.id = id;
  calib::ChannelScore channel;
  channel.metrics.rho2 = rho2;
  channel.metrics.rmse = 1.0 - rho2;
  s.channels.push_back(channel);
  return s;
}

}  // namespace

TEST_CASE("groups: means and the worst by signal, frequency, waveform and leak level", "[calib]") {
  using datasets::Waveform;
  datasets::Campaign campaign;
  campaign.conditions = {condition("a", Waveform::sine, 10.0), condition("b", Waveform::sine, 1.0),
                         condition("c", Waveform::square, 1.0)};
  campaign.conditions[2].leak_level.reset();
  calib::Fit fit;
  fit.conditions = {score("a", 0.9), score("b", 0.8), score("c", 0.6)};
  fit.conditions[1].channels[0].metrics =
      calib::ChannelMetrics{};  // a constant record has no metrics

  const auto all = calib::groups(campaign, fit);
  const auto find = [&](const std::string& by, const std::string& label) {
    for (const calib::Group& group : all) {
      if (group.by == by && group.label == label) return group;
    }
    FAIL("no group " + by + " " + label);
    return calib::Group{};
  };
  CHECK(find("signal", "sine 10 Hz").conditions == std::vector<std::string>{"a"});
  CHECK(find("frequency", "1 Hz").conditions == std::vector<std::string>{"b", "c"});
  CHECK(find("frequency", "1 Hz").metrics.at(0).second.conditions == 1);
  std::vector<std::string> frequencies;
  for (const calib::Group& group : all) {
    if (group.by == "frequency") frequencies.push_back(group.label);
  }
  CHECK(frequencies == std::vector<std::string>{"1 Hz", "10 Hz"});
  CHECK(find("leak_level", "66 %").conditions == std::vector<std::string>{"a", "b"});
  const calib::GroupScore use = find("use", "fit").metrics.at(0).second;
  CHECK(use.conditions == 2);
  CHECK_THAT(use.mean.rho2, WithinRel(0.75, 1e-14));
  CHECK(use.worst.rho2 == 0.6);
  CHECK_THAT(use.worst.rmse, WithinRel(0.4, 1e-14));
  // Each of the three conditions has a weight of one third: (0.9 + 0.9 + 0.6) / 3.
  fit.conditions[1] = score("b", 0.9);
  for (const calib::Group& group : calib::groups(campaign, fit)) {
    if (group.by == "use") CHECK_THAT(group.metrics.at(0).second.mean.rho2, WithinRel(0.8, 1e-14));
  }
}
