#include "diagnosis/parity/parity.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <iostream>

#include "common/error.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"

using namespace rigcal;
using datasets::Campaign;
using datasets::Condition;
using diagnosis::Parity;

namespace {

int leak_row(const Campaign& campaign) {
  return model::parameter_index(campaign.rig.plant, "leakage_coefficient");
}

/// Sines of 1 Hz that last three seconds: healthy ones for the fit, healthy ones from another day,
/// and some with a leak of this coefficient.
Campaign three_conditions(double coefficient) {
  Campaign campaign =
      datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/rigs/uis_shake_table/diagnosis.toml");
  std::erase_if(campaign.conditions, [](const Condition& c) {
    return c.waveform != datasets::Waveform::sine || c.frequency_hz != 1.0;
  });
  campaign.conditions.resize(3);
  const Condition healthy = campaign.conditions[0];
  campaign.conditions[0].use = datasets::Use::fit;
  campaign.conditions[1] = healthy;
  campaign.conditions[1].id = "another_day";
  campaign.conditions[1].use = datasets::Use::validate;
  campaign.conditions[2].use = datasets::Use::diagnose;
  campaign.conditions[2].overrides = {{leak_row(campaign), coefficient}};
  for (Condition& condition : campaign.conditions) {
    condition.duration_s = 3.0;
    condition.sample_rate_hz = 250.0;
  }
  campaign.synthetic_settings->repeats = 5;
  return campaign;
}

std::vector<datasets::RepeatRecords> made(const Campaign& campaign, std::uint64_t seed) {
  const Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::RepeatRecords> records;
  for (const Condition& condition : truth.conditions) {
    std::vector<datasets::Repeat> repeats;
    for (auto& each : datasets::synthetic_repeats(truth, condition, nullptr, seed))
      repeats.push_back(std::move(each.record));
    records.push_back(datasets::repeat_records(campaign, *campaign.find(condition.id), repeats));
  }
  return records;
}

diagnosis::RigFit true_rig(const Campaign& campaign) {
  diagnosis::RigFit rig;
  for (const auto& [index, value] : campaign.synthetic_settings->parameters)
    rig.values.push_back({index, datasets::Scope::rig, "", value});
  return rig;
}

struct AlarmCounts {
  int alarms = 0;
  int records = 0;
  int with_cause = 0;  ///< number of campaigns whose repeats are found to have a common cause
};

/// Counts the alarms of healthy records in campaigns whose repeats all differ in their supply
/// pressure in the same way.
AlarmCounts alarms_of_healthy(double rate, double supply_sd, std::uint64_t first, int campaigns) {
  Campaign campaign = three_conditions(0.1);
  campaign.conditions.resize(2);
  const int supply = model::parameter_index(campaign.rig.plant, "supply_pressure");
  if (supply_sd > 0.0) campaign.synthetic_settings->variation[supply] = supply_sd;
  diagnosis::ParityOptions options;
  options.false_alarm = rate;
  options.threads = 2;
  AlarmCounts counts;
  for (int i = 0; i < campaigns; ++i) {
    const auto records = made(campaign, first + static_cast<std::uint64_t>(i));
    const auto found = diagnosis::parity(campaign, records, true_rig(campaign), options);
    counts.alarms += found.check.alarms;
    counts.records += found.check.records;
    counts.with_cause += found.signals.front().common_causes.value() > 0 ? 1 : 0;
  }
  return counts;
}

}  // namespace

TEST_CASE("parity: a leak raises an alarm within a period, healthy records do not", "[diagnosis]") {
  const Campaign campaign = three_conditions(0.1);
  const auto records = made(campaign, 1);
  const Parity found = diagnosis::parity(campaign, records, true_rig(campaign), {});
  REQUIRE(found.conditions.size() == 3);
  REQUIRE(found.signals.size() == 1);
  const diagnosis::ParitySignal& signal = found.signals.front();
  CHECK(signal.healthy_records == 5);
  CHECK(signal.window_s == 1.0);
  REQUIRE(signal.threshold_m);
  // White noise of 0.05 mm minus the mean of five other records. The threshold is for the largest
  // of several windows.
  CHECK(*signal.threshold_m > 0.05e-3 * std::sqrt(1.2));
  CHECK(*signal.threshold_m < 0.07e-3);
  for (const auto& condition : found.conditions) {
    CHECK(condition.model_m.size() == condition.time_s.size());
    for (const auto& record : condition.records) {
      CAPTURE(record.condition, *record.repeat);
      REQUIRE_FALSE(record.failure);
      CHECK(record.healthy == (condition.condition != found.conditions[2].condition));
      CHECK(record.sets_threshold == (&condition == &found.conditions[0]));
      CHECK(record.reference_records == (record.sets_threshold ? 4 : 5));
      CHECK(record.alarm.has_value() != record.sets_threshold);
      CHECK(record.alarm.value_or(false) == !record.healthy);
      if (record.healthy) continue;
      CHECK(record.peak_m > signal.threshold_m);
      CHECK(record.time_to_alarm_s.value() > 0.0);
      CHECK(*record.time_to_alarm_s < 1.2);
      CHECK(record.features.rms_m > signal.feature_thresholds.rms_m);
      CHECK(record.exceeds.rms_m == true);
    }
  }
  CHECK(found.check.records == 5);
  CHECK(found.check.alarms == 0);
}

