#include "diagnosis/parity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "diagnosis/alarm_threshold.hpp"
#include "diagnosis/obstacles.hpp"
#include "diagnosis/signal_name.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;
using datasets::RepeatRecords;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Length of the moving root mean square for a record without a period, as a fraction of the
/// record.
constexpr double kWindowShare = 0.1;

/// Parity residuals of a condition's repeats, or of its average where there are none.
ParityCondition residuals_of(const LeakProblem& problem, const Condition& condition,
                             const RepeatRecords& records) {
  ParityCondition result;
  result.condition = condition.id;
  result.time_s = records.average.time_s;
  std::vector<const datasets::Record*> all{&records.average};
  for (const datasets::Record& single : records.singles) all.push_back(&single);
  result.records.resize(std::max<std::size_t>(1, records.singles.size()));
  for (std::size_t k = 0; k < result.records.size(); ++k) {
    result.records[k].condition = condition.id;
    if (!records.singles.empty()) result.records[k].repeat = static_cast<int>(k) + 1;
  }
  try {
    const Residuals residuals = healthy_residuals(problem, condition, records.average, all);
    const std::vector<double>& average = residuals.front().at(Channel::position);
    result.model_m = records.average.channels.at(Channel::position).mean;
    for (std::size_t i = 0; i < average.size(); ++i) result.model_m[i] -= average[i];
    for (std::size_t k = 0; k < result.records.size(); ++k)
      result.records[k].parity_m =
          residuals[records.singles.empty() ? 0 : k + 1].at(Channel::position);
  } catch (const NoResultError& error) {
    for (ParityRecord& record : result.records) record.failure = error.what();
  }
  return result;
}

/// Residual at the sample nearest to a time.
double at_time(const ParityCondition& condition, const ParityRecord& record, double t) {
  const auto& times = condition.time_s;
  const auto above = std::lower_bound(times.begin(), times.end(), t);
  auto i = static_cast<std::size_t>(above - times.begin());
  if (i == times.size() || (i > 0 && t - times[i - 1] < times[i] - t)) --i;
  return record.parity_m[i];
}

struct Healthy {
  const ParityCondition* condition = nullptr;
  const ParityRecord* record = nullptr;
};

/// Whether a sample of a record counts: it was recorded, within the condition's windows.
bool counts(const RepeatRecords& records, std::size_t repeat, double t) {
  const auto holds = [t](const datasets::TimeWindow& window) {
    return window.start_s <= t && t <= window.end_s;
  };
  if (repeat < records.covered.size() && !holds(records.covered[repeat])) return false;
  const auto& windows = records.average.windows;
  return windows.empty() || std::any_of(windows.begin(), windows.end(), holds);
}

/// The residual less the mean of those of healthy records.
std::vector<double> corrected(const ParityCondition& condition, const ParityRecord& record,
                              std::size_t repeat, const RepeatRecords& records,
                              const std::vector<Healthy>& references) {
  std::vector<double> result = record.parity_m;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double t = condition.time_s[i];
    if (!counts(records, repeat, t)) {
      result[i] = kNan;
      continue;
    }
    double sum = 0.0;
    for (const Healthy& each : references) sum += at_time(*each.condition, *each.record, t);
    if (!references.empty()) result[i] -= sum / static_cast<double>(references.size());
  }
  return result;
}

/// Fills in the description of a residual except for the alarm.
void describe(const std::vector<double>& time_s, double window_s, ParityRecord& record) {
  std::vector<double> counted;
  for (const double value : record.residual_m)
    if (!std::isnan(value)) counted.push_back(value);
  if (counted.size() < 2) {
    record.failure = "fewer than two samples count";
    return;
  }
  record.features = metrics::residual_features(counted);
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(window_s / step_s)));
  record.moving_rms_m = moving_rms(record.residual_m, std::min(window, counted.size()));
  for (const double value : record.moving_rms_m) record.peak_m = std::fmax(record.peak_m, value);
}

