// Measures how well leaks are found in synthetic campaigns with known truth. Prints the figures in
// docs/diagnosis.md.
//
//   rigcal_diagnosis_study coverage RECORDS       intervals and classes for random leaks
//   rigcal_diagnosis_study classes FIRST LAST     classes, seeds FIRST to LAST
//   rigcal_diagnosis_study smallest FIRST LAST    smallest leak with a 0.1 Hz sine
//   rigcal_diagnosis_study coefficients           coefficients of the campaign's leaks
//   rigcal_diagnosis_study laws FIRST LAST [ROW] [FILE]       small laminar and orifice leaks, by
//                                                             position and both pressures
//   rigcal_diagnosis_study hopsan DIR FIRST LAST [FILE]       the same in records of Hopsan
//
// The files store the counts of each campaign, so that a study that was stopped can continue.
//
// The rig matches the model. With "disturbed" as the last argument, it also has friction, a valve
// lag and a supply that varies between repeats. The fit to its healthy records then estimates the
// first two and detects the third.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <string>
#include <thread>

#include "bench/healthy_rig.hpp"
#include "bench/leak_law_study.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "common/quantity.hpp"
#include "datasets/campaign/campaign_parameters.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "datasets/synthetic/synthetic_repeat.hpp"
#include "diagnosis/diagnose.hpp"
#include "diagnosis/record/steady_leak.hpp"

namespace {

using namespace rigcal;
using datasets::Campaign;
using datasets::Condition;
using datasets::LeakClass;
using datasets::RepeatRecords;

int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));

int row_of(const Campaign& campaign, const char* key) {
  return model::parameter_index(campaign.rig.plant, key);
}

void set_true(Campaign& campaign, const char* key, double value) {
  auto& values = campaign.synthetic_settings->parameters;
  const int row = row_of(campaign, key);
  std::erase_if(values, [row](const auto& entry) { return entry.first == row; });
  values.emplace_back(row, value);
}

void set_leak(const Campaign& campaign, Condition& condition, double coefficient) {
  const int row = row_of(campaign, "leakage_coefficient");
  std::erase_if(condition.overrides, [row](const auto& entry) { return entry.first == row; });
  condition.overrides.emplace_back(row, coefficient);
}

