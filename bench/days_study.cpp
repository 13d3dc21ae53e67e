// Studies diagnoses of records that are not from the day of their reference: alarms for healthy
// records, how many leaks of the stated smallest size are found, how often intervals cover the
// truth, and trends. The records come from bench/foreign_rig.hpp, which has no code in common with
// the product. Supply, oil, zero and trigger are drawn for each day. Prints the tables in
// docs/diagnosis.md.
//
//   rigcal_days_study [campaigns] [first seed] [threads] [part of a row's name] [file]
//
// The file stores the result of each campaign, so that a study that was stopped can continue.
#include <fmt/format.h>

#include <algorithm>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/foreign_campaign.hpp"
#include "bench/foreign_day.hpp"
#include "bench/healthy_rig.hpp"
#include "bench/kept_counts.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/diagnose.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;

constexpr double kDayNoise_m = 0.05e-3;
constexpr int kRepeats = 5;
constexpr int kOtherDays = 4;
/// Coefficient of a worn seal, which either stays constant or is the start of a trend.
constexpr double kWornSeal = 0.1;
/// Slope of the trend in standard errors, which are those of a seal that stays constant.
constexpr double kStandardErrors = 4.0;
constexpr int kDaysApart = 7;
const std::vector<Reference> kDaySignals{
    {"square", 1.0, 0.05, 2.0}, {"sine", 5.0, 0.02, 1.0}, {"sine", 2.0, 0.05, 1.0}};

using DaysStream = boost::random::mt19937_64;

/// Returns the rig without a leak, as it is on one day.
ForeignRig healthy_rig_of_day(const DaySizes& sizes, DaysStream& stream) {
  ForeignRig rig;
  rig.leak_coefficient = 0.0;
  return rig_of_day(rig, sizes, stream);
}

struct DaysRow {
  std::string name;
  DaySizes drawn;
  bool same_day = false;  ///< true if all records are from the day of the reference
  bool trend = false;
  int healthy_dates = 1;
  std::function<void(datasets::StatedSizes&)> state = [](auto&) {};
};

const std::vector<DaysRow>& days_rows() {
  static const std::vector<DaysRow> rows = [] {
    std::vector<DaysRow> all;
    all.push_back({"the day of the reference", {}, true});
    all.push_back({"other days, usual sizes", kUsualDaySizes});
    DaysRow supply{"other days, the supply alone, stated", {5e-3, 0.0, 0.0, 0.0}};
    supply.state = [](datasets::StatedSizes& days) {
      days.sizes["supply_pressure"] = 31e3;
      days.left_out = {"bulk_modulus", "position_offset", datasets::kTriggerKey};
    };
    all.push_back(supply);
    DaysRow ignored = supply;
    ignored.name = "other days, the supply alone, between_days = false";
    ignored.state = [](datasets::StatedSizes& days) { days.none = true; };
    all.push_back(ignored);
    DaysRow dates{"other days, twice the usual sizes, six healthy dates",
                  times(2.0, kUsualDaySizes)};
    dates.healthy_dates = 6;
    all.push_back(dates);
    DaysRow trend{"trend over four dates, fresh days, usual sizes", kUsualDaySizes};
    trend.trend = true;
    all.push_back(trend);
    return all;
  }();
  return rows;
}

int days_row_of(const char* key) {
  return model::parameter_index(model::PlantKind::load_pressure, key);
}

datasets::ParameterSetting free_setting(const char* key, double truth) {
  datasets::ParameterSetting setting;
  setting.index = days_row_of(key);
  setting.fit = true;
  setting.value = 1.1 * truth;
  setting.lower = truth / 5.0;
  setting.upper = 5.0 * truth;
  return setting;
}

