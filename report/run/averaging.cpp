#include "report/run/averaging.hpp"

#include "common/error.hpp"
#include "datasets/checks/short_records.hpp"
#include "datasets/prepare/load_record.hpp"
#include "report/run/result_page.hpp"
#include "report/store/csv.hpp"
#include "report/store/result_files.hpp"
#include "report/store/stored_provenance.hpp"

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

Json write_average(const std::filesystem::path& out, int threads,
                   const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
                   Provenance provenance) {
  provenance.inputs = hash_inputs(campaign, records);
  Json json;
  json["schema"] = "rigcal.average/1";
  json["campaign"] = campaign.name;
  json["synthetic"] = campaign.synthetic;
  json["records"] = Json::array();
  std::vector<ResultFile> files;
  for (const datasets::Record& record : records) {
    files.push_back(
        {std::filesystem::path("averaged") / (record.condition + ".csv"), averaged_csv(record)});
    json["records"].push_back(record_json(*campaign.find(record.condition), record));
  }
  files.push_back({"repeatability.csv", repeatability_csv(records)});
  json["provenance"] = json_of(stored(provenance));
  name_files(files, json);
  files.push_back({"average.json", json_text(json)});
  add_page(out, threads, files);
  write_results(out, files, provenance.inputs);
  return json;
}

}  // namespace rigcal::report
