#pragma once

#include <utility>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "diagnosis/record/leak_fit.hpp"

namespace rigcal::test {

/// One record of a short 1 Hz sine, healthy unless it is created with a leak.
struct HealthySine {
  datasets::Campaign campaign;
  datasets::Record record;
};

/// Simulates the record.
///
/// @param further  other values for the rig that creates the record
inline HealthySine healthy_sine(double leakage_coefficient = 0.0,
                                const datasets::Overrides& further = {}) {
  HealthySine made;
  made.campaign =
      datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/rigs/uis_shake_table/diagnosis.toml");
  std::erase_if(made.campaign.conditions,
                [](const auto& each) { return each.id != "sine_1Hz_open_0"; });
  made.campaign.conditions.front().duration_s = 2.0;
  made.campaign.conditions.front().sample_rate_hz = 250.0;
  datasets::Campaign leaking = made.campaign;
  if (leakage_coefficient > 0.0) {
    const int leak = model::parameter_index(leaking.rig.plant, "leakage_coefficient");
    leaking.conditions.front().overrides = {{leak, leakage_coefficient}};
  }
  auto& overrides = leaking.conditions.front().overrides;
  overrides.insert(overrides.end(), further.begin(), further.end());
  const datasets::Campaign truth = datasets::true_campaign(leaking);
  std::vector<datasets::Repeat> repeats;
  for (auto& each : datasets::synthetic_repeats(truth, truth.conditions.front(), nullptr, 1))
    repeats.push_back(std::move(each.record));
  made.record =
      datasets::repeat_records(made.campaign, made.campaign.conditions.front(), repeats).average;
  return made;
}

/// Returns the true rig, with a valve gain known within 1 %.
inline diagnosis::RigFit rig_of(const datasets::Campaign& campaign) {
  diagnosis::RigFit rig;
  for (const auto& [index, value] : campaign.synthetic_settings->parameters)
    rig.values.push_back({index, datasets::Scope::rig, "", value});
  rig.indices = {model::parameter_index(campaign.rig.plant, "valve_gain")};
  rig.covariance = Eigen::MatrixXd::Constant(1, 1, 4.06e-7 * 4.06e-7);
  return rig;
}

}  // namespace rigcal::test
