#include "diagnosis/machine/leak_trend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/calendar.hpp"
#include "common/significant.hpp"
#include "metrics/trend.hpp"

namespace rigcal::diagnosis {
namespace {

/// A trend with a p-value below this is significant.
constexpr double kSignificantTrend = 0.05;

/// A state with its date as a number of days.
struct DatedState {
  const MachineState* state = nullptr;
  int day = 0;
};

struct DatedMachine {
  StateKey key;  ///< without date
  std::vector<DatedState> states;
};

std::vector<DatedMachine> dated_machines(const std::vector<MachineState>& states) {
  std::vector<DatedMachine> machines;
  for (const MachineState& state : states) {
    const auto day = state.key.date ? day_of(*state.key.date) : std::nullopt;
    if (!state.ok() || !day) continue;
    const StateKey key{state.key.leak_level, state.key.specimen, {}};
    auto machine = std::find_if(machines.begin(), machines.end(),
                                [&](const DatedMachine& each) { return each.key == key; });
    if (machine == machines.end()) machine = machines.insert(machines.end(), {key, {}});
    machine->states.push_back({&state, *day});
  }
  for (DatedMachine& each : machines) {
    std::sort(each.states.begin(), each.states.end(),
              [](const DatedState& a, const DatedState& b) { return a.day < b.day; });
  }
  return machines;
}

metrics::Trend line_through(const std::vector<DatedState>& states,
                            const Eigen::MatrixXd& rig_covariance, const DayVariance& variance) {
  std::vector<double> days, coefficients;
  std::vector<metrics::EstimateError> errors;
  Eigen::MatrixXd moves(static_cast<Eigen::Index>(states.size()), rig_covariance.rows());
  const Eigen::Index quantities = states.front().state->pooled.day_moves.size();
  Eigen::MatrixXd day_moves = Eigen::MatrixXd::Zero(moves.rows(), quantities);
  for (const DatedState& each : states) {
    const PooledLeak& pooled = each.state->pooled;
    if (pooled.day_moves.size() == quantities)
      day_moves.row(static_cast<Eigen::Index>(days.size())) = pooled.day_moves.transpose();
    if (moves.cols() > 0)
      moves.row(static_cast<Eigen::Index>(days.size())) = pooled.rig_moves.transpose();
    days.push_back(each.day - states.front().day);
    coefficients.push_back(pooled.coefficient);
    errors.push_back({pooled.error.own_se, pooled.error.freedom});
  }
  // Errors in the rig's parameters shift the coefficients of all dates together, and so does the
  // deviation on the day of the reference. In addition, each date has its own deviation.
  metrics::DaysOfPoints between;
  between.covariance = variance.factor * day_moves * day_moves.transpose();
  between.freedom = variance.freedom;
  between.counted = between.covariance.trace() > 0.0;
  return metrics::weighted_trend(days, coefficients, errors,
                                 moves * rig_covariance * moves.transpose(), between);
}

/// Predicts when the line reaches the next limit.
///
/// @param rate  change in the share per day, with its interval
std::optional<NextLimit> foresee(const DatedState& last, double rate, const Range& ci95,
                                 const datasets::DiagnosisSettings& settings) {
  const double share = last.state->estimate.share;
  const auto next = std::upper_bound(settings.limits.begin(), settings.limits.end(), share);
  if (next == settings.limits.end()) return std::nullopt;
  const auto day = [&](double per_day) { return last.day + (*next - share) / per_day; };
  NextLimit limit;
  limit.class_ =
      datasets::kLeakClasses[static_cast<std::size_t>(next - settings.limits.begin()) + 1];
  limit.percent = kInPercent * *next;
  limit.reached_day = day(rate);
  limit.reached = date_of(limit.reached_day);
  limit.earliest = date_of(day(ci95.high));
  if (ci95.low > 0.0) {
    limit.latest_day = day(ci95.low);
    limit.latest = date_of(*limit.latest_day);
  }
  return limit;
}

LeakTrend trend_of(const DatedMachine& machine, const Eigen::MatrixXd& rig_covariance,
                   const datasets::DiagnosisSettings& settings, const DayVariance& variance) {
  const metrics::Trend line = line_through(machine.states, rig_covariance, variance);
  const MachineState& last = *machine.states.back().state;
  const double rate = last.share_slope * line.slope;
  const Range ci95{last.share_slope * line.ci95_low, last.share_slope * line.ci95_high};
  LeakTrend trend;
  trend.leak_level = machine.key.leak_level;
  trend.specimen = machine.key.specimen;
  trend.duty = last.duty.value_or("");
  trend.first_date = date_of(machine.states.front().day);
  trend.last_date = date_of(machine.states.back().day);
  trend.dates = static_cast<int>(machine.states.size());
  trend.coefficient_per_day = line.slope;
  trend.coefficient_per_day_error = line.slope_standard_error / line.widened;
  trend.share_percent_per_day = kInPercent * rate;
  trend.share_percent_per_day_ci95 = kInPercent * ci95;
  trend.p_value = line.p_value;
  trend.significant = trend.p_value < kSignificantTrend;
  trend.chi_squared = line.chi_square;
  trend.freedom = static_cast<double>(machine.states.size() - 2);
  trend.widened = line.widened;
  if (trend.significant && line.slope > 0.0)
    trend.next_limit = foresee(machine.states.back(), rate, ci95, settings);
  return trend;
}

/// Number of days over which the change is reported.
constexpr double kDays = 30.0;

std::string machine_of(const LeakTrend& trend) {
  const std::string name = StateKey{trend.leak_level, trend.specimen, {}}.name();
  return name.empty() ? "The machine" : name;
}

/// Returns true if a day is too far in the future to be predicted from the records.
bool is_far(const LeakTrend& trend, double day) {
  const int last_day = day_of(trend.last_date).value();
  return day - last_day > kAhead * (last_day - day_of(trend.first_date).value());
}

std::string next_limit_of(const LeakTrend& trend) {
  const auto& limit = trend.next_limit;
  if (!limit || is_far(trend, limit->reached_day)) return {};
  const bool open = !limit->latest_day || is_far(trend, *limit->latest_day);
  return fmt::format(" At this rate it reaches {} ({:g} %) about {} ({} to {}).",
                     to_string(limit->class_), limit->percent, limit->reached, limit->earliest,
                     open ? "no upper limit" : *limit->latest);
}

}  // namespace

std::string trend_sentence(const LeakTrend& trend) {
  const auto [low, high] = trend.share_percent_per_day_ci95;
  const double error = std::max(0.005, kDays * (high - low) / 4.0);
  const auto text = [&](double per_day) { return to_uncertainty(kDays * per_day, error); };
  const std::string over =
      fmt::format("over {} dates from {} to {}, {}", trend.dates, trend.first_date, trend.last_date,
                  p_value_text(trend.p_value));
  std::string sentence;
  if (!trend.significant) {
    sentence = fmt::format(
        "{}: no significant trend ({}): {} to {} percentage points of the servo flow in {:g} days "
        "at {}.",
        machine_of(trend), over, text(low), text(high), kDays, trend.duty);
  } else {
    const bool rises = trend.share_percent_per_day > 0.0;
    sentence = fmt::format(
        "{}: the leak {} by {} percentage points of the servo flow in {:g} days ({} to {}) at {} "
        "({}).",
        machine_of(trend), rises ? "rises" : "falls", text(std::abs(trend.share_percent_per_day)),
        kDays, text(rises ? low : -high), text(rises ? high : -low), trend.duty, over);
  }
  if (trend.widened > 1.0)
    sentence +=
        " The points scatter about the line by more than their errors; the interval is widened "
        "accordingly.";
  return sentence + next_limit_of(trend);
}

std::vector<LeakTrend> leak_trends(const std::vector<MachineState>& states,
                                   const Eigen::MatrixXd& rig_covariance,
                                   const datasets::DiagnosisSettings& settings,
                                   const DayVariance& variance) {
  std::vector<LeakTrend> trends;
  for (const DatedMachine& machine : dated_machines(states)) {
    if (machine.states.size() >= metrics::kLeastTrendPoints)
      trends.push_back(trend_of(machine, rig_covariance, settings, variance));
  }
  for (LeakTrend& trend : trends) trend.sentence = trend_sentence(trend);
  return trends;
}

std::vector<std::string> too_few_dates(const std::vector<MachineState>& states) {
  std::vector<std::string> texts;
  for (const DatedMachine& machine : dated_machines(states)) {
    if (machine.states.size() != 2) continue;
    const std::string name = machine.key.name();
    texts.push_back(fmt::format(
        "{}{} and {} are only two dates, not enough for a trend: they may differ because supply or "
        "oil differed; a third date shows the variation between dates",
        name.empty() ? "" : name + ": ", *machine.states[0].state->key.date,
        *machine.states[1].state->key.date));
  }
  return texts;
}

}  // namespace rigcal::diagnosis