TEST_CASE("parity: what the model lacks is taken off", "[diagnosis]") {
  Campaign campaign = three_conditions(0.1);
  const int friction = model::parameter_index(campaign.rig.plant, "coulomb_friction");
  campaign.synthetic_settings->parameters.emplace_back(friction, 600.0);
  const auto records = made(campaign, 2);
  campaign.synthetic_settings->parameters.pop_back();
  const Parity found = diagnosis::parity(campaign, records, true_rig(campaign), {});
  const auto& healthy = found.conditions[1].records.front();
  double squares = 0.0;
  for (const double value : healthy.parity_m) squares += value * value;
  const double parity_rms = std::sqrt(squares / static_cast<double>(healthy.parity_m.size()));
  CHECK(parity_rms > 3.0 * healthy.features.rms_m.value());
  CHECK(healthy.alarm == false);
  CHECK(found.conditions[2].records.front().alarm == true);
}

TEST_CASE("parity: false alarms on another day are as many as stated", "[diagnosis][long]") {
  Campaign campaign = three_conditions(0.1);
  campaign.conditions.resize(2);
  diagnosis::ParityOptions options;
  options.false_alarm = 0.1;
  options.threads = 2;
  int alarms = 0;
  int records = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const auto found =
        diagnosis::parity(campaign, made(campaign, seed), true_rig(campaign), options);
    alarms += found.check.alarms;
    records += found.check.records;
  }
  CAPTURE(alarms);
  CHECK(records == 300);
  // Five records share one threshold, so their alarms vary more than those of 300 independent
  // records. The limits of 0.1 +- 0.05 are three standard errors away.
  CHECK(alarms > 15);
  CHECK(alarms < 45);
}

TEST_CASE("parity: the stated rate holds where repeats differ by their supply",
          "[diagnosis][long]") {
  const AlarmCounts found = alarms_of_healthy(0.05, 0.02, 1, 60);
  CAPTURE(found.alarms, found.with_cause);
  CHECK(found.records == 300);
  // The limits of 0.05 +- 0.033 are two standard errors away, if each campaign has one threshold.
  CHECK(found.alarms > 4);
  CHECK(found.alarms < 26);
  CHECK(found.with_cause > 50);
}

// Prints the table in docs/parity.md; run with diagnosis_tests "[parity-study]".
TEST_CASE("parity: alarms at stated rates, printed", "[.parity-study]") {
  for (const double supply_sd : {0.0, 0.005, 0.02}) {
    for (const double rate : {0.01, 0.05}) {
      const AlarmCounts found = alarms_of_healthy(rate, supply_sd, 7001, 200);
      std::cout << "| " << 100.0 * supply_sd << " | " << 100.0 * rate << " | " << found.alarms
                << " of " << found.records << " | " << found.with_cause << " of 200 |\n";
    }
  }
}

TEST_CASE("parity: a record of another day has a threshold of its own", "[diagnosis]") {
  Campaign campaign = three_conditions(0.1);
  Campaign lower = campaign;
  lower.synthetic_settings->parameters.emplace_back(
      model::parameter_index(campaign.rig.plant, "supply_pressure"), 0.99 * 6.2e6);
  auto records = made(campaign, 1);
  records[1] = made(lower, 1)[1];
  const auto alarms_of = [](const Parity& found) {
    int alarms = 0;
    for (const auto& record : found.conditions[1].records) alarms += record.alarm == true ? 1 : 0;
    return alarms;
  };
  const Parity same = diagnosis::parity(campaign, records, true_rig(campaign), {});
  CHECK(alarms_of(same) == 5);
  CHECK(same.between_days.other_days.empty());
  campaign.conditions[1].date = "2026-03-01";
  const Parity other = diagnosis::parity(campaign, records, true_rig(campaign), {});
  CHECK(alarms_of(other) == 0);
  CHECK(other.between_days.other_days == std::vector<std::string>{"2026-03-01"});
  CHECK_FALSE(other.warnings.empty());
  const auto& signal = other.signals.front();
  CHECK(signal.threshold_m == same.signals.front().threshold_m);
  REQUIRE(signal.threshold_of_another_day_m);
  CHECK(*signal.threshold_of_another_day_m > 1.5 * *signal.threshold_m);
  CHECK(*other.conditions[1].records.front().threshold_m == *signal.threshold_of_another_day_m);
  // Without a date, it is treated as recorded on the day of the healthy records, with a warning.
  campaign.conditions[1].date.reset();
  const Parity undated = diagnosis::parity(campaign, records, true_rig(campaign), {});
  CHECK(alarms_of(undated) == 5);
  REQUIRE(undated.warnings.size() == 1);
  CHECK(undated.warnings.front().find("no date: another_day") == 0);
}

