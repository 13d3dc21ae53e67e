#include "diagnosis/class_limits.hpp"

#include <fmt/format.h>

#include "common/error.hpp"
#include "diagnosis/record/signal_name.hpp"
#include "diagnosis/record/stated_leak.hpp"

namespace rigcal::diagnosis {
namespace {

/// Describes the signal of a drive in a leak table: "sine 0.1 Hz, 50.8 mm".
std::string drive_name(const datasets::Campaign& campaign, const LeakDrive& drive) {
  datasets::Condition condition;
  condition.waveform = drive.waveform;
  condition.frequency_hz = drive.frequency_hz;
  condition.amplitude = drive.amplitude();
  return signal_name(campaign, condition);
}

std::optional<LeakClass> class_ending_at(const datasets::DiagnosisSettings& settings,
                                         double target_percent) {
  for (std::size_t i = 0; i < settings.limits.size(); ++i) {
    if (settings.limits[i] == target_percent / kInPercent) return datasets::kLeakClasses[i];
  }
  return std::nullopt;
}

}  // namespace

StatedSettings stated(const datasets::DiagnosisSettings& settings) {
  StatedSettings result{
      {}, settings.least_probability, settings.false_alarms, settings.detection, {}};
  if (settings.leak_law != datasets::LeakLaw::orifice) result.leak_law = settings.leak_law;
  for (std::size_t i = 0; i < settings.limits.size(); ++i) {
    result.limits_percent.emplace_back(to_string(datasets::kLeakClasses[i]),
                                       kInPercent * settings.limits[i]);
  }
  return result;
}

void take_limits(datasets::DiagnosisSettings& settings, const std::vector<double>& targets_percent,
                 const std::string& file) {
  constexpr std::size_t kFewest = 3;
  const std::size_t rows = targets_percent.size();
  const std::size_t most = datasets::kLeakClasses.size();
  if (rows < kFewest || rows > most) {
    throw InputError({file},
                     fmt::format("the table has {} rows: expected the limits of slight, "
                                 "medium and critical, such as --targets 10,20,30, or five that "
                                 "begin with the limit of normal and end beyond critical",
                                 rows));
  }
  const std::size_t first = rows == most ? 0 : 1;
  for (std::size_t i = first; i < settings.limits.size(); ++i)
    settings.limits[i] = targets_percent[i - first] / kInPercent;
  if (!(settings.limits[0] < settings.limits[1])) {
    throw InputError(
        {file},
        fmt::format("the first of {} rows, {:g} %, would be the limit of slight, but normal "
                    "ends at {:g} %: expected five rows where the first is the limit of "
                    "normal, or another limits_percent of normal in [diagnosis]",
                    rows, targets_percent.front(), kInPercent * settings.limits[0]));
  }
}

std::vector<ClassLimit> class_limits(const datasets::Campaign& campaign,
                                     const std::vector<LeakEntry>& entries) {
  std::vector<ClassLimit> limits;
  for (const LeakEntry& entry : entries) {
    limits.push_back({drive_name(campaign, entry.drive), entry.target_percent,
                      class_ending_at(campaign.diagnosis, entry.target_percent), entry.coefficients,
                      entry.coefficients_ci95});
  }
  return limits;
}

}  // namespace rigcal::diagnosis
