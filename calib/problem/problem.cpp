#include "calib/problem/problem.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/problem/initial_state.hpp"
#include "calib/problem/known_values.hpp"
#include "calib/problem/simulation_task.hpp"
#include "datasets/synthetic/model_output.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;
using datasets::Record;

/// Initial guess for an unknown standard deviation, as a fraction of the peak-to-peak value.
constexpr double kGuessedNoise = 1e-2;
/// kDefaultTolerance is the simulation tolerance if the noise is unknown, and the upper limit if it
/// is known; kLeastTolerance is the lower limit. When the steps of a simulation change, cost and
/// gradient jump by about the tolerance, and such jumps stall the optimiser.
constexpr double kDefaultTolerance = 1e-6;
constexpr double kLeastTolerance = 1e-8;
/// Maximum tolerance for a record whose noise or measured errors allow a less exact simulation than
/// those of others. Above it, the derivatives would be too inaccurate.
constexpr double kLargestTolerance = 1e-5;
/// Tolerance for derivatives that are only used to compute an uncertainty.
constexpr double kDerivativeTolerance = 1e-5;
/// Tolerance far from an optimum. A smaller tolerance would not save the optimiser any steps.
constexpr double kCoarseTolerance = 1e-4;
/// A residual below this fraction of the peak-to-peak value, the resolution of a 20-bit sensor, is
/// not noise.
constexpr double kLeastShare = 1e-6;

const Record& record_of(const Condition& condition, const std::vector<Record>& records) {
  const auto found = std::find_if(records.begin(), records.end(), [&](const Record& record) {
    return record.condition == condition.id;
  });
  if (found == records.end() || found->time_s.empty()) {
    throw InputError(condition.where, fmt::format("condition \"{}\" has no record: expected "
                                                  "`repeats` or `averaged`",
                                                  condition.id));
  }
  return *found;
}

/// Rejects values in counts, which would be taken for metres, pascals and seconds.
void require_units(const Campaign& campaign, const Condition& condition) {
  const bool counted =
      campaign.time_in_counts ||
      std::any_of(campaign.channels.begin(), campaign.channels.end(), [](const auto& entry) {
        return entry.second.in_counts && entry.second.role != datasets::ChannelRole::ignore;
      });
  if (!counted) return;
  throw InputError(condition.where,
                   fmt::format("condition \"{}\": {}", condition.id,
                               fmt::join(lacks_for_model(campaign, condition), "; ")));
}

ProblemChannel make_channel(const Campaign& campaign, const ProblemCondition& condition,
                            Channel channel) {
  const datasets::Series& series = condition.record->channels.at(channel);
  ProblemChannel result;
  result.channel = channel;
  for (const std::size_t row : condition.rows) {
    const double value = series.mean.at(row);
    if (!std::isfinite(value)) {
      throw InputError(condition.condition->where,
                       fmt::format("condition \"{}\": sample {} of channel {} at {} s is not a "
                                   "finite number",
                                   condition.condition->id, row, datasets::info(channel).key,
                                   condition.record->time_s[row]));
    }
    result.measured.push_back(value);
  }
  const auto [low, high] = std::minmax_element(result.measured.begin(), result.measured.end());
  result.peak_to_peak = *high - *low;
  result.sd = known_sd(campaign, channel, series);
  result.sd_known = std::isfinite(result.sd);
  return result;
}

/// Sets the unknown noise of each channel to a fraction of the channel's largest peak-to-peak value
/// over all conditions. There is only one value per channel, as in estimate_weights().
void guess_unknown_sd(std::vector<ProblemCondition>& conditions) {
  std::map<Channel, double> largest;
  for (const ProblemCondition& condition : conditions) {
    for (const ProblemChannel& channel : condition.channels) {
      double& range = largest[channel.channel];
      range = std::max(range, channel.peak_to_peak);
    }
  }
  for (ProblemCondition& condition : conditions) {
    for (ProblemChannel& channel : condition.channels) {
      if (channel.sd_known) continue;
      const double range = largest[channel.channel];
      if (!(range > 0.0)) {
        throw InputError(
            condition.condition->where,
            fmt::format(
                "condition \"{}\": channel {} is constant, and without repeats or `sd` its "
                "noise is unknown, so it has no weight: expected `sd`, or role = \"ignore\"",
                condition.condition->id, datasets::info(channel.channel).key));
      }
      channel.sd = kGuessedNoise * range;
    }
  }
}

