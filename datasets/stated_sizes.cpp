#include "datasets/stated_sizes.hpp"

#include <algorithm>
#include <array>

#include "model/simulate.hpp"

namespace rigcal::datasets {
namespace {

/// Keys of parameters that describe an effect. A plant without the parameter has no such effect.
constexpr std::array kOfParameters{"valve_time_constant",
                                   "valve_offset",
                                   "valve_dead_band",
                                   "coulomb_friction",
                                   "stribeck_friction",
                                   "laminar_leakage",
                                   "valve_null_leakage",
                                   "leakage_coefficient",
                                   "transport_delay",
                                   "sample_time",
                                   "total_volume",
                                   "dead_volume_a",
                                   "dead_volume_b",
                                   "position_lag",
                                   "position_gain",
                                   "position_offset",
                                   "load_pressure_lag",
                                   "load_pressure_gain",
                                   "load_pressure_offset",
                                   "pressure_a_lag",
                                   "pressure_a_gain",
                                   "pressure_a_offset",
                                   "pressure_b_lag",
                                   "pressure_b_gain",
                                   "pressure_b_offset",
                                   "angle_lag",
                                   "angle_gain",
                                   "angle_offset",
                                   "torque_lag",
                                   "torque_gain",
                                   "torque_offset",
                                   "joint_friction",
                                   "pilot_dead_band",
                                   "force_lag",
                                   "force_gain",
                                   "force_offset",
                                   "acceleration_lag",
                                   "acceleration_gain",
                                   "acceleration_offset",
                                   "payload_acceleration_lag",
                                   "payload_acceleration_gain",
                                   "payload_acceleration_offset"};

std::string unit_of(model::PlantKind plant, int index) {
  return std::string(model::parameter_spec(plant, index).unit);
}

}  // namespace

std::vector<SizedQuantity> effect_names(model::PlantKind plant) {
  std::vector<SizedQuantity> names;
  std::vector<std::string_view> keys(kOfParameters.begin(), kOfParameters.end());
  for (const model::FeedbackRow& loop : model::kFeedbacks)
    for (const std::string_view gain : {loop.kp, loop.ki, loop.kd}) {
      if (std::find(keys.begin(), keys.end(), gain) == keys.end()) keys.push_back(gain);
    }
  for (const std::string_view key : keys) {
    const int index = model::parameter_index(plant, key);
    if (index < 0) continue;
    // The friction of a joint includes that of its cylinder.
    if (plant == model::PlantKind::linkage &&
        (key == "coulomb_friction" || key == "stribeck_friction"))
      continue;
    // In this plant, null leakage is the same term as a laminar leak.
    if (plant == model::PlantKind::load_pressure && key == "valve_null_leakage") continue;
    names.push_back({std::string(key), unit_of(plant, index)});
  }
  if (model::parameter_index(plant, "transport_delay") >= 0) names.push_back({kTriggerKey, "s"});
  if (model::parameter_index(plant, "valve_dead_band") >= 0)
    names.push_back({"valve_underlap", "V"});
  names.push_back({"supply_sag", "1"});
  names.push_back({"loop_gain", "1"});
  const bool turns = plant == model::PlantKind::linkage;
  names.push_back({"valve_hysteresis", "V"});
  if (turns) names.push_back({"pilot_hysteresis", "Pa"});
  for (const char* effect : {"_bow", "_wave", "_hysteresis"})
    names.push_back({(turns ? "angle" : "position") + std::string(effect), turns ? "rad" : "m"});
  return names;
}

std::vector<SizedQuantity> day_quantity_names(model::PlantKind plant) {
  std::vector<SizedQuantity> names;
  for (const char* key : {"supply_pressure", "bulk_modulus", "position_offset"}) {
    const int index = model::parameter_index(plant, key);
    if (index >= 0) names.push_back({key, unit_of(plant, index)});
  }
  names.push_back({kTriggerKey, "s"});
  return names;
}

}  // namespace rigcal::datasets
