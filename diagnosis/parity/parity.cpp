#include "diagnosis/parity/parity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "common/error.hpp"
#include "common/parallel.hpp"
#include "diagnosis/parity/alarm_threshold.hpp"
#include "diagnosis/parity/common_causes.hpp"
#include "diagnosis/record/obstacles.hpp"
#include "diagnosis/record/signal_name.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;
using datasets::RepeatRecords;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
/// Window of the moving RMS as a fraction of the record, for records without a period.
constexpr double kWindowShare = 0.1;

/// Computes the parity residuals of a condition's repeats, or of its average if it has none.
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
    result.day_changes_m = healthy_day_changes(problem, condition, records.average);
  } catch (const NoResultError& error) {
    for (ParityResidual& record : result.records) record.failure = error.what();
  }
  return result;
}

/// Returns the residual at the sample that is nearest to a time.
double at_time(const ParityCondition& condition, const ParityResidual& record, double t) {
  const auto& times = condition.time_s;
  const auto above = std::lower_bound(times.begin(), times.end(), t);
  auto i = static_cast<std::size_t>(above - times.begin());
  if (i == times.size() || (i > 0 && t - times[i - 1] < times[i] - t)) --i;
  return record.parity_m[i];
}

struct Healthy {
  const ParityCondition* condition = nullptr;
  const ParityResidual* record = nullptr;
};

/// Returns true if a sample of a record counts, that is, if it was recorded and is within the
/// condition's windows.
bool counts(const RepeatRecords& records, std::size_t repeat, double t) {
  const auto holds = [t](const datasets::TimeWindow& window) {
    return window.start_s <= t && t <= window.end_s;
  };
  if (repeat < records.covered.size() && !holds(records.covered[repeat])) return false;
  const auto& windows = records.average.windows;
  return windows.empty() || std::any_of(windows.begin(), windows.end(), holds);
}

/// Returns the residual minus the mean residual of the healthy records.
std::vector<double> corrected(const ParityCondition& condition, const ParityResidual& record,
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

/// The values of a residual that are compared with thresholds: its largest moving RMS, and its
/// features.
struct ResidualValues {
  std::vector<double> moving_rms_m;
  double peak_m = 0.0;
  metrics::ResidualFeatures features;
};

/// Returns std::nullopt if fewer than two samples count.
std::optional<ResidualValues> values_of(const std::vector<double>& residual_m,
                                        const std::vector<double>& time_s, double window_s) {
  std::vector<double> counted;
  for (const double value : residual_m)
    if (!std::isnan(value)) counted.push_back(value);
  if (counted.size() < 2) return std::nullopt;
  ResidualValues values;
  values.features = metrics::residual_features(counted);
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(window_s / step_s)));
  values.moving_rms_m = moving_rms(residual_m, std::min(window, counted.size()));
  for (const double value : values.moving_rms_m) values.peak_m = std::fmax(values.peak_m, value);
  return values;
}

/// Sets all members of a record that describe its residual, except the alarm.
void describe(const std::vector<double>& time_s, double window_s, ParityResidual& record) {
  const auto values = values_of(record.residual_m, time_s, window_s);
  if (!values) {
    record.failure = "fewer than two samples are used";
    return;
  }
  record.features = {values->features.mean, values->features.rms, values->features.std};
  record.moving_rms_m = values->moving_rms_m;
  record.peak_m = values->peak_m;
}

/// Returns the values for each pattern. Samples that are NaN in `like` do not count.
std::vector<ResidualValues> values_of_patterns(const Eigen::MatrixXd& patterns,
                                               const std::vector<double>& like,
                                               const std::vector<double>& time_s, double window_s) {
  std::vector<ResidualValues> values;
  for (Eigen::Index c = 0; c < patterns.cols(); ++c) {
    std::vector<double> residual = like;
    for (std::size_t i = 0; i < residual.size(); ++i)
      if (!std::isnan(residual[i])) residual[i] = patterns(static_cast<Eigen::Index>(i), c);
    if (auto each = values_of(residual, time_s, window_s)) values.push_back(std::move(*each));
  }
  return values;
}