/// Returns the number of rows within one period after the first row if the drive is periodic, or
/// otherwise the number of all rows.
std::size_t count_first_period(const ProblemCondition& condition) {
  const Condition& settings = *condition.condition;
  if (!is_periodic(settings.waveform) || !settings.frequency_hz || !(*settings.frequency_hz > 0.0))
    return condition.rows.size();
  const auto& time_s = condition.record->time_s;
  const double end_s = time_s[condition.rows.front()] + 1.0 / *settings.frequency_hz;
  const auto last = std::find_if(condition.rows.begin(), condition.rows.end(),
                                 [&](std::size_t row) { return time_s[row] > end_s; });
  return static_cast<std::size_t>(last - condition.rows.begin());
}

ProblemCondition make_condition(const Campaign& campaign, const std::vector<Record>& records,
                                const Condition& condition,
                                const std::vector<datasets::FittedValue>* fitted) {
  ProblemCondition result;
  require_units(campaign, condition);
  result.condition = &condition;
  result.record = &record_of(condition, records);
  result.rig = campaign.rig;
  result.values = fitted != nullptr ? values_with(campaign, condition, *fitted)
                                    : datasets::values_in(campaign, condition);
  result.inputs = datasets::inputs_of(campaign, condition, result.values, result.record);
  result.rows = samples_that_count(condition, *result.record);
  const auto channels = output_channels(campaign, *result.record);
  if (channels.empty()) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": no recorded channel can be compared with the "
                                 "model: expected position, load_pressure, pressure_a, pressure_b "
                                 "or force with role \"output\"",
                                 condition.id));
  }
  for (const Channel channel : channels) {
    result.channels.push_back(make_channel(campaign, result, channel));
    result.outputs.push_back(datasets::model_output(channel).value());
  }
  result.first_period_rows = count_first_period(result);
  // Budget for simulating the start point. Later points get a budget based on the steps taken
  // there.
  result.max_steps = ample_steps(result.record->time_s.size());
  return result;
}

/// Returns the smallest ratio of standard deviation to peak-to-peak value among the outputs of a
/// condition. Returns 0 if a standard deviation is unknown, and infinity if no output moves.
double relative_noise(const ProblemCondition& condition) {
  double least = std::numeric_limits<double>::infinity();
  for (const ProblemChannel& channel : condition.channels) {
    if (!channel.sd_known) return 0.0;
    if (channel.peak_to_peak > 0.0) least = std::min(least, channel.sd / channel.peak_to_peak);
  }
  return least;
}

}  // namespace

std::size_t ProblemCondition::rows_at(const Fidelity& fidelity) const {
  if (fidelity.whole()) return rows.size();
  const auto& time_s = record->time_s;
  const double end_s = time_s[rows.front()] + fidelity.horizon_s;
  const auto end = rows.begin() + static_cast<std::ptrdiff_t>(first_period_rows);
  const auto last = std::partition_point(rows.begin(), end,
                                         [&](std::size_t row) { return time_s[row] <= end_s; });
  return static_cast<std::size_t>(last - rows.begin());
}

bool Problem::repeats_itself() const {
  return std::any_of(conditions.begin(), conditions.end(), [](const ProblemCondition& each) {
    return each.first_period_rows < each.rows.size();
  });
}

model::SimulationOptions Problem::simulation_options(const std::atomic<bool>* own) const {
  model::SimulationOptions options = calib::simulation_options(*campaign);
  options.tolerance = tolerance;
  options.cancel = own != nullptr ? own : cancel;
  return options;
}

double Problem::coarse_tolerance() const { return std::max(kCoarseTolerance, tolerance); }

