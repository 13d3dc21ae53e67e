#include "report/run/averaging.hpp"

#include "common/error.hpp"
#include "datasets/checks/short_records.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/store/csv.hpp"

namespace rigcal::report {

std::vector<datasets::Record> averaged_records(const datasets::Campaign& campaign) {
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!condition.has_record() || condition.use == datasets::Use::ignore) continue;
    records.push_back(datasets::load_record(campaign, condition));
  }
  if (records.empty()) {
    throw InputError({campaign.file.string()},
                     "no condition has a record to average; expected repeats or averaged");
  }
  std::vector<datasets::Record*> all;
  for (datasets::Record& record : records) all.push_back(&record);
  datasets::warn_of_short_records(campaign, all);
  return records;
}

std::vector<ResultFile> averaged_files(const std::vector<datasets::Record>& records) {
  std::vector<ResultFile> files;
  for (const datasets::Record& record : records) {
    files.push_back(
        {std::filesystem::path("averaged") / (record.condition + ".csv"), averaged_csv(record)});
  }
  files.push_back({"repeatability.csv", repeatability_csv(records)});
  return files;
}

}  // namespace rigcal::report