/// Differences between the healthy records of a signal, from which the thresholds are computed.
struct HealthyScatter {
  std::vector<ResidualValues> own;     ///< values for each record without common causes
  std::vector<ResidualValues> causes;  ///< values for one standard deviation of each common cause
  std::vector<ResidualValues> days;    ///< values for one standard deviation of each day quantity
  double records = 0.0;
};

double window_of(const Condition& condition, const std::vector<double>& time_s) {
  const double length_s = time_s.back() - time_s.front();
  if (is_periodic(condition.waveform) && condition.frequency_hz)
    return std::min(1.0 / *condition.frequency_hz, length_s);
  return kWindowShare * length_s;
}

/// One signal, with the positions of its conditions in the campaign.
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
    for (const Healthy& each : references)
      conditions_.push_back(campaign_.find(each.condition->condition));
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
      for (ParityResidual& record : result_.conditions[place].records)
        raise(result_.conditions[place].time_s, signal, record);
    }
    conditions_.clear();
  }

  void check_false_alarms() {
    FalseAlarmCheck& check = result_.check;
    for (const ParityCondition& condition : result_.conditions) {
      for (const ParityResidual& record : condition.records) {
        if (!record.healthy || !record.alarm) continue;
        ++check.records;
        check.alarms += *record.alarm ? 1 : 0;
      }
    }
    check.expected = options_.false_alarm * check.records;
    if (check.records > 0) check.p_value = 1.0;
    if (check.alarms > 0)
      check.p_value =
          1.0 - metrics::binomial_cdf(check.alarms - 1, check.records, options_.false_alarm);
  }

 private:
  /// Marks and returns the healthy records on which the thresholds are based.
  std::vector<Healthy> references_of(const Group& group) {
    std::vector<Healthy> of_fit;
    std::vector<Healthy> all;
    for (const std::size_t place : group.places) {
      ParityCondition& condition = result_.conditions[place];
      const datasets::Use use = campaign_.find(condition.condition)->use;
      for (ParityResidual& record : condition.records) {
        if (!record.healthy || record.failure) continue;
        all.push_back({&condition, &record});
        if (use == datasets::Use::fit) of_fit.push_back(all.back());
      }
    }
    const std::vector<Healthy>& chosen = of_fit.size() >= kLeastHealthyRecords ? of_fit : all;
    for (const std::size_t place : group.places) {
      for (ParityResidual& record : result_.conditions[place].records) {
        record.sets_threshold = std::any_of(chosen.begin(), chosen.end(), [&](const Healthy& each) {
          return each.record == &record;
        });
      }
    }
    return chosen;
  }

  void residual_of(ParityCondition& condition, std::size_t repeat, const RepeatRecords& records,
                   double window_s, const std::vector<Healthy>& references) {
    ParityResidual& record = condition.records[repeat];
    if (record.failure) return;
    std::vector<Healthy> others = references;
    std::erase_if(others, [&](const Healthy& each) { return each.record == &record; });
    record.reference_records = static_cast<int>(others.size());
    std::vector<const Condition*> of;
    for (const Healthy& each : others) of.push_back(campaign_.find(each.condition->condition));
    const Condition& own = *campaign_.find(condition.condition);
    record.days = day_weights(result_.between_days, campaign_, own, of);
    // Without a date, a record is not assumed to be from another day.
    if (!own.date ||
        std::any_of(of.begin(), of.end(), [](const auto* each) { return !each->date; }))
      record.days.own = record.days.reference;
    record.residual_m = corrected(condition, record, repeat, records, others);
    describe(condition.time_s, window_s, record);
  }

  /// Sets the thresholds of a signal. Variances must be scaled: a healthy record minus the mean of
  /// the n - 1 others has 1 + 1 / (n - 1) times the variance of one record, and a new record minus
  /// the mean of all n has 1 + 1 / n times that variance.
  void set_thresholds(const std::vector<Healthy>& references, ParitySignal& signal) {
    if (references.size() < kLeastHealthyRecords) {
      signal.reason = fmt::format(
          "{} healthy record{} of this signal: expected {} or more. Healthy is a leak level whose "
          "{} is known to be 0, that [diagnosis] calls normal, or that --healthy "
          "names",
          references.size(), references.size() == 1 ? "" : "s", kLeastHealthyRecords,
          datasets::leak_parameter(campaign_.diagnosis.leak_law));
      return;
    }
    scatter_ = scatter_of(references, signal.window_s);
    signal.common_causes = static_cast<int>(scatter_.causes.size());
    signal.threshold_m = threshold(kPeak, 0.0);
    signal.feature_thresholds = feature_thresholds(0.0);
    const auto days =
        day_weights(result_.between_days, campaign_, *conditions_.front(), conditions_);
    if (signal.threshold_m)
      signal.threshold_of_another_day_m = threshold(kPeak, days.norm_of_another_day());
    if (!signal.threshold_m)
      signal.reason =
          "healthy records do not differ from one another, so the variation of healthy records is "
          "unknown";
  }

  using ValueOf = double (*)(const ResidualValues&);
  static constexpr ValueOf kPeak = [](const ResidualValues& v) { return v.peak_m; };

  /// Separates the residuals of records on a common time base into common causes and individual
  /// components. Residuals on different time bases are used unchanged.
  HealthyScatter scatter_of(const std::vector<Healthy>& references, double window_s) const {
    HealthyScatter scatter;
    scatter.records = static_cast<double>(references.size());
    const ParityCondition& first = *references.front().condition;
    std::vector<double> like = references.front().record->residual_m;
    const bool one_base = std::all_of(references.begin(), references.end(), [&](const auto& each) {
      return each.condition->time_s == first.time_s;
    });
    Eigen::MatrixXd residuals(static_cast<Eigen::Index>(like.size()),
                              one_base ? static_cast<Eigen::Index>(references.size()) : 0);
    for (Eigen::Index j = 0; j < residuals.cols(); ++j) {
      const auto& own = references[static_cast<std::size_t>(j)].record->residual_m;
      for (std::size_t i = 0; i < like.size(); ++i) {
        residuals(static_cast<Eigen::Index>(i), j) = own[i];
        if (std::isnan(own[i])) like[i] = kNan;
      }
    }
    for (std::size_t i = 0; i < like.size(); ++i)
      if (std::isnan(like[i])) residuals.row(static_cast<Eigen::Index>(i)).setZero();
    if (one_base) {
      const CommonCauses causes = common_causes(residuals);
      scatter.causes = values_of_patterns(causes.patterns, like, first.time_s, window_s);
      scatter.own = values_of_patterns(causes.rest, like, first.time_s, window_s);
    } else {
      for (const Healthy& each : references) {
        if (auto values = values_of(each.record->residual_m, each.condition->time_s, window_s))
          scatter.own.push_back(std::move(*values));
      }
    }
    scatter.days = values_of_patterns(first.day_changes_m, references.front().record->residual_m,
                                      first.time_s, window_s);
    return scatter;
  }

  /// @param day_norm  norm of the day weights of a record relative to the healthy records; 0 if it
  ///                  is from the same day
  std::optional<double> threshold(ValueOf value, double day_norm) const {
    const double n = scatter_.records;
    const double scale = std::sqrt((1.0 + 1.0 / n) / (1.0 + 1.0 / (n - 1.0)));
    std::vector<double> values;
    for (const ResidualValues& each : scatter_.own) values.push_back(scale * value(each));
    const auto own = alarm_threshold(values, options_.false_alarm);
    if (!own) return std::nullopt;
    std::vector<CausePart> parts;
    for (const ResidualValues& each : scatter_.causes)
      parts.push_back({square(value(each)) * (1.0 + 1.0 / n), n - 1.0});
    for (const ResidualValues& each : scatter_.days) {
      parts.push_back({square(day_norm * value(each)) * result_.between_days.variance,
                       result_.between_days.degrees_of_freedom()});
    }
    return threshold_with(*own, parts, options_.false_alarm);
  }

  FeatureThresholds feature_thresholds(double day_norm) const {
    return {threshold([](const ResidualValues& v) { return v.features.mean; }, day_norm),
            threshold([](const ResidualValues& v) { return v.features.rms; }, day_norm),
            threshold([](const ResidualValues& v) { return v.features.std; }, day_norm)};
  }

  static double square(double x) { return x * x; }

  static std::optional<bool> above(const std::optional<double>& value,
                                   const std::optional<double>& threshold) {
    return threshold ? std::optional(value > threshold) : std::nullopt;
  }

  void raise(const std::vector<double>& time_s, const ParitySignal& signal,
             ParityResidual& record) const {
    if (!signal.threshold_m || record.failure) return;
    record.threshold_m = threshold(kPeak, record.days.norm());
    const FeatureThresholds limits = feature_thresholds(record.days.norm());
    record.exceeds = {above(record.features.mean_m, limits.mean_m),
                      above(record.features.rms_m, limits.rms_m),
                      above(record.features.std_m, limits.std_m)};
    if (record.sets_threshold) return;
    const auto first = std::find_if(record.moving_rms_m.begin(), record.moving_rms_m.end(),
                                    [&](double value) { return value > *record.threshold_m; });
    record.alarm = first != record.moving_rms_m.end();
    if (!*record.alarm) return;
    record.time_to_alarm_s =
        time_s[static_cast<std::size_t>(first - record.moving_rms_m.begin())] - time_s.front();
  }

  const Campaign& campaign_;
  const std::vector<RepeatRecords>& records_;
  const ParityOptions& options_;
  Parity& result_;
  // These members belong to the signal that is being judged.
  HealthyScatter scatter_;
  std::vector<const Condition*> conditions_;  ///< conditions of the references
};