double Problem::tolerance_of(std::size_t condition, const Fidelity& fidelity) const {
  if (!fidelity.exact) return coarse_tolerance();
  if (tolerance_fixed) return tolerance;
  const double measured = conditions[condition].measured_tolerance;
  if (measured > 0.0) return std::max(tolerance, std::min(measured, kLargestTolerance));
  double least = std::numeric_limits<double>::infinity();
  for (const ProblemCondition& each : conditions) least = std::min(least, relative_noise(each));
  const double own = relative_noise(conditions[condition]);
  if (!(least > 0.0) || !std::isfinite(own)) return tolerance;
  return std::max(tolerance, std::min(tolerance * (own / least), kLargestTolerance));
}

model::SimulationOptions Problem::derivative_options(std::size_t condition) const {
  model::SimulationOptions options = simulation_options();
  options.tolerance = tolerance_of(condition);
  if (!tolerance_fixed) options.tolerance = std::max(options.tolerance, kDerivativeTolerance);
  return options;
}

double Problem::share_at(const Fidelity& fidelity) const {
  std::size_t seen = 0;
  std::size_t all = 0;
  for (const ProblemCondition& each : conditions) {
    seen += each.rows_at(fidelity) * each.channels.size();
    all += each.rows.size() * each.channels.size();
  }
  return static_cast<double>(seen) / static_cast<double>(all);
}

double Problem::shortest_interval_s() const {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const ProblemCondition& each : conditions) {
    const auto& time_s = each.record->time_s;
    if (time_s.size() < 2) continue;
    shortest_s = std::min(
        shortest_s, (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1));
  }
  return shortest_s;
}

long Problem::residual_count() const {
  std::size_t count = 0;
  for (const ProblemCondition& condition : conditions)
    count += condition.rows.size() * condition.channels.size();
  for (const Unknown& unknown : map.unknowns()) count += unknown.prior ? 1 : 0;
  return static_cast<long>(count);
}

bool Problem::has_estimated_sd() const {
  return std::any_of(conditions.begin(), conditions.end(), [](const ProblemCondition& condition) {
    return std::any_of(condition.channels.begin(), condition.channels.end(),
                       [](const ProblemChannel& channel) { return !channel.sd_known; });
  });
}

double Problem::least_sd(const ProblemChannel& channel) const {
  const double range = channel.peak_to_peak > 0.0 ? channel.peak_to_peak : channel.sd;
  // At this level, simulation errors move an estimate by at most one of its standard errors.
  const double resolved = tolerance * std::sqrt(static_cast<double>(residual_count()));
  return std::max(kLeastShare, resolved) * range;
}

double Problem::least_noise() const {
  double least = 0.0;
  for (const ProblemCondition& condition : conditions) {
    for (const ProblemChannel& channel : condition.channels)
      least = std::max(least, channel.sd_known ? 1.0 : least_sd(channel) / channel.sd);
  }
  return least;
}

model::ParameterValues Problem::values_at(std::size_t condition, std::span<const double> z) const {
  model::ParameterValues values = conditions[condition].values;
  for (const int j : map.acting(condition)) {
    const auto u = static_cast<std::size_t>(j);
    values.set(map.unknowns()[u].index, map.to_physical(j, z[u]));
  }
  return values;
}

std::vector<double> Problem::to_physical(std::span<const double> z) const {
  std::vector<double> values(z.size());
  for (std::size_t j = 0; j < z.size(); ++j) values[j] = map.to_physical(static_cast<int>(j), z[j]);
  return values;
}

std::vector<double> Problem::start() const {
  std::vector<double> z(map.unknowns().size());
  for (std::size_t j = 0; j < z.size(); ++j)
    z[j] = map.to_unit(static_cast<int>(j), map.unknowns()[j].start);
  return z;
}

const model::ParameterSpec& Problem::spec(std::size_t unknown) const {
  const auto row = static_cast<std::size_t>(map.unknowns()[unknown].index);
  return model::parameter_table(campaign->rig.plant)[row];
}

std::string Problem::name(std::size_t unknown) const {
  const Unknown& u = map.unknowns()[unknown];
  return parameter_label(std::string(spec(unknown).name), u.scope, u.level);
}

