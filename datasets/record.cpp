#include "datasets/record.hpp"

#include <algorithm>

namespace rigcal::datasets {

const std::vector<ChannelInfo>& channel_table() {
  static const std::vector<ChannelInfo> table{
      {Channel::reference, "reference", "reference_m", "m", false},
      {Channel::command, "command", "command_v", "V", false},
      {Channel::position, "position", "position_m", "m", true},
      {Channel::load_pressure, "load_pressure", "load_pressure_pa", "Pa", true},
      {Channel::pressure_a, "pressure_a", "pressure_a_pa", "Pa", true},
      {Channel::pressure_b, "pressure_b", "pressure_b_pa", "Pa", true},
      {Channel::supply_pressure, "supply_pressure", "supply_pressure_pa", "Pa", false},
      {Channel::tank_pressure, "tank_pressure", "tank_pressure_pa", "Pa", false},
      {Channel::force, "force", "force_n", "N", true},
      {Channel::temperature, "temperature", "temperature_k", "K", false},
      {Channel::acceleration, "acceleration", "acceleration_m_per_s2", "m/s2", true},
      {Channel::payload_acceleration, "payload_acceleration", "payload_acceleration_m_per_s2",
       "m/s2", true},
      {Channel::force_reference, "force_reference", "force_reference_n", "N", false},
      {Channel::load_pressure_reference, "load_pressure_reference", "load_pressure_reference_pa",
       "Pa", false},
      {Channel::acceleration_reference, "acceleration_reference", "acceleration_reference_m_per_s2",
       "m/s2", false},
      {Channel::angle, "angle", "angle_rad", "rad", true},
      {Channel::pilot_pressure, "pilot_pressure", "pilot_pressure_pa", "Pa", false},
      {Channel::base_acceleration, "base_acceleration", "base_acceleration_m_per_s2", "m/s2",
       false},
      {Channel::angle_reference, "angle_reference", "angle_reference_rad", "rad", false},
      {Channel::torque, "torque", "torque_n_m", "N m", true},
      {Channel::torque_reference, "torque_reference", "torque_reference_n_m", "N m", false},
  };
  return table;
}

const ChannelInfo& info(Channel channel) {
  return channel_table().at(static_cast<std::size_t>(channel));
}

bool is_drive(Channel channel) {
  switch (channel) {
    case Channel::reference:
    case Channel::command:
    case Channel::force_reference:
    case Channel::load_pressure_reference:
    case Channel::acceleration_reference:
    case Channel::angle_reference:
    case Channel::torque_reference:
    case Channel::pilot_pressure:
      return true;
    default:
      return false;
  }
}

std::optional<Channel> channel_from_key(std::string_view key) {
  const auto& table = channel_table();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const ChannelInfo& each) { return each.key == key; });
  if (row == table.end()) return std::nullopt;
  return row->channel;
}

}  // namespace rigcal::datasets
