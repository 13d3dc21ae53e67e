#include "datasets/campaign/design/drive_file.hpp"

#include <fmt/format.h>

#include "common/parse_double.hpp"

namespace rigcal::datasets {
namespace {

std::string in_drive_unit(const DriveUnit& unit, double value_si) {
  const double value = (value_si - unit.to_si.offset) / unit.to_si.scale;
  return fmt::format("{:.10g}", value == 0.0 ? 0.0 : value);  // never "-0"
}

}  // namespace

DriveUnit drive_unit(const Campaign& campaign) {
  const ChannelInfo& channel = info(drive_channel(campaign));
  const auto setting = campaign.channels.find(channel.channel);
  const bool stated = setting != campaign.channels.end() && !setting->second.stated.unit.empty();
  if (!stated) return {std::string(channel.unit), {}};
  const StatedUnit& unit = setting->second.stated;
  return {unit.unit, stated_conversion(unit, channel.unit)};
}

std::string drive_csv(const Campaign& campaign, const std::vector<double>& time_s,
                      const std::vector<double>& drive_si) {
  const DriveUnit unit = drive_unit(campaign);
  std::string text = fmt::format("time_s,{}_{}\n", info(drive_channel(campaign)).key, unit.name);
  for (std::size_t i = 0; i < time_s.size(); ++i)
    text += fmt::format("{:.12g},{}\n", time_s[i], in_drive_unit(unit, drive_si[i]));
  return text;
}

double written_drive(const DriveUnit& unit, double value_si) {
  const std::string text = in_drive_unit(unit, value_si);
  double value = 0.0;
  parse_double(text.data(), text.data() + text.size(), value);
  return unit.to_si(value);
}

std::string designed_condition_id(DriveFamily family) {
  return fmt::format("design_{}", to_string(family));
}

}  // namespace rigcal::datasets
