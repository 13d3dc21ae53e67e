#include "datasets/checks/record_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kFewestPerPeriod = 4.0;    // samples in a period
constexpr double kShortestFraction = 0.01;  // fraction of a period, or of the stated duration
constexpr double kLongestRatio = 100.0;     // multiple of the stated duration
constexpr double kMilli = 1000.0;

constexpr double kLeastJump = 0.1;         // fraction of the drive's range around its neutral value
constexpr double kSameStep = 0.05;         // fraction of the step
constexpr std::size_t kFewestAtFirst = 8;  // samples that must have the first value
constexpr std::size_t kAStretch = 3;       // samples over which a speed is computed
constexpr double kGetsGoing = 0.5;         // fraction of the fastest stretch

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

std::string drive_sampling_warning(const Condition& condition, const Record& record) {
  if (record.time_s.size() < 2) return {};
  const double seconds = record.time_s.back() - record.time_s.front();
  const double rate_hz = static_cast<double>(record.time_s.size() - 1) / seconds;
  if (condition.duration_s && seconds > kLongestRatio * *condition.duration_s)
    return fmt::format(
        "the record lasts {:.4g} s, where the campaign states {:.4g} s: is its time in ms?",
        seconds, *condition.duration_s);
  if (condition.duration_s && seconds < kShortestFraction * *condition.duration_s)
    return fmt::format(
        "the record lasts {:.4g} s, where the campaign states {:.4g} s: is its time in s, not in "
        "ms?",
        seconds, *condition.duration_s);
  if (condition.waveform == Waveform::recorded || !condition.frequency_hz) return {};
  const double fastest_hz =
      std::max(*condition.frequency_hz, condition.end_frequency_hz.value_or(0.0));
  const double samples = rate_hz / fastest_hz;
  if (samples < kFewestPerPeriod) {
    const bool is_in_ms = kMilli * samples >= kFewestPerPeriod && samples < 1.0;
    return fmt::format("{:.3g} samples a period of the {} of {:.4g} Hz; expected at least {:.0f}{}",
                       samples, to_string(condition.waveform), fastest_hz, kFewestPerPeriod,
                       is_in_ms ? ": is its time in ms?" : "");
  }
  const double periods = seconds * fastest_hz;
  if (periods >= kShortestFraction) return {};
  return fmt::format(
      "the record has {:.2g} of a period of the {} of {:.4g} Hz: is its time in s, not in ms?",
      periods, to_string(condition.waveform), fastest_hz);
}

std::string drive_start_proposal(const Campaign& campaign, const Condition& condition,
                                 const Record& record) {
  if (campaign.before_stated || condition.waveform != Waveform::recorded) return {};
  const Channel channel = drive_channel(campaign);
  const auto drive = record.channels.find(channel);
  const ChannelInfo& motion = info(motion_channel(campaign));
  const auto position = record.channels.find(motion.channel);
  if (drive == record.channels.end() || position == record.channels.end()) return {};
  const std::vector<double>& u = drive->second.mean;
  const std::vector<double>& x = position->second.mean;
  const bool is_loop = channel == Channel::reference || channel == Channel::angle_reference;
  const double neutral = is_loop ? x.front() : 0.0;
  double farthest = 0.0;
  for (const double value : u) farthest = std::max(farthest, std::abs(value - neutral));
  const double step = u.front() - neutral;
  if (!(std::abs(step) > kLeastJump * farthest)) return {};
  std::size_t held = 1;
  while (held < u.size() && std::abs(u[held] - u.front()) <= kSameStep * std::abs(step)) ++held;
  if (held < kFewestAtFirst) return {};
  const auto moved = [&x](std::size_t i) { return std::abs(x[i + kAStretch] - x[i]); };
  double fastest = 0.0;
  for (std::size_t i = 1; i + kAStretch < held; ++i) fastest = std::max(fastest, moved(i));
  if (!(moved(0) < kGetsGoing * fastest)) return {};
  return fmt::format(
      "the record begins at a step: the first {} is {:.3g} {}{}, and the piston has not moved yet; "
      "before = \"rest\" in [recording] states that it was {} until then, so that delay and lag of "
      "the valve act on the step",
      info(channel).key, u.front(), info(channel).unit,
      is_loop ? fmt::format(", the {} {:.3g} {}", motion.key, neutral, motion.unit) : std::string(),
      is_loop ? "where the piston was" : fmt::format("0 {}", info(channel).unit));
}

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
