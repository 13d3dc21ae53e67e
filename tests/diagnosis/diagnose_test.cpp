#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "datasets/prepare/single_repeats.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "diagnosis/table/leak_table.hpp"
#include "metrics/distributions.hpp"

using namespace rigcal;
using datasets::Campaign;
using datasets::Condition;
using datasets::LeakClass;
using diagnosis::Diagnosis;

namespace {

int row_of(const Campaign& campaign, const char* key) {
  return model::parameter_index(campaign.rig.plant, key);
}

/// The paper's campaign with one signal, few samples, and coefficients for 0, 5, 15 and 25 %.
Campaign small_campaign() {
  Campaign campaign =
      datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/rigs/uis_shake_table/diagnosis.toml");
  std::erase_if(campaign.conditions, [](const Condition& c) {
    return c.waveform != datasets::Waveform::sine || c.frequency_hz != 1.0;
  });
  // Shares refer to the last whole periods. The test checks only the class, far from its limits.
  const std::vector<double> coefficients{0.0, 0.116, 0.395, 0.71};
  for (std::size_t i = 0; i < campaign.conditions.size(); ++i) {
    Condition& condition = campaign.conditions[i];
    condition.duration_s = 3.0;
    condition.sample_rate_hz = 250.0;
    condition.overrides = {{row_of(campaign, "leakage_coefficient"), coefficients.at(i)}};
  }
  campaign.synthetic_settings->repeats = 3;
  return campaign;
}

void set_true(Campaign& campaign, const char* key, double value) {
  campaign.synthetic_settings->parameters.emplace_back(row_of(campaign, key), value);
}

std::vector<datasets::RepeatRecords> records_of(const Campaign& campaign, std::uint64_t seed = 1,
                                                std::size_t most_samples = 1000) {
  const Campaign truth = datasets::true_campaign(campaign);
  std::vector<datasets::RepeatRecords> records;
  for (std::size_t i = 0; i < campaign.conditions.size(); ++i) {
    std::vector<datasets::Repeat> repeats;
    for (auto& each : datasets::synthetic_repeats(truth, truth.conditions[i], nullptr, seed)) {
      datasets::Repeat& repeat = repeats.emplace_back(std::move(each.record));
      if (repeat.time_s.size() <= most_samples) continue;
      repeat.time_s.resize(most_samples);
      for (auto& [channel, values] : repeat.values) values.resize(most_samples);
    }
    records.push_back(datasets::repeat_records(campaign, campaign.conditions[i], repeats));
  }
  return records;
}

/// Rig with the values from [synthetic] in the file.
diagnosis::RigFit known_rig(const Campaign& campaign) {
  diagnosis::RigFit rig;
  for (const auto& [index, value] : campaign.synthetic_settings->parameters)
    rig.values.push_back({index, datasets::Scope::rig, "", value});
  return rig;
}

/// Returns the errors of the only signal, whose healthy records correct all records.
diagnosis::SignalErrors errors_of(const Diagnosis& found) {
  std::map<std::string, std::vector<diagnosis::SingleFit>> by_condition;
  std::vector<const diagnosis::LeakFit*> healthy, averages;
  for (const diagnosis::RecordDiagnosis& each : found.records) {
    if (each.repeat) {
      by_condition[each.condition].push_back(
          {&each.fit, each.corrects_others ? each.reference_repeats : 0});
    } else {
      (each.is_reference ? healthy : averages).push_back(&each.fit);
    }
  }
  std::vector<std::vector<diagnosis::SingleFit>> singles;
  for (const auto& [condition, fits] : by_condition) singles.push_back(fits);
  diagnosis::SignalErrors errors = diagnosis::signal_errors(singles, healthy, averages);
  diagnosis::separate_noise({&errors});
  return errors;
}

}  // namespace

