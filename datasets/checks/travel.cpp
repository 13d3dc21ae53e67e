#include "datasets/checks/travel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kBeyondStroke = 1.1;  // sensors may be off by a few per cent
constexpr double kBeyondReference = 10.0;
constexpr double kOfReference = 0.002;
constexpr double kLongestCylinderM = 20.0;

double range(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return *high - *low;
}

/// Returns the stroke of the cylinder if it is known and is not fitted.
std::optional<double> stroke_m(const Campaign& campaign, const Condition& condition) {
  constexpr const char* kStroke = "stroke";
  const int index = model::parameter_index(campaign.rig.plant, kStroke);
  const ParameterSetting* setting = index < 0 ? nullptr : campaign.setting(index);
  if (setting == nullptr || setting->fit) return std::nullopt;
  return values_in(campaign, condition)[kStroke];
}

struct Extent {
  double range = 0.0;
  double farthest = 0.0;  ///< range or largest size, whichever is larger: the piston may start at
                          ///< zero and be asked to go to a constant reference
};

/// Returns the extent of the reference in a closed loop.
std::optional<Extent> reference_extent_m(const Campaign& campaign, const Condition& condition,
                                         const Record& record) {
  if (drive_channel(campaign) != Channel::reference) return std::nullopt;
  if (condition.waveform != Waveform::recorded && condition.amplitude)
    return Extent{2.0 * *condition.amplitude, 2.0 * *condition.amplitude};
  const auto found = record.channels.find(Channel::reference);
  if (found == record.channels.end()) return std::nullopt;
  Extent extent{range(found->second.mean), 0.0};
  extent.farthest = extent.range;
  for (const double x : found->second.mean)
    extent.farthest = std::max(extent.farthest, std::abs(x));
  return extent;
}

}  // namespace

std::string travel_warning(const Campaign& campaign, const Condition& condition,
                           const Record& record) {
  const auto position = record.channels.find(Channel::position);
  const auto setting = campaign.channels.find(Channel::position);
  const bool in_counts = setting != campaign.channels.end() && setting->second.in_counts;
  if (position == record.channels.end() || in_counts) return {};
  const double travel = range(position->second.mean);
  constexpr const char* kUnit = "is the unit of its column right?";
  if (const auto stroke = stroke_m(campaign, condition)) {
    if (travel <= kBeyondStroke * *stroke) return {};
    return fmt::format("position: {:.4g} m of travel, beyond the stroke of {:.4g} m: {}", travel,
                       *stroke, kUnit);
  }
  const auto reference = reference_extent_m(campaign, condition, record);
  if (reference && reference->range > 0.0) {
    const bool far = travel > kBeyondReference * reference->farthest;
    if (!far && travel >= kOfReference * reference->range) return {};
    return fmt::format("position: {:.4g} m of travel, where the reference covers {:.4g} m: {}",
                       travel, far ? reference->farthest : reference->range, kUnit);
  }
  if (travel <= kLongestCylinderM) return {};
  return fmt::format("position: {:.4g} m of travel: {}", travel, kUnit);
}

}  // namespace rigcal::datasets
