#include "datasets/checks/drive_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "datasets/campaign/campaign_sections.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kLeastJump = 0.1;         // fraction of the drive's range around its neutral value
constexpr double kSameStep = 0.05;         // fraction of the step
constexpr std::size_t kFewestAtFirst = 8;  // samples that must have the first value
constexpr std::size_t kAStretch = 3;       // samples over which a speed is computed
constexpr double kGetsGoing = 0.5;         // fraction of the fastest stretch

}  // namespace

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
      "the record begins at a step: the first {} is {:.3g} {}{}, and the piston has yet to move; "
      "before = \"rest\" in [recording] says that it was {} until then, so that a delay and a lag "
      "of the valve have something to act on",
      info(channel).key, u.front(), info(channel).unit,
      is_loop ? fmt::format(", the {} {:.3g} {}", motion.key, neutral, motion.unit) : std::string(),
      is_loop ? "where the piston was" : fmt::format("0 {}", info(channel).unit));
}

}  // namespace rigcal::datasets
