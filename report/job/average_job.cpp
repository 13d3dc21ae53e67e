#include <filesystem>

#include "common/error.hpp"
#include "datasets/checks/short_records.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/job/job.hpp"
#include "report/store/csv.hpp"
#include "report/store/json.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored/stored_record.hpp"

namespace rigcal::report {
namespace {

bool is_averaged(const datasets::Condition& condition) {
  return condition.has_record() && condition.use != datasets::Use::ignore;
}

std::filesystem::path averaged_file(const std::string& condition) {
  return std::filesystem::path("averaged") / (condition + ".csv");
}

PlannedFiles planned_average(const datasets::Campaign& campaign) {
  PlannedFiles planned{{"average.json", "repeatability.csv", "report.html"}, {"averaged"}};
  for (const datasets::Condition& condition : campaign.conditions)
    if (is_averaged(condition)) planned.files.push_back(averaged_file(condition.id));
  return planned;
}

}  // namespace

std::vector<datasets::Record> averaged_records(const datasets::Campaign& campaign,
                                               const JobTerms& terms) {
  terms.hold(planned_average(campaign));
  std::vector<datasets::Record> records;
  for (const datasets::Condition& condition : campaign.conditions) {
    if (!is_averaged(condition)) continue;
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

JobResult average_job(const datasets::Campaign& campaign,
                      const std::vector<datasets::Record>& records, const JobTerms& terms) {
  Provenance provenance{terms.command, 1, terms.options, hash_inputs(campaign, records)};
  StoredAverage average;
  average.campaign = campaign.name;
  average.synthetic = campaign.synthetic;
  JobResult job;
  for (const datasets::Record& record : records) {
    job.files.push_back(table_file(averaged_file(record.condition), averaged_table(record)));
    average.records.push_back(stored(*campaign.find(record.condition), record));
  }
  job.files.push_back({"repeatability.csv", repeatability_csv(records)});
  average.provenance = stored(provenance);
  name_files(job.files, average.provenance);
  job.files.push_back(json_file("average.json", std::move(average)));
  job.first = {"average.json", "repeatability.csv", "averaged/"};
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace rigcal::report
