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
  };
  return table;
}

const ChannelInfo& info(Channel channel) {
  return channel_table().at(static_cast<std::size_t>(channel));
}

std::optional<Channel> channel_from_key(std::string_view key) {
  const auto& table = channel_table();
  const auto row = std::find_if(table.begin(), table.end(),
                                [&](const ChannelInfo& each) { return each.key == key; });
  if (row == table.end()) return std::nullopt;
  return row->channel;
}

}  // namespace rigcal::datasets