double window_of(const Condition& condition, const std::vector<double>& time_s) {
  const double length_s = time_s.back() - time_s.front();
  if (is_periodic(condition.waveform) && condition.frequency_hz)
    return std::min(1.0 / *condition.frequency_hz, length_s);
  return kWindowShare * length_s;
}

/// One signal: its conditions by their place in the campaign's order.
struct Group {
  std::string signal;
  std::vector<std::size_t> places;
};

class Work {
 public:
  Work(const Campaign& campaign, const std::vector<RepeatRecords>& records,
       const ParityOptions& options, Parity& result)
      : campaign_(campaign), records_(records), options_(options), result_(result) {}

  void judge(const Group& group) {
    ParitySignal& signal = result_.signals.emplace_back();
    signal.signal = group.signal;
    const std::vector<Healthy> references = references_of(group);
    signal.healthy_records = static_cast<int>(references.size());
    for (const std::size_t place : group.places) {
      ParityCondition& condition = result_.conditions[place];
      const double window_s = window_of(*campaign_.find(condition.condition), condition.time_s);
      signal.window_s = std::max(signal.window_s, window_s);
      for (std::size_t k = 0; k < condition.records.size(); ++k)
        residual_of(condition, k, records_[place], window_s, references);
    }
    set_thresholds(references, signal);
    for (const std::size_t place : group.places) {
      for (ParityRecord& record : result_.conditions[place].records)
        raise(result_.conditions[place].time_s, signal, record);
    }
  }

  void check_false_alarms() {
    FalseAlarmCheck& check = result_.check;
    for (const ParityCondition& condition : result_.conditions) {
      for (const ParityRecord& record : condition.records) {
        if (!record.is_healthy || record.sets_threshold || !judged(record)) continue;
        ++check.records;
        check.alarms += record.alarm ? 1 : 0;
      }
    }
    if (check.alarms > 0)
      check.p = 1.0 - metrics::binomial_cdf(check.alarms - 1, check.records, options_.false_alarm);
  }

 private:
  bool judged(const ParityRecord& record) const {
    const auto signal =
        std::find_if(result_.signals.begin(), result_.signals.end(),
                     [&](const ParitySignal& each) { return each.signal == record.signal; });
    return record.failure.empty() && signal != result_.signals.end() && signal->threshold_m;
  }

  /// Marks the healthy records that thresholds rest on, and returns them.
  std::vector<Healthy> references_of(const Group& group) {
    std::vector<Healthy> of_fit;
    std::vector<Healthy> all;
    for (const std::size_t place : group.places) {
      ParityCondition& condition = result_.conditions[place];
      const datasets::Use use = campaign_.find(condition.condition)->use;
      for (ParityRecord& record : condition.records) {
        if (!record.is_healthy || !record.failure.empty()) continue;
        all.push_back({&condition, &record});
        if (use == datasets::Use::fit) of_fit.push_back(all.back());
      }
    }
    const std::vector<Healthy>& chosen = of_fit.size() >= kLeastHealthyRecords ? of_fit : all;
    for (const std::size_t place : group.places) {
      for (ParityRecord& record : result_.conditions[place].records) {
        record.sets_threshold = std::any_of(chosen.begin(), chosen.end(), [&](const Healthy& each) {
          return each.record == &record;
        });
      }
    }
    return chosen;
  }

  void residual_of(ParityCondition& condition, std::size_t repeat, const RepeatRecords& records,
                   double window_s, const std::vector<Healthy>& references) {
    ParityRecord& record = condition.records[repeat];
    if (!record.failure.empty()) return;
    std::vector<Healthy> others = references;
    std::erase_if(others, [&](const Healthy& each) { return each.record == &record; });
    record.reference_records = static_cast<int>(others.size());
    record.residual_m = corrected(condition, record, repeat, records, others);
    describe(condition.time_s, window_s, record);
  }