TEST_CASE("diagnose: every repeat and average in its class, by the true shares", "[diagnosis]") {
  const Campaign campaign = small_campaign();
  const auto records = records_of(campaign);
  diagnosis::DiagnosisOptions options;
  options.threads = 2;
  options.truth.emplace();
  for (const auto& [index, value] : campaign.synthetic_settings->parameters)
    options.truth->push_back({index, datasets::Scope::rig, "", value});
  for (const Condition& condition : campaign.conditions)
    options.truth->push_back({row_of(campaign, "leakage_coefficient"), datasets::Scope::condition,
                              condition.id, condition.overrides.front().second});
  const Diagnosis found = diagnosis::diagnose(campaign, records, known_rig(campaign), options);
  CHECK(found.usable());
  CHECK(found.records.size() == 16);
  CHECK(found.methods.fitted_leak_single.records == 12);
  CHECK(found.methods.fitted_leak_single.right == 12);
  CHECK(found.methods.fitted_leak_averaged.records ==
        3);  // the healthy average is the reference for the others
  CHECK(found.methods.fitted_leak_averaged.right == 3);
  for (const auto& record : found.records) {
    CAPTURE(record.condition, record.repeat.value_or(0));
    REQUIRE(record.fit.ok());
    REQUIRE(record.true_share_percent);
    CHECK_FALSE(record.failure);
    CHECK(record.parity_rms_m == record.fit.parity_rms_m);
    // Noise of 0.05 mm on 750 samples leaves the share uncertain by less than a percentage point.
    CHECK(std::abs(100.0 * record.estimate.share - *record.true_share_percent) < 1.0);
    CHECK(record.is_reference == (!record.repeat && record.true_class == LeakClass::normal));
    CHECK(record.leak.class_.has_value() == !record.is_reference);
    CHECK(record.leak.leak_share_percent.has_value() == !record.is_reference);
    CHECK(record.explained_by_leak.has_value() == !record.is_reference);
    CHECK_FALSE(record.undecided);
  }
  CHECK(found.accuracy == found.methods.fitted_leak_single.accuracy);
  REQUIRE(found.smallest_leak_l_per_min.size() == 1);
  const diagnosis::SmallestLeak& smallest = found.smallest_leak_l_per_min.front();
  REQUIRE(smallest.averaged);
  CHECK(smallest.averaged_share_percent.value() > 0.0);
  CHECK(smallest.averaged_share_percent.value() < 2.0);
  CHECK(smallest.repeats_averaged == 3);
  // The error for a mean of three is that of one repeat times sqrt(1/3 + 1/3) / sqrt(1 + 1/2). Its
  // limit is therefore lower than that of a repeat, but of the same order. An average minus itself
  // would have no error.
  REQUIRE(smallest.single);
  CHECK(*smallest.averaged > 0.2 * *smallest.single);
  CHECK(*smallest.averaged < 1.2 * *smallest.single);
  // The variation between repeats, noise included, is all that gives the error of the reference.
  const auto reference = std::find_if(found.records.begin(), found.records.end(),
                                      [](const auto& each) { return each.is_reference; });
  REQUIRE(reference != found.records.end());
  const auto scatter = diagnosis::error_of_averages(reference->fit, errors_of(found), 3, 3);
  REQUIRE(scatter);
  CHECK_THAT(reference->smallest_leak.value().coefficient,
             Catch::WithinRel(diagnosis::detection_limit(*scatter, campaign.diagnosis), 1e-9));

  options.threads = 1;
  const Diagnosis again = diagnosis::diagnose(campaign, records, known_rig(campaign), options);
  for (std::size_t i = 0; i < found.records.size(); ++i) {
    CHECK(again.records[i].fit.coefficient == found.records[i].fit.coefficient);
    CHECK(again.records[i].estimate.probability == found.records[i].estimate.probability);
  }
}

TEST_CASE("diagnose: a record that stays undecided counts as one that is not right",
          "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions.resize(1);
  campaign.diagnosis.least_probability = 1.0 + 1e-9;
  const Diagnosis found =
      diagnosis::diagnose(campaign, records_of(campaign), known_rig(campaign), {});
  CHECK(found.methods.fitted_leak_single.records == 3);
  CHECK(found.methods.fitted_leak_single.undecided == 3);
  CHECK(found.methods.fitted_leak_single.right == 0);
}