TEST_CASE("parity: a record less the others' mean, sample by sample", "[diagnosis]") {
  const Campaign campaign = three_conditions(0.1);
  const Parity found = diagnosis::parity(campaign, made(campaign, 3), true_rig(campaign), {});
  const auto& references = found.conditions[0].records;
  const auto& record = found.conditions[1].records.front();
  for (std::size_t i = 0; i < record.residual_m.size(); ++i) {
    double sum = 0.0;
    for (const auto& each : references) sum += each.parity_m[i];
    CHECK(std::abs(record.residual_m[i] - (record.parity_m[i] - sum / 5.0)) < 1e-15);
  }
}

TEST_CASE("parity: samples outside of the windows do not count", "[diagnosis]") {
  const Campaign campaign = three_conditions(0.1);
  auto records = made(campaign, 1);
  records[2].average.windows = {{1.0, 2.0}};
  const Parity found = diagnosis::parity(campaign, records, true_rig(campaign), {});
  const auto& leaking = found.conditions[2];
  for (std::size_t i = 0; i < leaking.time_s.size(); ++i) {
    const bool within = leaking.time_s[i] >= 1.0 && leaking.time_s[i] <= 2.0;
    CHECK(std::isnan(leaking.records.front().residual_m[i]) != within);
  }
}

TEST_CASE("parity: the time to an alarm begins with the recording", "[diagnosis]") {
  const Campaign campaign = three_conditions(0.1);
  auto records = made(campaign, 1);
  const double first = diagnosis::parity(campaign, records, true_rig(campaign), {})
                           .conditions[2]
                           .records[0]
                           .time_to_alarm_s.value();
  for (auto& each : records) {  // ten whole periods later
    for (double& t : each.average.time_s) t += 10.0;
    for (auto& single : each.singles)
      for (double& t : single.time_s) t += 10.0;
    for (auto& window : each.covered) window = {window.start_s + 10.0, window.end_s + 10.0};
  }
  const auto late = diagnosis::parity(campaign, records, true_rig(campaign), {});
  CHECK(std::abs(late.conditions[2].records[0].time_to_alarm_s.value() - first) < 0.01);
}

TEST_CASE("parity: how probable as many false alarms are", "[diagnosis]") {
  const Campaign campaign = three_conditions(0.1);
  Campaign leaks_later = campaign;
  leaks_later.conditions[1].overrides = {{leak_row(campaign), 0.1}};
  const auto found = diagnosis::parity(campaign, made(leaks_later, 1), true_rig(campaign), {});
  CHECK(found.check.alarms == 5);
  // Five alarms out of five, at 1 % each.
  CHECK(std::abs(found.check.p_value.value() - 1e-10) < 1e-12);
}

TEST_CASE("parity: without enough healthy records nothing is judged, and why", "[diagnosis]") {
  Campaign campaign = three_conditions(0.1);
  campaign.conditions.erase(campaign.conditions.begin(), campaign.conditions.begin() + 2);
  const auto records = made(campaign, 1);
  const Parity found = diagnosis::parity(campaign, records, true_rig(campaign), {});
  CHECK(found.usable());
  CHECK_FALSE(found.signals.front().threshold_m);
  CHECK_THAT(found.signals.front().reason.value(),
             Catch::Contains("0 healthy records of this signal"));
  CHECK_FALSE(found.conditions.front().records.front().alarm.has_value());
  CHECK(found.conditions.front().records.front().peak_m.value() > 0.0);
  // If it is declared healthy, it is its own reference.
  campaign.diagnosis.level_class[*campaign.conditions.front().leak_level] =
      datasets::LeakClass::normal;
  CHECK(diagnosis::parity(campaign, records, true_rig(campaign), {})
            .signals.front()
            .threshold_m.has_value());
}
