#include "report/page/calibration/shown_part.hpp"

#include <algorithm>
#include <numeric>

namespace rigcal::report {
namespace {

/// A condition shown in full takes about 200 kB and half a printed sheet.
constexpr std::size_t kMostInFull = 40;
/// If there are more conditions than that, this many are shown in full and the others as sketches.
constexpr std::size_t kInFullOfMany = 20;
/// Number of periods that fit in a small picture.
constexpr double kPeriods = 2.0;

}  // namespace

std::vector<std::size_t> shown_in_full(const std::vector<calib::ConditionResult>& conditions) {
  std::vector<std::size_t> shown(conditions.size());
  std::iota(shown.begin(), shown.end(), 0);
  if (shown.size() <= kMostInFull) return shown;
  std::stable_sort(shown.begin(), shown.end(), [&](std::size_t a, std::size_t b) {
    return badness(conditions[b]) < badness(conditions[a]);
  });
  shown.resize(kInFullOfMany);
  std::sort(shown.begin(), shown.end());
  return shown;
}

std::size_t first_of_last_periods(const calib::ConditionResult& condition,
                                  std::span<const double> time_s) {
  const std::optional<double>& frequency = condition.frequency_hz;
  if (time_s.empty() || !frequency || !(*frequency > 0.0)) return 0;
  const double from = time_s.back() - kPeriods / *frequency;
  return static_cast<std::size_t>(std::lower_bound(time_s.begin(), time_s.end(), from) -
                                  time_s.begin());
}

std::string shown_channel(const std::vector<calib::ConditionResult>& conditions) {
  std::string first;
  for (const calib::ConditionResult& condition : conditions) {
    for (const calib::ChannelScore& score : condition.channels) {
      const std::string channel(score.key());
      if (channel == "position" || channel == "angle") return channel;
      if (first.empty()) first = channel;
    }
  }
  return first;
}

}  // namespace rigcal::report