std::vector<Channel> output_channels(const Campaign& campaign, const Record& record) {
  std::vector<Channel> result;
  for (const auto& [channel, series] : record.channels) {
    const auto setting = campaign.channels.find(channel);
    if (!datasets::info(channel).is_output || setting == campaign.channels.end() ||
        setting->second.role != datasets::ChannelRole::output) {
      continue;
    }
    const auto& listed = campaign.fit.outputs;
    if (listed.empty() || std::find(listed.begin(), listed.end(), channel) != listed.end())
      result.push_back(channel);
  }
  return result;
}

std::vector<std::size_t> samples_that_count(const Condition& condition, const Record& record) {
  const auto& windows = condition.moving_windows ? record.windows : condition.windows;
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < record.time_s.size(); ++i) {
    const double t = record.time_s[i];
    const bool counts = windows.empty() || std::any_of(windows.begin(), windows.end(),
                                                       [t](const datasets::TimeWindow& w) {
                                                         return t >= w.start_s && t <= w.end_s;
                                                       });
    if (counts) rows.push_back(i);
  }
  if (rows.empty()) {
    throw InputError(condition.where,
                     fmt::format("condition \"{}\": no sample is inside its windows; the record "
                                 "goes from {:g} s to {:g} s",
                                 condition.id, record.time_s.front(), record.time_s.back()));
  }
  return rows;
}

/// With n residuals, a simulation error e moves an estimate by up to e sqrt(n) / sd standard
/// errors. Because the tolerance is an upper bound for e, a factor of 0.1 keeps this below about a
/// thirtieth.
double tolerance_from_noise(const std::vector<ProblemCondition>& conditions, bool estimated) {
  double least = std::numeric_limits<double>::infinity();
  std::size_t residuals = 0;
  for (const ProblemCondition& condition : conditions) {
    residuals += condition.rows.size() * condition.channels.size();
    for (const ProblemChannel& channel : condition.channels) {
      if ((channel.sd_known || estimated) && channel.peak_to_peak > 0.0)
        least = std::min(least, channel.sd / channel.peak_to_peak);
    }
  }
  if (!std::isfinite(least)) return kDefaultTolerance;
  return std::clamp(0.1 * least / std::sqrt(static_cast<double>(residuals)), kLeastTolerance,
                    kDefaultTolerance);
}

Problem make_problem(const Campaign& campaign, const std::vector<Record>& records,
                     const std::vector<const Condition*>& conditions, bool nuisance_only,
                     const std::vector<datasets::FittedValue>* fitted) {
  std::vector<ProblemCondition> prepared;
  std::vector<Unknown> initial_unknowns;
  for (const Condition* condition : conditions) {
    ProblemCondition& each =
        prepared.emplace_back(make_condition(campaign, records, *condition, fitted));
    const InitialPlan plan = plan_initial_state(campaign, *condition, *each.record, each.values);
    each.rig.initial = plan.state;
    for (const auto& [index, value] : plan.known) each.values.set(index, value);
    initial_unknowns.insert(initial_unknowns.end(), plan.unknowns.begin(), plan.unknowns.end());
  }
  guess_unknown_sd(prepared);
  std::vector<int> repeats;
  for (const ProblemCondition& each : prepared) repeats.push_back(each.record->repeats);

  Problem problem{&campaign,
                  ParameterMap(campaign, conditions, nuisance_only, initial_unknowns, repeats),
                  std::move(prepared), campaign.simulation.tolerance.value_or(0.0),
                  campaign.simulation.tolerance.has_value()};
  if (!problem.tolerance_fixed) problem.tolerance = tolerance_from_noise(problem.conditions, false);
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    for (const int j : problem.map.acting(i)) {
      const auto u = static_cast<std::size_t>(j);
      problem.conditions[i].free.push_back(problem.map.unknowns()[u].index);
    }
  }
  return problem;
}

double known_sd(const datasets::Campaign& campaign, datasets::Channel channel,
                const datasets::Series& series) {
  if (std::isfinite(series.sd_of_mean) && series.sd_of_mean > 0.0) return series.sd_of_mean;
  const auto sd = campaign.channels.at(channel).sd;
  return sd && *sd > 0.0 ? *sd : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace rigcal::calib