TEST_CASE("diagnose: a coefficient of the leak table has the table's share", "[diagnosis]") {
  // The record has two periods from rest. The first is a transient, so the share in the record
  // would differ.
  for (const auto waveform : {datasets::Waveform::sine, datasets::Waveform::square}) {
    Campaign campaign =
        datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/rigs/uis_shake_table/diagnosis.toml");
    std::erase_if(campaign.conditions, [&](const Condition& c) {
      return c.waveform != waveform || c.frequency_hz != 0.1 ||
             (c.leak_level != "0 %" && c.leak_level != "66.66 %");
    });
    REQUIRE(campaign.conditions.size() == 2);
    datasets::LeakTableSettings table;
    table.signals.resize(1);
    table.signals[0].waveform = waveform;
    table.signals[0].frequency_hz = 0.1;
    table.signals[0].amplitude = *campaign.conditions[0].amplitude;
    table.targets_percent = {10.0};
    const auto entry =
        diagnosis::leak_table(datasets::true_campaign(campaign), table, {}).entries.at(0);
    REQUIRE(entry.coefficients.size() == 1);
    for (Condition& condition : campaign.conditions) condition.sample_rate_hz = 100.0;
    campaign.conditions[1].overrides = {
        {row_of(campaign, "leakage_coefficient"), entry.coefficients[0]}};
    campaign.synthetic_settings->repeats = 3;
    diagnosis::DiagnosisOptions options;
    options.truth.emplace();
    for (const auto& [index, value] : campaign.synthetic_settings->parameters)
      options.truth->push_back({index, datasets::Scope::rig, "", value});
    options.truth->push_back({row_of(campaign, "leakage_coefficient"), datasets::Scope::condition,
                              campaign.conditions[1].id, entry.coefficients[0]});
    const auto found =
        diagnosis::diagnose(campaign, records_of(campaign, 1, 3000), known_rig(campaign), options);
    const auto& average = found.records.at(4);
    REQUIRE(average.condition == campaign.conditions[1].id);
    REQUIRE(average.fit.ok());
    CHECK(std::abs(*average.true_share_percent - 10.0) < 2e-3);  // tolerance of the table
    CAPTURE(average.estimate.share, average.estimate.share_ci95.low,
            average.estimate.share_ci95.high);
    CHECK(average.estimate.share_ci95.low < 0.10);
    CHECK(average.estimate.share_ci95.high > 0.10);
    CHECK(average.estimate.share_ci95.high - average.estimate.share_ci95.low < 0.01);
  }
}

TEST_CASE("diagnose: what healthy records lack too is no leak", "[diagnosis]") {
  const Campaign campaign = small_campaign();
  Campaign disturbed = campaign;
  set_true(disturbed, "valve_time_constant", 3e-3);
  disturbed.synthetic_settings->variation[row_of(campaign, "supply_pressure")] = 0.005;
  const Diagnosis found =
      diagnosis::diagnose(campaign, records_of(disturbed), known_rig(campaign), {});
  CHECK(found.methods.fitted_leak_single.right >= 11);
  CHECK(found.methods.fitted_leak_single.off_by_two_or_more == 0);
  for (const auto& record : found.records)
    CHECK(record.reference_repeats ==
          (record.true_class == LeakClass::normal && record.repeat ? 2 : 3));
}

