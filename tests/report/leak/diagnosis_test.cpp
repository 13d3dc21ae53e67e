#include "report/leak/diagnosis.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace rigcal;
using namespace rigcal::report;
using datasets::LeakClass;

namespace {

const std::string kDiagnosisHeadings =
    "condition,repeat,signal,leakage_coefficient,ci95_low,ci95_high,leak_share_percent,"
    "leak_share_ci95_low_percent,leak_share_ci95_high_percent,leak_flow_l_per_min,class,"
    "probability_normal,probability_slight,probability_medium,probability_critical,"
    "probability_supercritical,feature_mean_m,"
    "feature_rms_m,feature_std_m,class_by_features,true_class,true_share_percent,warnings\n";

StoredDiagnosis diagnosed() {
  StoredDiagnosis diagnosis;
  diagnosis.status = LeakStatus::done;
  auto& record = diagnosis.found.records.emplace_back();
  record.condition = "sine";
  record.repeat = 2;
  record.signal = "sine 1 Hz, 5 mm";
  record.explained_by_leak = true;
  record.leak.compatible_with_model = std::optional(true);
  record.leak.leakage_coefficient = 0.25;
  record.leak.ci95 = Range{0.125, 0.5};
  record.leak.leak_share_percent = 8.0;
  record.leak.leak_share_ci95_percent = Range{4.0, 16.0};
  record.leak.leak_flow_l_per_min = 1.5;
  record.leak.class_ = LeakClass::medium;
  for (auto& [name, probability] : record.leak.class_probabilities)
    probability = name == "medium" ? 0.75 : 0.0625;
  record.features = {0.001, 0.002, 0.003};
  record.class_by_features = LeakClass::normal;
  record.true_class = LeakClass::critical;
  record.true_share_percent = 9.0;
  record.warnings = {"one", "two, three"};
  return diagnosis;
}

/// Returns the field of the class in the row of the only record.
std::string class_in(const StoredDiagnosis& diagnosis) {
  std::string text = diagnosis_csv(diagnosis).substr(kDiagnosisHeadings.size());
  text.erase(0, text.find("\",") + 2);  // condition, repeat and signal
  for (int i = 0; i < 7; ++i) text.erase(0, text.find(',') + 1);
  return text.substr(0, text.find(','));
}

}  // namespace

TEST_CASE("diagnosis_csv: a row per record, warnings in one field", "[report]") {
  CHECK(diagnosis_csv(diagnosed()) ==
        kDiagnosisHeadings +
            "sine,2,\"sine 1 Hz, 5 mm\",0.25,0.125,0.5,8,4,16,1.5,medium,0.0625,0.0625,"
            "0.75,0.0625,0.0625,0.001,0.002,0.003,normal,critical,9,\"one; two, three\"\n");
}

TEST_CASE("diagnosis_csv: what is absent is an empty field", "[report]") {
  StoredDiagnosis diagnosis;
  diagnosis.status = LeakStatus::failed;
  diagnosis.reasons = {"no record", "no fit"};
  auto& record = diagnosis.found.records.emplace_back();
  record.condition = "sine";
  record.signal = "sine";
  record.is_reference = true;
  record.failure = "not simulated";
  CHECK(diagnosis_csv(diagnosis) == "# status: failed: no record; no fit\n" + kDiagnosisHeadings +
                                        "sine,,sine,,,,,,,,undecided,,,,,,,,,,,,not simulated\n");
}

TEST_CASE("diagnosis_csv: in place of a class, why there is none", "[report]") {
  StoredDiagnosis diagnosis = diagnosed();
  CHECK(class_in(diagnosis) == "medium");
  auto& record = diagnosis.found.records.front();
  record.leak.class_.reset();
  CHECK(class_in(diagnosis) == "undecided");
  record.explained_by_leak = false;
  CHECK(class_in(diagnosis) == "not explained");
  record.leak.compatible_with_model = std::optional(false);
  CHECK(class_in(diagnosis) == "incompatible");
  record.is_reference = true;
  CHECK(class_in(diagnosis) == "reference");
}

TEST_CASE("stored: a diagnosis and its leaks have their keys in place", "[report]") {
  datasets::Campaign campaign;
  campaign.name = "rig";
  diagnosis::Diagnosis found;
  diagnosis::MachineState& state = found.states.emplace_back();
  state.key.specimen = "B";
  state.leak.class_ = LeakClass::medium;
  found.records.emplace_back().failure = "too short";
  StoredDiagnosis file = stored(campaign, found, {}, {});
  CHECK(file.status == LeakStatus::failed);
  const Json json = json_of(file);
  CHECK(json["campaign"] == "rig");
  CHECK(json["states"][0]["specimen"] == "B");
  CHECK(json["states"][0]["class"] == "medium");
  CHECK(json["states"][0]["class_probabilities"]["medium"].is_null());
  CHECK_FALSE(json["states"][0].contains("share_budget"));
  CHECK_FALSE(json.contains("between_days"));
  found.records.front().failure.reset();
  CHECK(stored(campaign, found, {}, {}).status == LeakStatus::done);
  CHECK(stored(campaign, found, {"no position"}, {}).status == LeakStatus::declined);
}