datasets::Campaign days_campaign(const DaysRow& row) {
  const ForeignRig rig;
  datasets::Campaign campaign = foreign_campaign(rig);
  const std::pair<const char*, double> known[] = {
      {"mass", rig.mass_kg}, {"damping", rig.damping_n_s_per_m}, {"leakage_coefficient", 0.0}};
  for (const auto& [key, value] : known) {
    datasets::ParameterSetting setting;
    setting.index = days_row_of(key);
    setting.value = value;
    campaign.parameters.push_back(setting);
  }
  campaign.parameters.push_back(free_setting("bulk_modulus", rig.bulk_modulus_pa));
  campaign.parameters.push_back(free_setting("valve_gain", rig.valve_gain_m_per_v));
  campaign.leak_levels["healthy"] = {{days_row_of("leakage_coefficient"), 0.0}};
  campaign.considered.none = true;  // the intervals of the fit are not used
  row.state(campaign.between_days);
  return campaign;
}

/// A campaign to which conditions are added one by one, with their records.
struct DaysMade {
  datasets::Campaign campaign;
  std::vector<datasets::RepeatRecords> records;

  /// @param singles  number of repeats that are also diagnosed individually
  void add(const ForeignRig& rig, const std::string& level, int day, datasets::Use use,
           std::size_t singles, DaysStream& stream, const std::vector<double>& leaks = {}) {
    for (std::size_t s = 0; s < kDaySignals.size(); ++s) {
      ForeignRig own = rig;
      if (!leaks.empty()) own.leak_coefficient = leaks[s];
      const Reference& signal = kDaySignals[s];
      datasets::Condition condition;
      condition.id = fmt::format("{}_{}Hz_{}_{}", signal.waveform, signal.frequency_hz, level, day);
      condition.waveform =
          signal.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
      condition.frequency_hz = signal.frequency_hz;
      condition.amplitude = signal.amplitude_m;
      condition.duration_s = signal.duration_s;
      condition.leak_level = level;
      condition.date = date_of(day);
      condition.use = use;
      boost::random::normal_distribution<double> normal(0.0, kDayNoise_m);
      const std::vector<double> readings = foreign_readings(own, signal);
      std::vector<datasets::Repeat> repeats;
      for (int r = 0; r < kRepeats; ++r) {
        datasets::Repeat& repeat = repeats.emplace_back();
        repeat.source = fmt::format("repeat {}", r + 1);
        for (std::size_t k = 0; k < readings.size(); ++k) {
          repeat.time_s.push_back(static_cast<double>(k) / 1000.0);
          repeat.values[Channel::position].push_back(readings[k] + normal(stream));
        }
      }
      campaign.conditions.push_back(condition);
      datasets::RepeatRecords made = datasets::repeat_records(campaign, condition, repeats);
      if (use == datasets::Use::fit)
        made.average = datasets::average_of(campaign, condition, repeats, true);
      made.singles.resize(std::min(singles, made.singles.size()));
      made.covered.resize(std::min(singles, made.covered.size()));
      records.push_back(std::move(made));
    }
  }

  diagnosis::Diagnosis diagnosed(const diagnosis::RigFit& rig) const {
    return diagnosis::diagnose(campaign, records, rig, {});
  }
};

/// Counts for one campaign, in the order of the columns in the result file.
struct DaysCounts {
  int averages = 0, average_alarms = 0, incompatible = 0;
  int singles = 0, single_alarms = 0;
  int states = 0, state_alarms = 0;
  int leaks = 0, found = 0, held = 0;
  int trends = 0, significant = 0, slopes = 0, slopes_found = 0;
  double limit_l_per_min = 0.0;  ///< smallest detectable leak in an average; mean over the signals

  template <typename Take>
  void for_each(Take take) {
    for (int* each :
         {&averages, &average_alarms, &incompatible, &singles, &single_alarms, &states,
          &state_alarms, &leaks, &found, &held, &trends, &significant, &slopes, &slopes_found})
      take(*each);
    take(limit_l_per_min);
  }
};