TEST_CASE("diagnose: a supply half a percent lower on another day is no leak", "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions.resize(2);
  campaign.conditions[1].overrides.front().second = 0.0;
  Campaign lower = campaign;
  set_true(lower, "supply_pressure", 0.995 * 6.2e6);
  auto records = records_of(campaign);
  records[1] = records_of(lower)[1];
  const auto diagnosed = [&] {
    auto found = diagnosis::diagnose(campaign, records, known_rig(campaign), {});
    REQUIRE(found.records.at(4).condition == campaign.conditions[1].id);
    REQUIRE(found.records.at(4).fit.ok());
    return found;
  };
  // If both are from one day, as their dates say, the lower supply pressure is mistaken for a leak.
  const Diagnosis same = diagnosed();
  CHECK(same.records.at(4).estimate.leak_detected);
  CHECK(same.between_days->other_days.empty());
  CHECK_FALSE(same.between_days->sentence);
  CHECK_FALSE(same.smallest_leak_l_per_min.front().of_another_day);

  campaign.conditions[1].date = "2026-03-01";
  const Diagnosis other = diagnosed();
  CHECK_FALSE(other.records.at(4).estimate.leak_detected);
  CHECK_FALSE(other.records.at(4).estimate.incompatible);
  CHECK(other.records.at(4).estimate.ci95.low == 0.0);
  CHECK(other.between_days->other_days == std::vector<std::string>{"2026-03-01"});
  CHECK(other.warnings.front().find("2026-03-01") != std::string::npos);
  CHECK(std::count(other.warnings.begin(), other.warnings.end(),
                   other.between_days->sentence.value()) == 1);
  CHECK(other.states.at(1).ok());
  CHECK_FALSE(other.states.at(1).estimate.leak_detected);
  CHECK(other.states.at(1).pooled.error.days_se > 0.0);
  const auto& limits = other.smallest_leak_l_per_min.front();
  CHECK(limits.of_another_day == true);
  REQUIRE(limits.averaged_same_day);
  CHECK_THAT(*limits.averaged_same_day,
             Catch::WithinRel(same.smallest_leak_l_per_min.front().averaged.value(), 1e-6));
  CHECK(limits.averaged.value() > 1.9 * *limits.averaged_same_day);
  // The budgets of records and states add up to the errors, and the day has a line.
  const auto check = [](const diagnosis::LeakEstimate& estimate) {
    for (const auto* budget : {&estimate.budget, &estimate.share_budget}) {
      double squares = 0.0;
      for (const auto& line : budget->lines) squares += line.uncertainty * line.uncertainty;
      CHECK_THAT(std::sqrt(squares), Catch::WithinRel(budget->combined, 1e-9));
      CHECK(budget->contribution("days") > 0.0);
      CHECK(budget->contribution("records") > 0.0);
    }
    CHECK(estimate.budget.combined == estimate.standard_error);
    CHECK(estimate.budget.degrees_of_freedom == estimate.freedom);
  };
  check(other.records.at(4).estimate);
  check(other.states.at(1).estimate);
  CHECK(other.states.at(1).estimate.budget.lines.front().source == campaign.conditions[1].id);
  CHECK(same.records.at(4).estimate.budget.contribution("days") == 0.0);
  // The day affects the share, too.
  CHECK(other.records.at(4).estimate.share_ci95.high > same.records.at(4).estimate.share_ci95.high);

  // Without a date, the record may be from another day.
  campaign.conditions[1].date.reset();
  CHECK_FALSE(diagnosed().records.at(4).estimate.leak_detected);
  campaign.conditions[1].date = "2026-03-01";
  campaign.between_days.none = true;
  CHECK(diagnosed().records.at(4).estimate.leak_detected);
}

TEST_CASE("diagnose: over many days alarms are as stated, and the smallest leak is found",
          "[diagnosis][long]") {
  // A small version of bench/days_study.cpp. The supplies are quantiles of the difference between
  // two days, one of which is the day of the reference.
  constexpr int kDays = 20;
  Campaign campaign = small_campaign();
  campaign.conditions.resize(1);
  const Condition healthy = campaign.conditions.front();
  campaign.between_days.sizes["supply_pressure"] = 31e3;
  campaign.between_days.left_out = {"bulk_modulus", "position_offset", datasets::kTriggerKey};
  const auto reference = records_of(campaign);
  const auto diagnosed = [&](double coefficient) {
    campaign.conditions.resize(1);
    auto records = reference;
    for (int i = 0; i < kDays; ++i) {
      Condition& condition = campaign.conditions.emplace_back(healthy);
      condition.id = fmt::format("day_{}", i);
      condition.date = fmt::format("2026-03-{:02d}", i + 1);
      condition.leak_level = "unknown";
      condition.use = datasets::Use::diagnose;
      condition.overrides = {{row_of(campaign, "leakage_coefficient"), coefficient}};
      Campaign truth = campaign;
      truth.conditions = {condition};
      set_true(truth, "supply_pressure",
               6.2e6 + std::sqrt(2.0) * 31e3 * metrics::normal_quantile((i + 0.5) / kDays));
      records.push_back(records_of(truth, 100 + static_cast<std::uint64_t>(i)).front());
      records.back().singles.clear();
      records.back().covered.clear();
    }
    campaign.leak_levels["unknown"] = {};
    return diagnosis::diagnose(campaign, records, known_rig(campaign), {});
  };
  const auto alarms_of = [](const Diagnosis& found) {
    int alarms = 0;
    for (const auto& record : found.records)
      alarms += record.condition.starts_with("day_") && record.estimate.leak_detected ? 1 : 0;
    return alarms;
  };
  const Diagnosis none = diagnosed(0.0);
  CHECK(alarms_of(none) <= 1);
  for (const auto& record : none.records) CHECK_FALSE(record.estimate.incompatible);
  REQUIRE(none.records.front().is_reference);
  const double limit = none.records.front().smallest_leak_of_another_day.value().coefficient;
  CHECK(alarms_of(diagnosed(limit)) >= 18);
  // The variation between days determines the limit, so half of this leak is often missed.
  CHECK(alarms_of(diagnosed(0.5 * limit)) < 17);
  campaign.between_days = {};
  campaign.between_days.none = true;
  CHECK(alarms_of(diagnosed(0.0)) > 5);
}

