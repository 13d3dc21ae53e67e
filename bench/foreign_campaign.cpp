#include "bench/foreign_campaign.hpp"

#include <map>
#include <string>

namespace rigcal::bench {

datasets::Campaign foreign_campaign(const ForeignRig& rig) {
  datasets::Campaign campaign;
  const std::map<std::string, double> known{{"stiffness", 0.0},
                                            {"piston_area", rig.area_m2},
                                            {"total_volume", rig.volume_m3},
                                            {"supply_pressure", rig.supply_pa},
                                            {"density", rig.density_kg_per_m3},
                                            {"discharge_coefficient", rig.discharge},
                                            {"area_gradient", rig.gradient_m},
                                            {"leakage_area", rig.leak_area_m2},
                                            {"leakage_smoothing", rig.straight_below_pa},
                                            {"kp", rig.kp_v_per_m},
                                            {"kd", rig.kd_v_s_per_m},
                                            {"derivative_filter", rig.filter_rad_per_s},
                                            {"output_limit", rig.limit_v}};
  for (const auto& [key, value] : known) {
    datasets::ParameterSetting setting;
    setting.index = model::parameter_index(model::PlantKind::load_pressure, key);
    setting.value = value;
    campaign.parameters.push_back(setting);
  }
  datasets::ChannelSetting position;
  position.channel = datasets::Channel::position;
  campaign.channels[position.channel] = position;
  campaign.rig.before = model::Before::rest;
  campaign.before_stated = true;
  return campaign;
}

}  // namespace rigcal::bench
