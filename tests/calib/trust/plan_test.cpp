#include "calib/trust/plan.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinRel;

/// A campaign with one planned condition for a rig with unknown mass.
datasets::Campaign planned_mass() {
  Twin twin;
  twin.free("mass", 80.0, 10.0, 500.0);
  auto& condition = twin.add("square", datasets::Waveform::square, 2.0, 0.01);
  condition.duration_s = 0.5;
  condition.sample_rate_hz = 500.0;
  return twin.campaign;
}

datasets::SyntheticSettings of_noise(double sd_m, int repeats) {
  datasets::SyntheticSettings synthetic;
  synthetic.sample_rate_hz = 500.0;
  synthetic.noise_sd[datasets::Channel::position] = sd_m;
  synthetic.repeats = repeats;
  return synthetic;
}

double planned_error(const datasets::Campaign& campaign) {
  return plan(campaign, {}, nullptr, 1).parameters.at(0).sd_all.value();
}

}  // namespace

TEST_CASE("plan: four repeats halve the error", "[calib]") {
  datasets::Campaign campaign = planned_mass();
  campaign.synthetic_settings = of_noise(5e-5, 1);
  const double of_one = planned_error(campaign);
  campaign.synthetic_settings = of_noise(5e-5, 4);
  CHECK_THAT(planned_error(campaign), WithinRel(0.5 * of_one, 1e-3));
  campaign.synthetic_settings.reset();
  campaign.channels[datasets::Channel::position].sd = 2.5e-5;
  CHECK_THAT(planned_error(campaign), WithinRel(0.5 * of_one, 1e-3));
}

TEST_CASE("plan: a condition says how many repeats it plans", "[calib]") {
  datasets::Campaign campaign = planned_mass();
  campaign.synthetic_settings = of_noise(5e-5, 1);
  const double of_one = planned_error(campaign);
  campaign.synthetic_settings = of_noise(5e-5, 9);
  campaign.conditions.front().planned_repeats = 4;
  CHECK_THAT(planned_error(campaign), WithinRel(0.5 * of_one, 1e-3));
  campaign.synthetic_settings.reset();
  campaign.channels[datasets::Channel::position].sd = 5e-5;
  CHECK_THAT(planned_error(campaign), WithinRel(0.5 * of_one, 1e-3));
}

TEST_CASE("plan: a prior adds what it tells", "[calib]") {
  datasets::Campaign campaign = planned_mass();
  campaign.synthetic_settings = of_noise(5e-5, 1);
  const double alone = planned_error(campaign);
  for (auto& setting : campaign.parameters) {
    if (setting.fit) setting.prior = datasets::Prior{80.0, 2.0 * alone};
  }
  // Information adds up: 1 + 1/4.
  CHECK_THAT(planned_error(campaign), WithinRel(alone / std::sqrt(1.25), 1e-3));
}

TEST_CASE("plan: what would be known badly is told", "[calib]") {
  datasets::Campaign campaign = planned_mass();
  campaign.synthetic_settings = of_noise(5e-5, 1);
  const double half_width = 1.96 * planned_error(campaign) / 80.0;
  const auto messages_at = [&](double wanted) {
    campaign.synthetic_settings = of_noise(5e-5 * wanted / half_width, 1);
    std::string all;
    for (const std::string& each : plan(campaign, {}, nullptr, 1).messages) all += each + "\n";
    return all;
  };
  CHECK_THAT(messages_at(0.5), Contains("mass_kg: known to 50 % only from these records"));
  CHECK_THAT(messages_at(0.15), !Contains("mass_kg"));
}

}  // namespace rigcal::calib
