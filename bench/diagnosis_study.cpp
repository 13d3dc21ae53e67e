// How well leaks are told on synthetic campaigns of known truth: the numbers of docs/diagnosis.md.
//   rigcal_diagnosis_study classes FIRST LAST     classes, seeds FIRST to LAST, both rigs
//   rigcal_diagnosis_study clean|disturbed ...    the same of one rig
//   rigcal_diagnosis_study smallest FIRST LAST    smallest leak on a 0.1 Hz sine
//   rigcal_diagnosis_study coefficients           coefficients of the campaign's leaks
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "datasets/single_repeats.hpp"
#include "datasets/synthetic_repeat.hpp"
#include "diagnosis/diagnose.hpp"

namespace {

using namespace rigcal;
using datasets::Campaign;
using datasets::Condition;
using datasets::RepeatRecords;

const int kThreads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
constexpr double kLitresPerMinute = 60e3;

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

/// What leaks in one condition of the true rig.
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
  diagnosis::LeakPoint at(double coefficient) const {
    return diagnosis::simulate_leak(*problem_, problem_->conditions.front(), coefficient);
  }
  /// The least coefficient at which `value` reaches the target, by bisection.
  double solve(double diagnosis::LeakPoint::*value, double target) const {
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

/// Sets the leak of every condition so that its level's share of the servo flow leaks.
void set_shares(Campaign& campaign) {
  std::vector<double> found(campaign.conditions.size());
  parallel_for(found.size(), kThreads, [&](std::size_t i) {
    const Condition& condition = campaign.conditions[i];
    found[i] =
        TrueLeak(campaign, condition).solve(&diagnosis::LeakPoint::share, target_share(condition));
  });
  for (std::size_t i = 0; i < found.size(); ++i)
    set_leak(campaign, campaign.conditions[i], found[i]);
}

std::vector<RepeatRecords> make_records(const Campaign& campaign, std::uint64_t seed) {
  const Campaign truth = datasets::true_campaign(campaign);
  std::vector<RepeatRecords> records(campaign.conditions.size());
  parallel_for(records.size(), kThreads, [&](std::size_t i) {
    std::vector<datasets::Repeat> repeats;
    for (auto& made : datasets::synthetic_repeats(truth, truth.conditions[i], nullptr, seed))
      repeats.push_back(std::move(made.record));
    records[i] = datasets::repeat_records(campaign, campaign.conditions[i], repeats);
  });
  return records;
}

std::vector<datasets::Record> averages_of(const std::vector<RepeatRecords>& records) {
  std::vector<datasets::Record> result;
  for (const RepeatRecords& each : records) result.push_back(each.average);
  return result;
}

/// The rig by a fit to the healthy records.
diagnosis::RigFit healthy_fit(const Campaign& campaign, const std::vector<RepeatRecords>& records) {
  calib::FitOptions options;
  options.threads = kThreads;
  const calib::Fit fit = calib::fit(campaign, averages_of(records), options);
  if (!fit.usable()) throw std::runtime_error("the healthy fit failed: " + fit.message);
  return diagnosis::rig_fit_of(fit);
}

diagnosis::Diagnosis diagnose(const Campaign& campaign, const std::vector<RepeatRecords>& records,
                              const diagnosis::RigFit& rig) {
  diagnosis::DiagnosisOptions options;
  options.threads = kThreads;
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
    off_by_two += each.off_by_two;
  }
};

void print_total(const char* variant, const char* method, const Total& total) {
  fmt::print("| {} | {} | {} of {} | {:.2f} | {} | {} |\n", variant, method, total.right,
             total.records, 100.0 * total.right / std::max(1, total.records), total.undecided,
             total.off_by_two);
}

/// The campaign with what the fitted model does not have.
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
    const auto found = diagnose(campaign, records, healthy_fit(campaign, records));
    single.add(found.single);
    averaged.add(found.averaged);
    features.add(found.features);
    other_signals.add(found.features_of_other_signals);
    for (const auto& record : found.records) {
      if (!record.repeat || !record.truth || record.leak_class == record.truth) continue;
      ++wrong[record.condition].right;
      if (!record.leak_class) ++wrong[record.condition].undecided;
    }
    std::fflush(stdout);
  }
  print_total(variant, "fitted leak, single repeats", single);
  print_total(variant, "fitted leak, averages of five", averaged);
  print_total(variant, "paper's features, clusters without the repeat", features);
  print_total(variant, "paper's features, clusters of other signals", other_signals);
  for (const auto& [condition, total] : wrong) {
    fmt::print("<!-- {} {}: {} wrong, {} of them undecided -->\n", variant, condition, total.right,
               total.undecided);
  }
}

/// Estimates of averages on the other day, as leak flow in L/min (signed), and what was alarmed.
struct Estimates {
  std::vector<double> none_l_per_min;
  int alarms = 0;
  int leaks = 0;
  int found = 0;
};

constexpr double kSmallLeak = 0.05;  ///< L/min
constexpr int kTrials = 5;           ///< averages without and with the leak per seed
constexpr const char* kSine = "sine_0.1Hz_open_0";

/// The healthy conditions of one day, and averages of a 0.1 Hz sine of another.
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
  settings.variation[row_of(campaign, "supply_pressure")] = 0.01;
  settings.trigger_jitter_s = 2e-3;
  return campaign;
}

/// Only what a diagnosis of the sine needs: its healthy day with repeats, the other day's averages.
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
      true_leak.solve(&diagnosis::LeakPoint::leak_flow_m3_per_s, kSmallLeak / kLitresPerMinute);
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
    const diagnosis::RigFit fitted = healthy_fit(campaign, records);
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
      collect(campaign, sines, wrong, scale, row(fmt::format("{} 5 % off, with reference", key)));
      collect(no_reference, sines, wrong, scale, row(fmt::format("{} 5 % off, model alone", key)));
    }
  }
  fmt::print(
      "| rig | mean, L/min | sd, L/min | smallest leak, L/min | false alarms | {} L/min found "
      "|\n| --- | --- | --- | --- | --- | --- |\n",
      kSmallLeak);
  for (const auto& [name, estimates] : rows) print_estimates(name, estimates);
}

void print_coefficients(Campaign campaign) {
  set_shares(campaign);
  for (const Condition& condition : campaign.conditions) {
    fmt::print("{} {:.6g}\n", condition.id,
               datasets::values_in(campaign, condition)["leakage_coefficient"]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const int first = argc > 2 ? std::atoi(argv[2]) : 1;
  const int last = argc > 3 ? std::atoi(argv[3]) : first;
  const Campaign campaign =
      datasets::load_campaign(RIGCAL_SOURCE_DIR "/datasets/uis_shake_table/diagnosis.toml");
  if (what == "classes" || what == "clean" || what == "disturbed") {
    fmt::print("| rig | method | right | % | undecided | off by two |\n");
    fmt::print("| --- | --- | --- | --- | --- | --- |\n");
    if (what != "disturbed") study_classes(campaign, "as the model", first, last);
    Campaign disturbed = campaign;
    disturb(disturbed);
    if (what != "clean")
      study_classes(disturbed, "with friction, lag, varying supply", first, last);
    return 0;
  }
  if (what == "smallest") {
    study_smallest(campaign, first, last);
    return 0;
  }
  if (what == "coefficients") {
    print_coefficients(campaign);
    return 0;
  }
  fmt::print(stderr,
             "usage: rigcal_diagnosis_study classes|clean|disturbed|smallest FIRST LAST, or "
             "coefficients\n");
  return 2;
}