void count_healthy(const diagnosis::Diagnosis& found, const std::string& level,
                   DaysCounts& counts) {
  for (const diagnosis::RecordDiagnosis& record : found.records) {
    if (record.condition.find(level) == std::string::npos) continue;
    if (!record.fit.ok()) throw std::runtime_error(record.condition + ": " + record.fit.failure);
    const bool alarm = record.estimate.leak_detected;
    if (record.repeat) {
      ++counts.singles;
      counts.single_alarms += alarm ? 1 : 0;
      continue;
    }
    ++counts.averages;
    counts.average_alarms += alarm ? 1 : 0;
    counts.incompatible += record.estimate.incompatible ? 1 : 0;
  }
  for (const diagnosis::MachineState& state : found.states) {
    if (!state.ok() || state.key.leak_level != level) continue;
    ++counts.states;
    counts.state_alarms += state.estimate.leak_detected ? 1 : 0;
  }
}

void count_leaks(const diagnosis::Diagnosis& found, const std::vector<double>& leaks,
                 DaysCounts& counts) {
  std::size_t next = 0;
  for (const diagnosis::RecordDiagnosis& record : found.records) {
    if (record.repeat || record.condition.find("leaking") == std::string::npos) continue;
    const double truth = leaks[next++ % leaks.size()];
    ++counts.leaks;
    counts.found += record.estimate.leak_detected ? 1 : 0;
    counts.held += record.estimate.ci95.low <= truth && truth <= record.estimate.ci95.high;
  }
}

DaysCounts counts_of(const DaysRow& row, std::uint64_t seed) {
  DaysStream stream(seed);
  DaysCounts counts;
  DaysMade made{days_campaign(row), {}};
  const ForeignRig first = healthy_rig_of_day(row.drawn, stream);
  made.add(first, "healthy", 0, datasets::Use::fit, kRepeats, stream);
  std::vector<datasets::Record> fitted;
  for (const auto& each : made.records) fitted.push_back(each.average);
  const calib::Fit fit = calib::fit(made.campaign, fitted, {});
  if (!fit.usable()) throw std::runtime_error("the fit failed: " + fit.message);
  const diagnosis::RigFit rig = bench::rig_of(made.campaign, fit);
  for (int day = 1; day < row.healthy_dates; ++day)
    made.add(healthy_rig_of_day(row.drawn, stream), "healthy", day, datasets::Use::validate, 0,
             stream);

  std::vector<ForeignRig> others;
  const auto draw_others = [&] {
    others.clear();
    for (int i = 0; i < kOtherDays; ++i)
      others.push_back(row.same_day ? first : healthy_rig_of_day(row.drawn, stream));
  };
  draw_others();
  const auto with_others = [&](const std::string& level, const std::function<double(int)>& leak,
                               const std::vector<double>& leaks) {
    DaysMade all = made;
    for (int i = 0; i < kOtherDays; ++i) {
      ForeignRig own = others[static_cast<std::size_t>(i)];
      own.leak_coefficient = leak(i);
      const std::string name = row.same_day ? fmt::format("{}{}", level, i) : level;
      all.add(own, name, row.same_day ? 0 : 10 + kDaysApart * i, datasets::Use::diagnose,
              row.trend ? 0 : 1, stream, leaks);
    }
    return all.diagnosed(rig);
  };
  if (row.trend) {
    const auto trend_with = [&](double coefficient_per_day) {
      const auto worn = [=](int i) { return kWornSeal + coefficient_per_day * kDaysApart * i; };
      const auto trends = with_others("seal", worn, {}).trends;
      if (trends.size() != 1) throw std::runtime_error("expected one trend over the dates");
      return trends.front();
    };
    const diagnosis::LeakTrend constant = trend_with(0.0);
    counts.trends = 1;
    counts.significant = constant.significant ? 1 : 0;
    draw_others();  // the same days would repeat the error of the slope
    counts.slopes = 1;
    counts.slopes_found =
        trend_with(kStandardErrors * constant.coefficient_per_day_error).significant ? 1 : 0;
    return counts;
  }
  const diagnosis::Diagnosis healthy = with_others("unknown", [](int) { return 0.0; }, {});
  count_healthy(healthy, "unknown", counts);
  const bool one_day = healthy.between_days.value().other_days.empty();
  std::vector<double> leaks(kDaySignals.size());
  for (std::size_t s = 0; s < kDaySignals.size(); ++s) {
    const std::string& id = made.campaign.conditions[s].id;
    const auto same = std::find_if(healthy.records.begin(), healthy.records.end(),
                                   [&](const auto& each) { return each.condition == id; });
    std::optional<diagnosis::DetectionLimit> limit;
    for (const diagnosis::RecordDiagnosis& each : healthy.records) {
      const auto& own = one_day ? each.smallest_leak : each.smallest_leak_of_another_day;
      if (each.is_average() && each.signal == same->signal && own) keep_larger(*own, limit);
    }
    leaks[s] = limit.value().coefficient;
    counts.limit_l_per_min +=
        60e3 * limit->leak_flow_m3_per_s / static_cast<double>(kDaySignals.size());
  }
  count_leaks(with_others(
                  "leaking", [](int) { return 0.0; }, leaks),
              leaks, counts);
  return counts;
}