/// Warns that records without a date are treated as recorded on the same day as the healthy ones.
void warn_of_undated(const Campaign& campaign, Parity& result) {
  std::vector<std::string> undated;
  for (const ParityCondition& condition : result.conditions)
    if (!campaign.find(condition.condition)->date) undated.push_back(condition.condition);
  if (undated.empty() || result.between_days.quantities.empty()) return;
  result.warnings.push_back(fmt::format(
      "no date: {}. Records without a date are treated as from the day of the healthy ones: their "
      "thresholds do not include day-to-day variation (supply, oil, zero, trigger)",
      fmt::join(undated, ", ")));
}

}  // namespace

bool Parity::usable() const {
  return std::any_of(conditions.begin(), conditions.end(), [](const ParityCondition& condition) {
    return std::any_of(condition.records.begin(), condition.records.end(),
                       [](const ParityResidual& record) { return !record.failure; });
  });
}

Parity parity(const Campaign& campaign, const std::vector<RepeatRecords>& records,
              const RigFit& rig, const ParityOptions& options) {
  Parity result;
  LeakProblem problem(campaign, rig);
  if (!campaign.conditions.empty())
    result.between_days =
        between_days_of(campaign, rig_values(problem), shortest_interval(records));
  problem.day_quantities = result.between_days.quantities;
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
    // Two recorded drives never count as the same drive.
    const std::string signal = condition.waveform == datasets::Waveform::recorded
                                   ? "recorded, " + condition.id
                                   : signal_name(campaign, condition);
    for (ParityResidual& record : result.conditions[i].records) {
      record.signal = signal;
      record.healthy = is_healthy(campaign, condition);
      record.leak_level = condition.leak_level;
    }
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& each) { return each.signal == signal; });
    if (group == groups.end()) group = groups.insert(groups.end(), {signal, {}});
    group->places.push_back(i);
  }
  Work work(campaign, records, options, result);
  for (const Group& group : groups) work.judge(group);
  work.check_false_alarms();
  for (const ParityCondition& condition : result.conditions) {
    for (const ParityResidual& record : condition.records) {
      const std::string day = day_label(*campaign.find(condition.condition));
      auto& days = result.between_days.other_days;
      if (record.days.norm() > 0.0 && std::find(days.begin(), days.end(), day) == days.end())
        days.push_back(day);
    }
  }
  if (const auto text = in_words(result.between_days)) result.warnings.push_back(*text);
  warn_of_undated(campaign, result);
  return result;
}

}  // namespace rigcal::diagnosis
