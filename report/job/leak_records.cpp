#include "report/job/leak_records.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "common/suggest.hpp"
#include "datasets/checks/short_records.hpp"
#include "diagnosis/diagnose.hpp"

namespace rigcal::report {

std::vector<datasets::Record> LeakRecords::averages() const {
  std::vector<datasets::Record> result;
  for (const datasets::RepeatRecords& each : conditions) result.push_back(each.average);
  return result;
}

LeakRecords load_leak_records(const datasets::Campaign& campaign, int threads) {
  const diagnosis::Diagnosable diagnosable = diagnosis::diagnosable(campaign);
  LeakRecords records;
  records.left_out = diagnosable.left_out;
  records.conditions.resize(diagnosable.conditions.size());
  parallel_for(records.conditions.size(), threads, [&](std::size_t i) {
    records.conditions[i] = datasets::load_repeats(campaign, *diagnosable.conditions[i]);
  });
  std::vector<datasets::Record*> loaded;
  for (datasets::RepeatRecords& each : records.conditions) loaded.push_back(&each.average);
  datasets::warn_of_short_records(campaign, loaded);
  return records;
}

std::vector<datasets::RecordWarning> gathered_doubts(
    const std::vector<datasets::Record>& averages) {
  std::vector<const datasets::Record*> doubted;
  for (const datasets::Record& each : averages) doubted.push_back(&each);
  return datasets::gathered_warnings(doubted);
}

void take_healthy(const std::vector<std::string>& levels, datasets::Campaign& campaign) {
  std::vector<std::string> known;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (condition.leak_level &&
        std::find(known.begin(), known.end(), *condition.leak_level) == known.end())
      known.push_back(*condition.leak_level);
  }
  for (const std::string& level : levels) {
    if (std::find(known.begin(), known.end(), level) == known.end())
      throw UsageError("--healthy: " + unknown_name_message("leak level", level, known));
    const auto [entry, is_new] =
        campaign.diagnosis.level_class.emplace(level, datasets::LeakClass::normal);
    if (!is_new && entry->second != datasets::LeakClass::normal)
      throw UsageError(fmt::format("--healthy: level_class in [diagnosis] says that \"{}\" is {}",
                                   level, to_string(entry->second)));
  }
}

}  // namespace rigcal::report