std::vector<DaysCounts> study(const DaysRow& row, int campaigns, std::uint64_t first, int threads,
                              KeptCounts<DaysCounts>& kept) {
  std::vector<DaysCounts> all(static_cast<std::size_t>(campaigns));
  parallel_for(all.size(), threads, [&](std::size_t i) {
    all[i] = kept.of(row.name, first + i, [&](std::uint64_t seed) { return counts_of(row, seed); });
  });
  return all;
}

void print_row(const DaysRow& row, const std::vector<DaysCounts>& all) {
  double limit = 0.0;
  for (const DaysCounts& each : all)
    limit += each.limit_l_per_min / static_cast<double>(all.size());
  if (row.trend) {
    std::cout << fmt::format(
        "\n{}: a seal that does not change is called one that does in {} %; a "
        "slope of four standard errors is found in {} %\n",
        row.name, rate_of(all, &DaysCounts::significant, &DaysCounts::trends),
        rate_of(all, &DaysCounts::slopes_found, &DaysCounts::slopes));
    return;
  }
  std::cout << fmt::format("| {} | {} | {} | {} | {} | {:.3f} | {} | {} |\n", row.name,
                           rate_of(all, &DaysCounts::average_alarms, &DaysCounts::averages),
                           rate_of(all, &DaysCounts::single_alarms, &DaysCounts::singles),
                           rate_of(all, &DaysCounts::state_alarms, &DaysCounts::states),
                           rate_of(all, &DaysCounts::incompatible, &DaysCounts::averages), limit,
                           rate_of(all, &DaysCounts::found, &DaysCounts::leaks),
                           rate_of(all, &DaysCounts::held, &DaysCounts::leaks))
            << std::flush;
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  using namespace rigcal::bench;
  const int campaigns = argc > 1 ? std::atoi(argv[1]) : 100;
  const int first = argc > 2 ? std::atoi(argv[2]) : 1;
  const int threads = argc > 3 ? std::atoi(argv[3]) : 1;
  const std::string only = argc > 4 ? argv[4] : "";
  if (campaigns < 1 || first < 1 || threads < 1 || argc > 6) {
    std::cerr << "usage: rigcal_days_study [campaigns] [first seed] [threads] [part of a row's "
                 "name] [file that keeps]\n";
    return 2;
  }
  KeptCounts<DaysCounts> kept(argc > 5 ? argv[5] : "");
  std::cout << fmt::format(
      "| {} campaigns from seed {} | alarms of healthy averages, % | of single repeats, % | of "
      "states, % | incompatible averages, % | smallest leak, L/min | found at that size, % | "
      "intervals that cover it, % |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
      campaigns, first);
  for (const DaysRow& row : days_rows()) {
    if (row.name.find(only) == std::string::npos) continue;
    print_row(row, study(row, campaigns, static_cast<std::uint64_t>(first), threads, kept));
  }
  return 0;
}
