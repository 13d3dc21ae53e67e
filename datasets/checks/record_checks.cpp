#include "datasets/checks/record_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

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

constexpr double kOtherDrive = 0.02;  // rms deviation, as a fraction of the larger rms

// A loop whose motion lags by half a period has a smaller slope: it would hardly be stable.
constexpr double kMirroredSlope = -0.5;
constexpr double kMirroredCorrelation = -0.7;
constexpr double kShortestBlock_s = 0.1;  // averages over what is beyond a valve and its oil spring
constexpr std::size_t kMostBlocks = 200;
constexpr std::size_t kFewestBlocks = 10;
constexpr double kLongestLag_s = 0.3;  // a pilot-operated valve and its hoses
constexpr double kLagStep_s = 0.05;    // half of the shortest block

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
  double farthest = 0.0;  ///< range or largest magnitude, whichever is larger: the piston may start
                          ///< at zero and move to a constant reference
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

/// How a signal y follows a signal x.
struct Following {
  double slope = 0.0;
  double correlation = 0.0;
};

/// @param x, y  shape (n), finite
Following following(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.empty()) return {};
  const double n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n;
  const double mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
    yy += (y[i] - mean_y) * (y[i] - mean_y);
  }
  if (!(xx > 0.0 && yy > 0.0)) return {};
  return {xy / xx, xy / std::sqrt(xx * yy)};
}

/// Leaves out the samples of bridged holes.
Following of_finite(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> x_known;
  std::vector<double> y_known;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(y[i])) continue;
    x_known.push_back(x[i]);
    y_known.push_back(y[i]);
  }
  return following(x_known, y_known);
}

/// Relates the distance travelled in each of many equal blocks of samples to the mean drive there.
/// @param lag_s  the blocks of the motion are later by this time
Following travel_by_drive(const std::vector<double>& time_s, const std::vector<double>& drive,
                          const std::vector<double>& position, double lag_s) {
  const std::size_t samples = time_s.size();
  if (samples < kFewestBlocks) return {};
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(samples - 1);
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortestBlock_s / step_s));
  const std::size_t length = std::max({shortest, samples / kMostBlocks, std::size_t{1}});
  const auto lag = static_cast<std::size_t>(std::lround(lag_s / step_s));
  std::vector<double> means;
  std::vector<double> travels;
  for (std::size_t begin = 0; begin + length + lag < samples; begin += length) {
    const auto first = drive.begin() + static_cast<std::ptrdiff_t>(begin);
    const double travel = position[begin + length + lag] - position[begin + lag];
    if (!std::isfinite(travel)) continue;  // a bridged hole
    means.push_back(std::accumulate(first, first + static_cast<std::ptrdiff_t>(length), 0.0) /
                    static_cast<double>(length));
    travels.push_back(travel);
  }
  return means.size() < kFewestBlocks ? Following{} : following(means, travels);
}

/// Whether the motion follows the drive if it lags by a time that a valve may take. A fast sine
/// that lags by half a period looks mirrored.
bool follows_with_lag(const std::vector<double>& time_s, const std::vector<double>& drive,
                      const std::vector<double>& position) {
  for (double lag_s = kLagStep_s; lag_s < kLongestLag_s + 0.5 * kLagStep_s; lag_s += kLagStep_s)
    if (travel_by_drive(time_s, drive, position, lag_s).correlation > -kMirroredCorrelation)
      return true;
  return false;
}

}  // namespace

std::vector<double> drive_at_samples(const Campaign& campaign, const Condition& condition,
                                     const Record& record) {
  const auto drive = inputs_of(campaign, condition, values_in(campaign, condition), &record).drive;
  std::vector<double> values;
  for (const double t : record.time_s) values.push_back(drive.value(t));
  return values;
}

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

std::string stated_drive_warning(const Campaign& campaign, const Condition& condition,
                                 const Record& record) {
  const ChannelInfo& channel = info(drive_channel(campaign));
  const auto recorded = record.channels.find(channel.channel);
  const auto setting = campaign.channels.find(channel.channel);
  const bool in_counts = setting != campaign.channels.end() && setting->second.in_counts;
  if (condition.waveform == Waveform::recorded || recorded == record.channels.end() || in_counts)
    return {};
  const std::vector<double>& seen = recorded->second.mean;
  const std::vector<double> stated = drive_at_samples(campaign, condition, record);
  const auto counts = [&](double t) {
    return record.windows.empty() ||
           std::any_of(record.windows.begin(), record.windows.end(), [t](const TimeWindow& window) {
             return window.start_s <= t && t <= window.end_s;
           });
  };
  double squares = 0.0, of_stated = 0.0, of_seen = 0.0, farthest = 0.0, at_s = 0.0;
  for (std::size_t i = 0; i < stated.size(); ++i) {
    if (!counts(record.time_s[i]) || !std::isfinite(seen[i])) continue;
    const double before = stated[i > 0 ? i - 1 : i];
    const double after = stated[std::min(i + 1, stated.size() - 1)];
    const double low = std::min({before, stated[i], after});
    const double high = std::max({before, stated[i], after});
    const double deviation = std::max({low - seen[i], seen[i] - high, 0.0});
    squares += deviation * deviation;
    of_stated += stated[i] * stated[i];
    of_seen += seen[i] * seen[i];
    if (deviation > farthest) {
      farthest = deviation;
      at_s = record.time_s[i];
    }
  }
  const double all = std::max(of_stated, of_seen);
  if (!(squares > kOtherDrive * kOtherDrive * all)) return {};
  return fmt::format(
      "the recorded {0} is not the {1} that the campaign states: the rms deviation is {2:.3g} % of "
      "its rms, the largest one {3:.3g} {4} at {5:.6g} s; the {1} is simulated, and waveform = "
      "\"recorded\" simulates what was recorded",
      channel.key, to_string(condition.waveform), 100.0 * std::sqrt(squares / all), farthest,
      channel.unit, at_s);
}

std::string mirrored_motion_warning(const Campaign& campaign, const Condition& condition,
                                    const Record& record) {
  const ChannelInfo& motion = info(motion_channel(campaign));
  const ChannelInfo& drive = info(drive_channel(campaign));
  const auto position = record.channels.find(motion.channel);
  const bool is_recorded = condition.waveform == Waveform::recorded;
  if (position == record.channels.end() || record.time_s.size() < 2) return {};
  if (is_recorded && !record.channels.contains(drive.channel)) return {};
  const std::vector<double>& x = position->second.mean;
  const std::vector<double> u = drive_at_samples(campaign, condition, record);
  const auto in_counts = [&](Channel channel) {
    const auto setting = campaign.channels.find(channel);
    return setting != campaign.channels.end() && setting->second.in_counts;
  };
  if (in_counts(motion.channel) || in_counts(drive.channel)) return {};
  const bool follows =
      drive.channel == Channel::reference || drive.channel == Channel::angle_reference;
  const bool opens = drive.channel == Channel::command || drive.channel == Channel::pilot_pressure;
  if (!follows && !opens) return {};
  const Following found = follows ? of_finite(u, x) : travel_by_drive(record.time_s, u, x, 0.0);
  if (!(found.correlation < kMirroredCorrelation)) return {};
  if (follows && !(found.slope < kMirroredSlope)) return {};
  if (opens && follows_with_lag(record.time_s, u, x)) return {};
  return fmt::format(
      "the {} moves against the {} (correlation {:.2f}): is the sign of one of them wrong? gain = "
      "-1 of its channel reverses it",
      motion.key, drive.key, found.correlation);
}

}  // namespace rigcal::datasets
