#include "report/leak/parity.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace rigcal::report;

namespace {

const std::string kParityHeadings =
    "condition,repeat,signal,leak_level,healthy,sets_threshold,peak_m,threshold_m,alarm,"
    "time_to_alarm_s,feature_mean_m,feature_rms_m,feature_std_m,failure\n";

/// One record above the threshold of its signal.
StoredParity with_alarm() {
  StoredParity parity;
  parity.status = LeakStatus::done;
  parity.signals.resize(2);
  parity.signals[0].signal = "square";
  parity.signals[0].threshold_m = 7.0;
  parity.signals[1].signal = "sine";
  parity.signals[1].threshold_m = 0.25;
  auto& record = parity.records.emplace_back();
  record.condition = "sine_1";
  record.signal = "sine";
  record.leak_level = "33 %";
  record.peak_m = 0.5;
  record.alarm = true;
  record.time_to_alarm_s = 1.25;
  record.features = {0.001, 0.002, 0.003};
  return parity;
}

}  // namespace

TEST_CASE("parity_csv: a row per record, with the threshold of its signal", "[report]") {
  StoredParity parity = with_alarm();
  CHECK(parity_csv(parity) ==
        kParityHeadings + "sine_1,mean,sine,33 %,0,0,0.5,0.25,1,1.25,0.001,0.002,0.003,\n");
  auto& record = parity.records.front();
  record.repeat = 3;
  record.alarm = false;
  record.time_to_alarm_s.reset();
  CHECK(parity_csv(parity) ==
        kParityHeadings + "sine_1,3,sine,33 %,0,0,0.5,0.25,0,,0.001,0.002,0.003,\n");
  record.threshold_m = 0.75;  // on another day than the healthy records
  CHECK(parity_csv(parity) ==
        kParityHeadings + "sine_1,3,sine,33 %,0,0,0.5,0.75,0,,0.001,0.002,0.003,\n");
}

TEST_CASE("parity_csv: no threshold beside a record that is not judged", "[report]") {
  StoredParity parity = with_alarm();
  auto& record = parity.records.front();
  record.leak_level.reset();
  record.healthy = true;
  record.sets_threshold = true;
  record.alarm.reset();
  record.time_to_alarm_s.reset();
  CHECK(parity_csv(parity) ==
        kParityHeadings + "sine_1,mean,sine,,1,1,0.5,,,,0.001,0.002,0.003,\n");
  parity.status = LeakStatus::declined;
  parity.reasons = {"no healthy record"};
  CHECK(parity_csv(parity).starts_with("# status: declined: no healthy record\ncondition,"));
}