  /// A healthy record less the mean of the n - 1 others varies by 1 + 1 / (n - 1), a new one less
  /// the mean of all n by 1 + 1 / n of the variance of one.
  void set_thresholds(const std::vector<Healthy>& references, ParitySignal& signal) const {
    if (references.size() < kLeastHealthyRecords) {
      signal.reason = fmt::format(
          "{} healthy record{} of this signal: expected {} or more. Healthy is a leak level whose "
          "leakage_coefficient is known to be 0, that [diagnosis] calls normal, or that --healthy "
          "names",
          references.size(), references.size() == 1 ? "" : "s", kLeastHealthyRecords);
      return;
    }
    const auto n = static_cast<double>(references.size());
    const double scale = std::sqrt((1.0 + 1.0 / n) / (1.0 + 1.0 / (n - 1.0)));
    const auto threshold = [&](const auto& value) {
      std::vector<double> values;
      for (const Healthy& each : references) values.push_back(scale * value(*each.record));
      return alarm_threshold(values, options_.false_alarm);
    };
    signal.threshold_m = threshold([](const ParityRecord& r) { return r.peak_m; });
    signal.features.mean = threshold([](const ParityRecord& r) { return r.features.mean; });
    signal.features.rms = threshold([](const ParityRecord& r) { return r.features.rms; });
    signal.features.std = threshold([](const ParityRecord& r) { return r.features.std; });
    if (!signal.threshold_m)
      signal.reason =
          "healthy records do not differ from one another, so nothing tells how much "
          "such records scatter";
  }

  static void raise(const std::vector<double>& time_s, const ParitySignal& signal,
                    ParityRecord& record) {
    if (!signal.threshold_m || !record.failure.empty() || record.sets_threshold) return;
    const auto first = std::find_if(record.moving_rms_m.begin(), record.moving_rms_m.end(),
                                    [&](double value) { return value > *signal.threshold_m; });
    if (first == record.moving_rms_m.end()) return;
    record.alarm = true;
    record.alarm_time_s =
        time_s[static_cast<std::size_t>(first - record.moving_rms_m.begin())] - time_s.front();
  }

  const Campaign& campaign_;
  const std::vector<RepeatRecords>& records_;
  const ParityOptions& options_;
  Parity& result_;
};

}  // namespace

bool Parity::usable() const {
  return std::any_of(conditions.begin(), conditions.end(), [](const ParityCondition& condition) {
    return std::any_of(condition.records.begin(), condition.records.end(),
                       [](const ParityRecord& record) { return record.failure.empty(); });
  });
}

Parity parity(const Campaign& campaign, const std::vector<RepeatRecords>& records,
              const RigFit& rig, const ParityOptions& options) {
  Parity result;
  const LeakProblem problem(campaign, rig);
  result.conditions.resize(records.size());
  std::atomic<int> done{0};
  parallel_for(records.size(), options.threads, [&](std::size_t i) {
    if (options.cancel != nullptr && *options.cancel) return;
    const Condition& condition = *campaign.find(records[i].average.condition);
    result.conditions[i] = residuals_of(problem, condition, records[i]);
    const int finished = ++done;
    if (options.progress) options.progress(finished, static_cast<int>(records.size()));
  });
  if (options.cancel != nullptr && *options.cancel) return result;
  std::vector<Group> groups;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Condition& condition = *campaign.find(records[i].average.condition);
    // Two recorded drives are not the same drive.
    const std::string signal = condition.waveform == datasets::Waveform::recorded
                                   ? "recorded, " + condition.id
                                   : signal_name(campaign, condition);
    for (ParityRecord& record : result.conditions[i].records) {
      record.signal = signal;
      record.is_healthy = is_healthy(campaign, condition);
    }
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& each) { return each.signal == signal; });
    if (group == groups.end()) group = groups.insert(groups.end(), {signal, {}});
    group->places.push_back(i);
  }
  Work work(campaign, records, options, result);
  for (const Group& group : groups) work.judge(group);
  work.check_false_alarms();
  return result;
}

}  // namespace rigcal::diagnosis