TEST_CASE("diagnose: healthy records of many dates tell how days differ", "[diagnosis]") {
  Campaign campaign = small_campaign();
  const Condition healthy = campaign.conditions.front();
  campaign.conditions.clear();
  std::vector<datasets::RepeatRecords> records;
  const std::vector<double> supplies{1.0, 1.011, 0.99, 1.008, 0.992};
  Campaign truth = campaign;
  for (std::size_t i = 0; i < supplies.size(); ++i) {
    Condition& condition = campaign.conditions.emplace_back(healthy);
    condition.id = fmt::format("day_{}", i);
    condition.date = fmt::format("2026-03-{:02d}", i + 1);
    truth.conditions = {condition};
    set_true(truth, "supply_pressure", supplies[i] * 6.2e6);
    records.push_back(records_of(truth, i + 1).front());
    truth.synthetic_settings->parameters.pop_back();
  }
  const Diagnosis found = diagnosis::diagnose(campaign, records, known_rig(campaign), {});
  REQUIRE(found.between_days);
  CHECK(found.between_days->source == diagnosis::DaySource::estimated);
  CHECK(found.between_days->healthy_dates == 5);
  CHECK(found.between_days->freedom == 4.0);
  // The supplies vary by 1 % (standard deviation), twice the usual size.
  CHECK(found.between_days->factor > 1.0);
  CHECK(found.between_days->factor < 4.0);
}

TEST_CASE("diagnose: another fault is not called a leak", "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions.resize(2);
  campaign.conditions[1].overrides.front().second = 0.0;
  const auto healthy = records_of(campaign);
  const auto found_with = [&](const char* key, double value) {
    Campaign worn = campaign;
    set_true(worn, key, value);
    auto records = records_of(worn);
    records[0] = healthy[0];
    auto found = diagnosis::diagnose(campaign, records, known_rig(campaign), {}).records;
    std::erase_if(found,
                  [&](const auto& each) { return each.condition == campaign.conditions[0].id; });
    return found;
  };
  for (const auto& record : found_with("position_offset", 2e-3)) {  // a sensor that has slipped
    CAPTURE(record.fit.parity_rms_m, record.fit.misfit_rms_m, record.estimate.share);
    CHECK(record.explained_by_leak == false);
    CHECK(record.undecided);
    CHECK_FALSE(record.leak.class_);
    REQUIRE_FALSE(record.warnings.empty());
    CHECK_THAT(record.warnings.front(), Catch::StartsWith("not explained by a leak"));
  }
  // Dry friction reduces motion like a leak, but its other effects cause a warning.
  for (const auto& record : found_with("coulomb_friction", 3000.0)) {
    CAPTURE(record.fit.parity_rms_m, record.fit.misfit_rms_m, record.estimate.share);
    REQUIRE_FALSE(record.warnings.empty());
    CHECK_THAT(record.warnings.front(), Catch::Contains("there may be another fault") ||
                                            Catch::StartsWith("not explained by a leak"));
  }
}

TEST_CASE("diagnose: without a healthy record the interval says what is not in it", "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions = {campaign.conditions[2]};
  auto records = records_of(campaign);
  records.front().singles.clear();
  const Diagnosis found = diagnosis::diagnose(campaign, records, known_rig(campaign), {});
  REQUIRE(found.records.size() == 1);
  CHECK(found.records.front().leak.class_ == LeakClass::medium);
  CHECK(found.records.front().reference_repeats == 0);
  CHECK(found.records.front().warnings.size() == 2);
  CHECK_FALSE(found.smallest_leak_l_per_min.front().averaged);
  CHECK(found.smallest_leak_l_per_min.front().reason);
}

