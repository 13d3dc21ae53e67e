#include "datasets/checks/drive_sampling.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rigcal::datasets {
namespace {

constexpr double kFewestPerPeriod = 4.0;    // samples in a period
constexpr double kShortestFraction = 0.01;  // fraction of a period, or of the stated duration
constexpr double kLongestRatio = 100.0;     // multiple of the stated duration
constexpr double kMilli = 1000.0;

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

}  // namespace rigcal::datasets