/// The leak of the true rig in one condition.
class TrueLeak {
 public:
  TrueLeak(const Campaign& campaign, const Condition& condition)
      : truth_(datasets::true_campaign(campaign)) {
    const Condition& own = *truth_.find(condition.id);
    record_.condition = own.id;
    record_.time_s = datasets::sample_times(own, nullptr);
    datasets::Series series;
    series.mean.assign(record_.time_s.size(), 0.0);
    series.sd_of_mean = 5e-5;
    record_.channels[datasets::Channel::position] = series;
    problem_.emplace(calib::make_problem(truth_, records_ = {record_}, {&own}, true, nullptr));
  }
  diagnosis::SteadyLeak at(double coefficient) const {
    const calib::ProblemCondition& condition = problem_->conditions.front();
    model::ParameterValues values = condition.values;
    values.set("leakage_coefficient", coefficient);
    return diagnosis::steady_leak(*problem_, condition, values, {});
  }
  /// Returns the smallest coefficient at which `value` reaches the target, found by bisection.
  double solve(double diagnosis::SteadyLeak::*value, double target) const {
    if (target == 0.0) return 0.0;
    double low = 0.0;
    double high = 1e-3;
    while (at(high).*value < target) low = std::exchange(high, 1.3 * high);
    for (int i = 0; i < 25; ++i) {
      const double middle = 0.5 * (low + high);
      (at(middle).*value < target ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

 private:
  Campaign truth_;
  datasets::Record record_;
  std::vector<datasets::Record> records_;
  std::optional<calib::Problem> problem_;
};

double target_share(const Condition& condition) {
  const std::map<std::string, double> shares{
      {"0 %", 0.0}, {"33.33 %", 0.05}, {"66.66 %", 0.15}, {"100 %", 0.25}};
  return shares.at(condition.leak_level.value());
}

/// Sets the leak in every condition to the fraction of the servo flow that its level states.
void set_shares(Campaign& campaign) {
  std::vector<double> found(campaign.conditions.size());
  parallel_for(found.size(), threads, [&](std::size_t i) {
    const Condition& condition = campaign.conditions[i];
    found[i] =
        TrueLeak(campaign, condition).solve(&diagnosis::SteadyLeak::share, target_share(condition));
  });
  for (std::size_t i = 0; i < found.size(); ++i)
    set_leak(campaign, campaign.conditions[i], found[i]);
}

std::vector<RepeatRecords> make_records(const Campaign& campaign, std::uint64_t seed) {
  const Campaign truth = datasets::true_campaign(campaign);
  std::vector<RepeatRecords> records(campaign.conditions.size());
  parallel_for(records.size(), threads, [&](std::size_t i) {
    std::vector<datasets::Repeat> repeats;
    for (auto& made : datasets::synthetic_repeats(truth, truth.conditions[i], nullptr, seed))
      repeats.push_back(std::move(made.record));
    records[i] = datasets::repeat_records(campaign, campaign.conditions[i], repeats);
    if (campaign.conditions[i].use == datasets::Use::fit)
      records[i].average = datasets::average_of(campaign, campaign.conditions[i], repeats, true);
  });
  return records;
}

std::vector<datasets::Record> averages_of(const std::vector<RepeatRecords>& records) {
  std::vector<datasets::Record> result;
  for (const RepeatRecords& each : records) result.push_back(each.average);
  return result;
}

calib::Fit usable_fit(const Campaign& campaign, const std::vector<RepeatRecords>& records) {
  calib::FitOptions options;
  options.threads = threads;
  calib::Fit fit = calib::fit(campaign, averages_of(records), options);
  if (!fit.usable()) throw std::runtime_error("the healthy fit failed: " + fit.message);
  return fit;
}

datasets::ParameterSetting& setting_of(Campaign& campaign, const char* key) {
  const int row = row_of(campaign, key);
  for (datasets::ParameterSetting& setting : campaign.parameters)
    if (setting.index == row) return setting;
  datasets::ParameterSetting& setting = campaign.parameters.emplace_back();
  setting.index = row;
  return setting;
}

/// Fits the rig to the healthy records, as a user would. If the fit finds that the supply pressure
/// differs between repeats, its standard deviation is added to the campaign, and the fit is
/// repeated.
diagnosis::RigFit healthy_fit(Campaign& campaign, const std::vector<RepeatRecords>& records) {
  const calib::Fit fit = usable_fit(campaign, records);
  const auto& repeats = fit.between_repeats;
  if (!repeats || !repeats->differ || repeats->cause != "supply_pressure")
    return bench::rig_of(campaign, fit);
  datasets::ParameterSetting& supply = setting_of(campaign, "supply_pressure");
  supply.lower = supply.upper = std::numeric_limits<double>::quiet_NaN();
  datasets::differ_between_repeats(model::parameter_spec(campaign.rig.plant, supply.index),
                                   *repeats->cause_sd * supply.value, supply);
  const calib::Fit again = usable_fit(campaign, records);
  return bench::rig_of(campaign, again);
}

/// Frees terms that a real rig may have but its model lacks, so that they are estimated from
/// healthy records.
void free_friction_and_lag(Campaign& campaign) {
  const std::pair<const char*, double> most[] = {{"coulomb_friction", 1000.0},
                                                 {"valve_time_constant", 0.02}};
  for (const auto& [key, upper] : most) {
    datasets::ParameterSetting& setting = setting_of(campaign, key);
    setting.value = 0.1 * upper;
    setting.lower = 0.0;
    setting.upper = upper;
    setting.fit = true;
  }
}

diagnosis::Diagnosis diagnose(const Campaign& campaign, const std::vector<RepeatRecords>& records,
                              const diagnosis::RigFit& rig) {
  diagnosis::DiagnosisOptions options;
  options.threads = threads;
  return diagnosis::diagnose(campaign, records, rig, options);
}

struct Total {
  int records = 0;
  int right = 0;
  int undecided = 0;
  int off_by_two = 0;
  void add(const diagnosis::Accuracy& each) {
    records += each.records;
    right += each.right;
    undecided += each.undecided;
    off_by_two += each.off_by_two_or_more;
  }
};

void print_total(const char* variant, const char* method, const Total& total) {
  fmt::print("| {} | {} | {} of {} | {:.2f} | {} | {} |\n", variant, method, total.right,
             total.records, 100.0 * total.right / std::max(1, total.records), total.undecided,
             total.off_by_two);
}

/// Adds disturbances that the fitted model lacks.
void disturb(Campaign& campaign) {
  set_true(campaign, "coulomb_friction", 50.0);
  set_true(campaign, "valve_time_constant", 3e-3);
  campaign.synthetic_settings->variation[row_of(campaign, "supply_pressure")] = 0.02;
}

void study_classes(Campaign campaign, const char* variant, int first, int last) {
  set_shares(campaign);
  Total single;
  Total averaged;
  Total features;
  Total other_signals;
  std::map<std::string, Total> wrong;
  for (int seed = first; seed <= last; ++seed) {
    const auto records = make_records(campaign, static_cast<std::uint64_t>(seed));
    Campaign told = campaign;
    const auto rig = healthy_fit(told, records);
    const auto found = diagnose(told, records, rig);
    single.add(found.methods.fitted_leak_single);
    averaged.add(found.methods.fitted_leak_averaged);
    features.add(found.methods.features_leave_one_repeat_out);
    other_signals.add(found.methods.features_leave_one_signal_out);
    for (const auto& record : found.records) {
      if (!record.repeat || !record.true_class || record.leak.class_ == record.true_class) continue;
      ++wrong[record.condition].right;
      if (!record.leak.class_) ++wrong[record.condition].undecided;
    }
    std::fflush(stdout);
  }
  fmt::print("| rig | method | right | % | undecided | off by two |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- |\n");
  print_total(variant, "fitted leak, single repeats", single);
  print_total(variant, "fitted leak, averages of five", averaged);
  print_total(variant, "paper's features, clusters without the repeat", features);
  print_total(variant, "paper's features, clusters of other signals", other_signals);
  for (const auto& [condition, total] : wrong) {
    fmt::print("<!-- {} {}: {} wrong, {} of them undecided -->\n", variant, condition, total.right,
               total.undecided);
  }
}

/// Estimates for averages on the other day, as signed leak flows in L/min, and numbers of alarms.
struct Estimates {
  std::vector<double> none_l_per_min;
  int alarms = 0;
  int leaks = 0;
  int found = 0;
};

constexpr double kSmallLeak = 0.05;  ///< leak to be found [L/min]
constexpr int kTrials = 5;  ///< number of averages per seed, both with and without the leak
constexpr const char* kSine = "sine_0.1Hz_open_0";

/// Returns a campaign with the healthy conditions on one day, and averages of a 0.1 Hz sine on
/// another day.
Campaign two_days(Campaign campaign, double leak) {
  std::erase_if(campaign.conditions,
                [](const Condition& c) { return c.leak_level.value() != "0 %"; });
  const Condition sine = *campaign.find(kSine);
  for (int i = 0; i < 2 * kTrials; ++i) {
    Condition other = sine;
    other.id = fmt::format("{}_{}", i < kTrials ? "none" : "leak", i);
    other.leak_level = "another day";
    other.use = datasets::Use::diagnose;
    set_leak(campaign, other, i < kTrials ? 0.0 : leak);
    campaign.conditions.push_back(other);
  }
  auto& settings = *campaign.synthetic_settings;
  double& supply = settings.variation[row_of(campaign, "supply_pressure")];
  supply = std::max(supply, 0.01);
  settings.trigger_jitter_s = 2e-3;
  return campaign;
}

/// Selects the records that a diagnosis of the sine needs: those of the healthy day with their
/// repeats, and the averages of the other day.
std::vector<RepeatRecords> sine_records(const std::vector<RepeatRecords>& records) {
  std::vector<RepeatRecords> result;
  for (const RepeatRecords& each : records) {
    const std::string& id = each.average.condition;
    if (id == kSine) result.push_back(each);
    if (id.starts_with("none_") || id.starts_with("leak_"))
      result.push_back({each.average, {}, {}});
  }
  return result;
}

void collect(const Campaign& campaign, const std::vector<RepeatRecords>& records,
             const diagnosis::RigFit& rig, double l_per_min_per_coefficient, Estimates& total) {
  for (const auto& record : diagnose(campaign, records, rig).records) {
    if (record.repeat || record.condition == kSine || !record.fit.ok()) continue;
    if (record.condition.starts_with("none_")) {
      total.none_l_per_min.push_back(record.estimate.coefficient * l_per_min_per_coefficient);
      total.alarms += record.estimate.leak_detected ? 1 : 0;
    } else {
      ++total.leaks;
      total.found += record.estimate.leak_detected ? 1 : 0;
    }
  }
}

void print_estimates(const std::string& name, const Estimates& e) {
  const auto n = static_cast<double>(e.none_l_per_min.size());
  double mean = 0.0;
  for (const double x : e.none_l_per_min) mean += x / n;
  double variance = 0.0;
  for (const double x : e.none_l_per_min) variance += (x - mean) * (x - mean) / (n - 1.0);
  const double sd = std::sqrt(variance);
  fmt::print("| {} | {:.4f} | {:.4f} | {:.4f} | {} of {} | {} of {} |\n", name, mean, sd,
             (2.326 + 1.645) * sd, e.alarms, e.none_l_per_min.size(), e.found, e.leaks);
}

void study_smallest(const Campaign& base, int first, int last) {
  const TrueLeak true_leak(base, *base.find(kSine));
  const double leak =
      true_leak.solve(&diagnosis::SteadyLeak::leak_flow_m3_per_s, kSmallLeak / kLitresPerMinute);
  const Campaign campaign = two_days(base, leak);
  Campaign no_reference = campaign;
  no_reference.diagnosis.level_class.clear();
  std::vector<std::pair<std::string, Estimates>> rows;
  const auto row = [&](const std::string& name) -> Estimates& {
    for (auto& [known_name, estimates] : rows)
      if (known_name == name) return estimates;
    return rows.emplace_back(name, Estimates{}).second;
  };
  const double scale = kSmallLeak / leak;
  for (int seed = first; seed <= last; ++seed) {
    const auto records = make_records(campaign, static_cast<std::uint64_t>(seed));
    const auto sines = sine_records(records);
    Campaign told = campaign;
    const diagnosis::RigFit fitted = healthy_fit(told, records);
    collect(campaign, sines, fitted, scale, row("fitted, healthy sines as reference"));
    collect(no_reference, sines, fitted, scale, row("fitted, model alone"));
    diagnosis::RigFit exact;
    for (const auto& [index, value] : campaign.synthetic_settings->parameters)
      exact.values.push_back({index, datasets::Scope::rig, "", value});
    collect(no_reference, sines, exact, scale, row("known exactly, model alone"));
    for (const char* key : {"mass", "damping", "valve_gain"}) {
      diagnosis::RigFit wrong = exact;
      for (auto& value : wrong.values)
        if (value.index == row_of(campaign, key)) value.value *= 1.05;
      collect(campaign, sines, wrong, scale, row(fmt::format("`{}` 5 % off, with reference", key)));
      collect(no_reference, sines, wrong, scale,
              row(fmt::format("`{}` 5 % off, model alone", key)));
    }
  }
  fmt::print(
      "| rig | mean, L/min | sd, L/min | smallest leak, L/min | false alarms | {} L/min found "
      "|\n| --- | --- | --- | --- | --- | --- |\n",
      kSmallLeak);
  for (const auto& [name, estimates] : rows) print_estimates(name, estimates);
}

/// Number of conditions with random leaks per signal and campaign, and number of repeats of each.
constexpr int kRandomLeaks = 4;
constexpr int kRandomRepeats = 2;
constexpr int kHealthyRepeats = 5;
constexpr double kLeastShare = 0.001;
constexpr const char* kSmall = "0.1 to 1 %, all";
constexpr double kLargestShare = 0.60;
constexpr double kCounted = 0.01;  ///< smallest leak share for which coverage is counted

/// Returns the healthy conditions of the six signals, with the lowest sampling rates that they
/// need.
Campaign six_signals(Campaign campaign) {
  std::erase_if(campaign.conditions,
                [](const Condition& c) { return c.leak_level.value() != "0 %"; });
  for (Condition& condition : campaign.conditions) {
    const double frequency_hz = *condition.frequency_hz;
    condition.sample_rate_hz = frequency_hz < 0.5 ? 100.0 : frequency_hz < 5.0 ? 250.0 : 1000.0;
    condition.duration_s = frequency_hz < 0.5 ? 20.0 : frequency_hz < 5.0 ? 4.0 : 1.0;
  }
  campaign.synthetic_settings->repeats = kHealthyRepeats;
  return campaign;
}

/// Coefficients for the smallest and the largest share of one signal.
struct LeakRange {
  double low = 0.0;
  double high = 0.0;
};

/// Returns the next number in (0, 1) of a pseudo-random sequence (splitmix64).
double uniform(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  z ^= z >> 31U;
  return (static_cast<double>(z >> 11U) + 0.5) * 0x1p-53;
}

struct Coverage {
  int records = 0;
  int coefficient = 0;
  int share = 0;
  int share_below = 0;  ///< number of true shares below the interval
  int share_above = 0;
  int limits = 0;  ///< number of one-sided intervals
  int limits_hold = 0;
};

/// Records grouped by the probability of the class that was found.
struct Calibration {
  int records = 0;
  int right = 0;
  double probability = 0.0;
};

/// Coverage for random leaks in every condition, evaluated over all records. The leaks are uniform
/// in ln C between the coefficients for 0.1 % and 60 %.
struct CoverageTally {
  /// One entry per signal for the shares that count, and one entry for all smaller shares.
  std::map<std::string, Coverage> by_signal;
  Coverage all;  ///< for shares that count
  Coverage small;
  std::vector<Calibration> calibration = std::vector<Calibration>(5);
  std::map<LeakClass, Total> by_class;
  int healthy_records = 0;
  int alarms = 0;
  std::vector<double> limits;  ///< upper limits on the share in healthy repeats
};

/// A campaign that also has conditions with random leaks, and the true values of these.
struct RandomLeaks {
  Campaign campaign;
  std::vector<datasets::FittedValue> truth;
};

bool is_random_leak(const std::string& condition) {
  return condition.find("_leak_") != std::string::npos;
}

RandomLeaks random_leaks(const Campaign& healthy, const std::vector<LeakRange>& ranges,
                         std::uint64_t seed) {
  RandomLeaks made{healthy, {}};
  std::uint64_t state = seed;
  for (const auto& [index, value] : healthy.synthetic_settings->parameters)
    made.truth.push_back({index, datasets::Scope::rig, "", value});
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    for (int k = 0; k < kRandomLeaks; ++k) {
      Condition condition = healthy.conditions[i];
      condition.id += fmt::format("_leak_{}", k);
      condition.leak_level = condition.id;
      condition.use = datasets::Use::diagnose;
      const double coefficient =
          ranges[i].low * std::pow(ranges[i].high / ranges[i].low, uniform(state));
      set_leak(made.campaign, condition, coefficient);
      made.truth.push_back({row_of(made.campaign, "leakage_coefficient"),
                            datasets::Scope::condition, condition.id, coefficient});
      made.campaign.conditions.push_back(condition);
    }
  }
  return made;
}

void tally_interval(const diagnosis::RecordDiagnosis& record, double coefficient,
                    Coverage& coverage) {
  const auto& e = record.estimate;
  const double share = *record.true_share_percent / 100.0;
  ++coverage.records;
  if (!record.fit.ok()) return;
  coverage.coefficient += coefficient >= e.ci95.low && coefficient <= e.ci95.high ? 1 : 0;
  if (e.share_upper_limit) {
    ++coverage.limits;
    coverage.limits_hold += share <= *e.share_upper_limit ? 1 : 0;
  }
  coverage.share += share >= e.share_ci95.low && share <= e.share_ci95.high ? 1 : 0;
  coverage.share_below += share < e.share_ci95.low ? 1 : 0;
  coverage.share_above += share > e.share_ci95.high ? 1 : 0;
}

void tally_class(const diagnosis::RecordDiagnosis& record, CoverageTally& tally) {
  const bool right = record.leak.class_ == record.true_class;
  Total& own = tally.by_class[*record.true_class];
  ++own.records;
  own.right += right ? 1 : 0;
  own.undecided += record.leak.class_ ? 0 : 1;
  if (!record.leak.class_) return;
  const double p = record.estimate.probability[static_cast<std::size_t>(*record.leak.class_)];
  const std::size_t bin = p < 0.7 ? 0 : p < 0.9 ? 1 : p < 0.99 ? 2 : p < 0.999 ? 3 : 4;
  Calibration& calibration = tally.calibration[bin];
  ++calibration.records;
  calibration.right += right ? 1 : 0;
  calibration.probability += p;
}

void tally_record(const diagnosis::RecordDiagnosis& record,
                  const std::vector<datasets::FittedValue>& truth, CoverageTally& tally) {
  if (record.is_reference || !record.repeat) return;
  if (!is_random_leak(record.condition)) {
    ++tally.healthy_records;
    tally.alarms += record.estimate.leak_detected ? 1 : 0;
    if (record.estimate.share_upper_limit)
      tally.limits.push_back(*record.estimate.share_upper_limit);
    return;
  }
  const double coefficient = std::find_if(truth.begin(), truth.end(), [&](const auto& value) {
                               return value.level == record.condition;
                             })->value;
  const bool counted = *record.true_share_percent >= 100.0 * kCounted;
  tally_interval(record, coefficient, counted ? tally.all : tally.small);
  tally_interval(record, coefficient, tally.by_signal[counted ? record.signal : kSmall]);
  tally_class(record, tally);
}

double in_percent(int part, int of) { return 100.0 * part / std::max(1, of); }

void print_intervals(CoverageTally tally) {
  fmt::print(
      "| signal | records | C in its interval, % | share in its interval, % | truth below | above "
      "|\n| --- | --- | --- | --- | --- | --- |\n");
  tally.by_signal["1 to 60 %, all"] = tally.all;
  for (const auto& [signal, each] : tally.by_signal) {
    fmt::print("| {} | {} | {:.1f} | {:.1f} | {} | {} |\n", signal, each.records,
               in_percent(each.coefficient, each.records), in_percent(each.share, each.records),
               each.share_below, each.share_above);
  }
  std::vector<double>& limits = tally.limits;
  std::sort(limits.begin(), limits.end());
  fmt::print(
      "\nhealthy repeats: {}, of which {} alarms (1 % meant); upper limit of the share: median "
      "{:.3f} %\n",
      tally.healthy_records, tally.alarms,
      limits.empty() ? 0.0 : 100.0 * limits[limits.size() / 2]);
  fmt::print("leaks not detected: {}, of which the upper limit holds {}\n\n",
             tally.all.limits + tally.small.limits,
             tally.all.limits_hold + tally.small.limits_hold);
}

void print_classes(const CoverageTally& tally) {
  fmt::print("| true class | records | right | % | undecided |\n| --- | --- | --- | --- | --- |\n");
  for (const auto& [leak_class, each] : tally.by_class) {
    fmt::print("| {} | {} | {} | {:.1f} | {} |\n", to_string(leak_class), each.records, each.right,
               in_percent(each.right, each.records), each.undecided);
  }
  fmt::print(
      "\n| probability of the class | records | mean probability, % | right, % |\n"
      "| --- | --- | --- | --- |\n");
  constexpr std::array kBins{"50 to 70 %", "70 to 90 %", "90 to 99 %", "99 to 99.9 %",
                             "above 99.9 %"};
  for (std::size_t i = 0; i < tally.calibration.size(); ++i) {
    const Calibration& each = tally.calibration[i];
    fmt::print("| {} | {} | {:.1f} | {:.1f} |\n", kBins.at(i), each.records,
               100.0 * each.probability / std::max(1, each.records),
               in_percent(each.right, each.records));
  }
}

void study_coverage(const Campaign& base, int records_wanted) {
  const Campaign healthy = six_signals(base);
  std::vector<LeakRange> ranges(healthy.conditions.size());
  parallel_for(ranges.size(), threads, [&](std::size_t i) {
    const TrueLeak leak(healthy, healthy.conditions[i]);
    ranges[i] = {leak.solve(&diagnosis::SteadyLeak::share, kLeastShare),
                 leak.solve(&diagnosis::SteadyLeak::share, kLargestShare)};
  });
  CoverageTally tally;
  for (std::uint64_t seed = 1; tally.all.records < records_wanted; ++seed) {
    RandomLeaks made = random_leaks(healthy, ranges, seed);
    auto records = make_records(made.campaign, seed);
    const auto rig = healthy_fit(made.campaign, records);
    for (RepeatRecords& each : records) {
      if (!is_random_leak(each.average.condition)) continue;
      each.singles.resize(kRandomRepeats);
      each.covered.resize(kRandomRepeats);
    }
    diagnosis::DiagnosisOptions options;
    options.threads = threads;
    options.truth = made.truth;
    for (const auto& record : diagnosis::diagnose(made.campaign, records, rig, options).records)
      tally_record(record, made.truth, tally);
  }
  print_intervals(tally);
  print_classes(tally);
}

void print_coefficients(Campaign campaign) {
  set_shares(campaign);
  for (const Condition& condition : campaign.conditions) {
    fmt::print("{} {:.6g}\n", condition.id,
               datasets::values_in(campaign, condition)["leakage_coefficient"]);
  }
}

/// Starts a study of leak laws: `laws FIRST LAST [ROW] [FILE]`, `hopsan DIR FIRST LAST [FILE]`.
void study_laws(const std::vector<std::string>& arguments) {
  const bool other = arguments[0] == "hopsan";
  const auto argument = [&](std::size_t i) {
    return i < arguments.size() ? arguments[i] : std::string();
  };
  const auto seed = [&](std::size_t i) {
    return static_cast<std::uint64_t>(std::max(1, std::atoi(argument(i).c_str())));
  };
  const std::size_t first = other ? 2 : 1;
  bench::StudyRange range{seed(first), std::max(seed(first), seed(first + 1)), threads, {}};
  range.file = argument(4);
  if (other) {
    bench::study_other_simulator(argument(1), range);
  } else {
    bench::study_leak_laws(range, argument(3));
  }
}

int usage() {
  fmt::print(stderr,
             "usage: rigcal_diagnosis_study coverage RECORDS, classes|smallest FIRST LAST, or "
             "coefficients, and \"disturbed\" after it; or laws FIRST LAST [ROW] [FILE], or hopsan "
             "DIR FIRST LAST [FILE]\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  Campaign campaign =
      datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/rigs/uis_shake_table/diagnosis.toml");
  const char* rig = "as the model";
  if (!arguments.empty() && arguments.back() == "disturbed") {
    arguments.pop_back();
    free_friction_and_lag(campaign);
    disturb(campaign);
    rig = "with friction, lag, varying supply";
  }
  const std::string what = arguments.empty() ? "" : arguments[0];
  const int first = arguments.size() > 1 ? std::atoi(arguments[1].c_str()) : 1;
  const int last = arguments.size() > 2 ? std::atoi(arguments[2].c_str()) : first;
  if (what == "classes") {
    study_classes(campaign, rig, first, last);
  } else if (what == "coverage") {
    study_coverage(campaign, first);
  } else if (what == "smallest") {
    study_smallest(campaign, first, last);
  } else if (what == "laws" || what == "hopsan") {
    if (what == "hopsan" && arguments.size() < 2) return usage();
    study_laws(arguments);
  } else if (what == "coefficients") {
    print_coefficients(campaign);
  } else {
    return usage();
  }
  return 0;
}