TEST_CASE("diagnose: without the area of a leak no coefficient can be told", "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions.resize(1);
  const auto records = records_of(campaign);
  diagnosis::RigFit rig = known_rig(campaign);
  const int area = row_of(campaign, "leakage_area");
  for (auto& setting : campaign.parameters)
    if (setting.index == area) setting.value = 0.0;
  std::erase_if(rig.values, [&](const auto& each) { return each.index == area; });
  const Diagnosis found = diagnosis::diagnose(campaign, records, rig, {});
  CHECK_FALSE(found.usable());
  CHECK_FALSE(found.between_days);
  CHECK_THAT(found.records.front().failure.value(), Catch::Contains("leakage_area is 0 m2"));
  CHECK_FALSE(found.records.front().features.rms_m);
  CHECK(found.records.front().undecided);
}

TEST_CASE("diagnose: a laminar leak as a conductance, without the area of an orifice",
          "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions.resize(3);
  campaign.diagnosis.leak_law = datasets::LeakLaw::laminar;
  const int area = row_of(campaign, "leakage_area");
  for (auto& setting : campaign.parameters)
    if (setting.index == area) setting.value = 0.0;
  const std::vector<double> conductances{0.0, 2e-11, 1e-10};
  const int leak = row_of(campaign, "laminar_leakage");
  for (std::size_t i = 0; i < conductances.size(); ++i)
    campaign.conditions[i].overrides = {{leak, conductances[i]}};
  diagnosis::RigFit rig = known_rig(campaign);
  std::erase_if(rig.values, [&](const auto& each) { return each.index == area; });
  diagnosis::DiagnosisOptions options;
  options.truth = rig.values;
  for (const Condition& condition : campaign.conditions)
    options.truth->push_back(
        {leak, datasets::Scope::condition, condition.id, condition.overrides.front().second});
  const Diagnosis found = diagnosis::diagnose(campaign, records_of(campaign), rig, options);
  int leaking = 0;
  for (const auto& record : found.records) {
    CAPTURE(record.condition, record.repeat.value_or(0), record.fit.failure);
    REQUIRE(record.fit.ok());
    if (record.repeat || record.is_reference) continue;
    ++leaking;
    const double truth = campaign.find(record.condition)->overrides.front().second;
    // Five standard errors: the noise is of one seed.
    CHECK(std::abs(record.fit.coefficient - truth) < 5.0 * record.estimate.standard_error);
    CHECK(record.estimate.standard_error < 0.2 * truth);
    CHECK(record.estimate.leak_detected);
    CHECK_THAT(record.leak.leak_share_percent.value(),
               Catch::WithinRel(record.true_share_percent.value(), 0.2));
  }
  CHECK(leaking == 2);
  // An area belongs to the law of an orifice.
  for (const auto& state : found.states) CHECK_FALSE(state.leak_area_m2.has_value());
}

TEST_CASE("diagnose: a record of one sample is told to be too short", "[diagnosis]") {
  Campaign campaign = small_campaign();
  campaign.conditions.resize(1);
  const Diagnosis found =
      diagnosis::diagnose(campaign, records_of(campaign, 1, 1), known_rig(campaign), {});
  CHECK_FALSE(found.usable());
  REQUIRE(found.records.size() == 4);
  for (const auto& record : found.records) {
    CHECK_FALSE(record.fit.ok());
    CHECK_THAT(record.fit.failure, Catch::Contains("one sample is used"));
  }
  // Two samples are enough to define a mean flow.
  const Diagnosis two =
      diagnosis::diagnose(campaign, records_of(campaign, 1, 2), known_rig(campaign), {});
  for (const auto& record : two.records)
    CHECK_THAT(record.fit.failure, !Catch::Contains("one sample is used"));
}

TEST_CASE("diagnose: a flag ends it between records, and says so of each", "[diagnosis]") {
  const Campaign campaign = small_campaign();
  const auto records = records_of(campaign);
  std::atomic<bool> flag{false};
  diagnosis::DiagnosisOptions options;
  options.cancel = &flag;
  options.progress = [&](int done, int) { flag = flag || done >= 1; };
  const Diagnosis found = diagnosis::diagnose(campaign, records, known_rig(campaign), options);
  const auto ended = std::count_if(found.records.begin(), found.records.end(),
                                   [](const auto& record) { return !record.fit.ok(); });
  CHECK(ended == static_cast<long>(found.records.size()));
}
