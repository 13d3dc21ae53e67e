#include "datasets/prepare/average.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "datasets/checks/mains_hum.hpp"
#include "datasets/checks/median.hpp"
#include "datasets/checks/repeat_checks.hpp"
#include "datasets/prepare/alignment.hpp"
#include "datasets/prepare/bridged_holes.hpp"
#include "datasets/prepare/lag.hpp"
#include "datasets/prepare/resample.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// One channel from the repeats that have it, on the common time base; NaN where a repeat has no
/// sample.
struct Stack {
  std::vector<std::size_t> carriers;  ///< indices of the repeats
  std::vector<std::vector<double>> rows;
};

/// A drive must not ring at its edges; a measured signal must keep its noise and amplitude.
Interpolator interpolator_of(Channel channel) {
  return is_drive(channel) ? Interpolator::linear : Interpolator::band_limited;
}

std::map<Channel, Stack> stack_channels(const std::vector<Repeat>& repeats,
                                        const std::vector<double>& shift) {
  std::map<Channel, Stack> stacks;
  const std::size_t samples = repeats.front().time_s.size();
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    for (const auto& [channel, values] : repeats[r].values) {
      stacks[channel].carriers.push_back(r);
      auto row = shifted(values, shift[r], samples, interpolator_of(channel));
      forget_bridged(row, repeats[r].bridged, shift[r]);
      stacks[channel].rows.push_back(std::move(row));
    }
  }
  return stacks;
}

/// Whether every channel has a value from at least one repeat at sample i.
bool is_covered(const std::map<Channel, Stack>& stacks, std::size_t i) {
  return std::all_of(stacks.begin(), stacks.end(), [i](const auto& entry) {
    return std::any_of(entry.second.rows.begin(), entry.second.rows.end(),
                       [i](const auto& row) { return !std::isnan(row[i]); });
  });
}

/// Removes samples at which a channel has no value from any repeat, which happens in bridged holes.
void drop_uncovered(std::map<Channel, Stack>& stacks, std::vector<double>& time_s) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < time_s.size(); ++i)
    if (is_covered(stacks, i)) kept.push_back(i);
  const auto keep = [&kept](std::vector<double>& x) {
    for (std::size_t k = 0; k < kept.size(); ++k) x[k] = x[kept[k]];
    x.resize(kept.size());
  };
  keep(time_s);
  for (auto& [channel, stack] : stacks)
    for (auto& row : stack.rows) keep(row);
}

/// Samples [begin, end).
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Returns the longest run of samples at which every channel has at least one repeat.
Span covered_span(const std::map<Channel, Stack>& stacks, std::size_t samples) {
  Span longest;
  Span run;
  for (std::size_t i = 0; i < samples; ++i) {
    if (!is_covered(stacks, i))
      run = {i + 1, i + 1};
    else
      run.end = i + 1;
    if (run.end - run.begin > longest.end - longest.begin) longest = run;
  }
  return longest;
}

/// Returns the value from the first row that has sample i.
double value_at(const Stack& stack, std::size_t i) {
  const auto found = std::find_if(stack.rows.begin(), stack.rows.end(),
                                  [i](const auto& row) { return !std::isnan(row[i]); });
  return (*found)[i];
}

bool all_equal(const Stack& stack, std::size_t i) {
  const double value = value_at(stack, i);
  return std::all_of(stack.rows.begin(), stack.rows.end(),
                     [&](const auto& row) { return std::isnan(row[i]) || row[i] == value; });
}

/// Computes mean, sd and count at each sample of a span.
Series moments(const Stack& stack, Span span) {
  Series series;
  series.repeats = static_cast<int>(stack.rows.size());
  const bool several = stack.rows.size() > 1;
  // Reserves the exact size: a growing vector would keep up to twice the memory for the life of the
  // record.
  series.mean.reserve(span.end - span.begin);
  series.count.reserve(span.end - span.begin);
  if (several) series.sd.reserve(span.end - span.begin);
  double sum_of_variances = 0.0;
  long with_variance = 0;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    double sum = 0.0;
    int count = 0;
    for (const auto& row : stack.rows) {
      if (std::isnan(row[i])) continue;
      sum += row[i];
      ++count;
    }
    // A sum of equal values may be rounded. A command that all repeats share would then seem to
    // have noise.
    const double mean = all_equal(stack, i) ? value_at(stack, i) : sum / count;
    series.mean.push_back(mean);
    series.count.push_back(count);
    if (!several) continue;
    double squares = 0.0;
    for (const auto& row : stack.rows)
      if (!std::isnan(row[i])) squares += (row[i] - mean) * (row[i] - mean);
    series.sd.push_back(count > 1 ? std::sqrt(squares / (count - 1)) : kNan);
    if (count < 2) continue;
    sum_of_variances += squares / (count - 1);
    ++with_variance;
  }
  if (with_variance > 0)
    series.pooled_sd = std::sqrt(sum_of_variances / static_cast<double>(with_variance));
  return series;
}

/// Returns each row minus the mean, over the span.
std::vector<std::vector<double>> deviations_from(const Stack& stack, const Series& series,
                                                 Span span) {
  std::vector<std::vector<double>> result;
  for (const auto& row : stack.rows) {
    std::vector<double>& own = result.emplace_back();
    own.reserve(span.end - span.begin);
    for (std::size_t i = span.begin; i < span.end; ++i)
      own.push_back(row[i] - series.mean[i - span.begin]);
  }
  return result;
}

bool any_differs(const std::vector<std::vector<double>>& deviations) {
  return std::any_of(deviations.begin(), deviations.end(), [](const auto& own) {
    return std::any_of(own.begin(), own.end(), [](double x) { return x != 0.0; });
  });
}

/// Sets the standard deviations by which a fit divides the residuals.
void conclude_sd(Series& series, Channel channel, const AverageOptions& options,
                 std::vector<std::string>& warnings) {
  const auto known = options.known_sd.find(channel);
  if (series.pooled_sd > 0.0) {
    series.sd_of_mean = series.pooled_sd / std::sqrt(series.repeats);
    return;
  }
  if (series.pooled_sd == 0.0 && info(channel).is_output)
    warnings.push_back(
        fmt::format("{}: the repeats are identical, so the noise is unknown", info(channel).key));
  series.pooled_sd = known == options.known_sd.end() ? kNan : known->second;
  series.sd_of_mean = series.pooled_sd;
}

double rms_over(Span span, const auto& difference) {
  double squares = 0.0;
  long count = 0;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    const double d = difference(i);
    if (std::isnan(d)) continue;
    squares += d * d;
    ++count;
  }
  return count == 0 ? 0.0 : std::sqrt(squares / static_cast<double>(count));
}

/// Returns the rms distance of each row from the mean of the other rows.
std::vector<double> distances_from_others(const Stack& stack, const Series& series, Span span) {
  std::vector<double> distances;
  for (const auto& row : stack.rows)
    distances.push_back(rms_over(span, [&](std::size_t i) {
      const std::size_t at = i - span.begin;
      const double n = series.count[at];
      // x - (n mean - x) / (n - 1)
      return n < 2.0 ? kNan : (row[i] - series.mean[at]) * n / (n - 1.0);
    }));
  return distances;
}

/// Returns the rms distance of each row from the sample-wise median of all rows.
std::vector<double> distances_from_median(const Stack& stack, Span span) {
  std::vector<double> centre(span.end, kNan);
  std::vector<double> values;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    values.clear();
    for (const auto& row : stack.rows)
      if (!std::isnan(row[i])) values.push_back(row[i]);
    centre[i] = median(values);
  }
  std::vector<double> distances;
  for (const auto& row : stack.rows)
    distances.push_back(rms_over(span, [&](std::size_t i) { return row[i] - centre[i]; }));
  return distances;
}

/// Returns the standard deviation of the noise in one row. Computes it from second differences, in
/// which anything that is smooth over three samples cancels.
double noise_sd(const std::vector<double>& row, Span span) {
  if (span.end - span.begin < 3) return 0.0;
  const Span inner{span.begin + 1, span.end - 1};
  return rms_over(inner, [&](std::size_t i) { return row[i - 1] - 2.0 * row[i] + row[i + 1]; }) /
         std::sqrt(6.0);
}

/// Warns if two repeats differ by more than their noise. Either of them may be wrong.
void warn_of_pair(const Stack& stack, const Series& series, Channel channel, Span span,
                  const AverageOptions& options, const std::vector<Repeat>& repeats,
                  std::vector<std::string>& warnings) {
  const auto& a = stack.rows[0];
  const auto& b = stack.rows[1];
  const double distance = rms_over(span, [&](std::size_t i) { return a[i] - b[i]; });
  const double expected = std::hypot(noise_sd(a, span), noise_sd(b, span));
  const auto [low, high] = std::minmax_element(series.mean.begin(), series.mean.end());
  if (distance <= options.outlier_ratio * expected || distance <= 0.01 * (*high - *low)) return;
  warnings.push_back(fmt::format(
      "{}: {} and {} differ by {:.3g} {} rms, {:.3g} % of the range; with only two repeats it is "
      "unknown which one is wrong",
      info(channel).key, repeats[stack.carriers[0]].source, repeats[stack.carriers[1]].source,
      distance, info(channel).unit, 100.0 * distance / (*high - *low)));
}

/// Warns of repeats that are copies of one recording.
void warn_of_copies(const Stack& stack, const std::vector<std::size_t>& first, Channel channel,
                    const std::vector<Repeat>& repeats, std::vector<std::string>& warnings) {
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] == k) continue;
    warnings.push_back(
        fmt::format("{}: {} and {} are identical, like one recording given twice; both are used, "
                    "so the noise is underestimated",
                    info(channel).key, repeats[stack.carriers[first[k]]].source,
                    repeats[stack.carriers[k]].source));
  }
}

/// Returns the rows that are not copies of an earlier one.
Stack distinct_rows(const Stack& stack, const std::vector<std::size_t>& first) {
  Stack distinct;
  for (std::size_t k = 0; k < first.size(); ++k) {
    if (first[k] != k) continue;
    distinct.carriers.push_back(stack.carriers[k]);
    distinct.rows.push_back(stack.rows[k]);
  }
  return distinct;
}

/// Marks the outliers in one channel and warns of them.
/// @param stack  without copies, which would confirm each other
void warn_of_outliers(const Stack& stack, Channel channel, Span span, const AverageOptions& options,
                      Record& record) {
  const auto from_median = distances_from_median(stack, span);
  const double typical = median(from_median);
  for (std::size_t k = 0; k < stack.rows.size(); ++k) {
    if (!(from_median[k] > options.outlier_ratio * typical)) continue;
    RepeatReport& report = record.repeat_reports[stack.carriers[k]];
    report.outlier = true;
    record.warnings.push_back(fmt::format(
        "{}: {} is {:.3g} {} rms from the median of the {} repeats, {}; {}", info(channel).key,
        report.source, from_median[k], info(channel).unit, stack.rows.size(),
        typical > 0.0 ? fmt::format("{:.3g} times as far as is typical", from_median[k] / typical)
                      : std::string("where the others agree exactly"),
        kStaysInMean));
  }
}

/// Sets the deviation of each repeat, and warns of copies and outliers in one channel.
void judge_repeats(const Stack& stack, const Series& series, Channel channel, Span span,
                   const AverageOptions& options, const std::vector<Repeat>& repeats,
                   Record& record) {
  if (stack.rows.size() < 2 || !(series.pooled_sd > 0.0)) return;
  const auto from_others = distances_from_others(stack, series, span);
  for (std::size_t k = 0; k < stack.rows.size(); ++k) {
    RepeatReport& report = record.repeat_reports[stack.carriers[k]];
    report.deviation = std::max(report.deviation, from_others[k] / series.pooled_sd);
  }
  const auto first = first_identical(repeats, stack.carriers, channel);
  const Stack distinct = distinct_rows(stack, first);
  if (distinct.rows.size() == 1) return;  // conclude_sd() warns of this
  warn_of_copies(stack, first, channel, repeats, record.warnings);
  if (distinct.rows.size() == 2)
    warn_of_pair(distinct, series, channel, span, options, repeats, record.warnings);
  else
    warn_of_outliers(distinct, channel, span, options, record);
}

/// Warns of mains hum and of coarse converter steps, which neither the mean of the repeats nor
/// their standard deviation reveals.
/// @param deviations  deviations of each row from the mean
void warn_of_noise(const std::vector<std::vector<double>>& deviations, const Series& series,
                   Channel channel, const AverageOptions& options,
                   const std::vector<Repeat>& repeats, std::vector<std::string>& warnings) {
  if (!info(channel).is_output || !(series.pooled_sd > 0.0)) return;
  const ChannelInfo& about = info(channel);
  const std::vector<double>& time_s = repeats.front().time_s;
  const double rate_hz = static_cast<double>(time_s.size() - 1) / (time_s.back() - time_s.front());
  if (const auto hum = mains_hum(deviations, rate_hz, options.drive_hz)) {
    warnings.push_back(
        fmt::format("{}: hum of the mains, {:.0f} Hz with an amplitude of {:.2g} {} in every "
                    "repeat; the part that remains in their mean is treated as noise",
                    about.key, hum->frequency_hz, hum->amplitude, about.unit));
  }
  if (const auto step = coarse_step(repeats, channel, series.pooled_sd)) {
    warnings.push_back(
        fmt::format("{}: readings come in steps of {:.3g} {}, and the repeats differ by only "
                    "{:.2g} {}: the same rounding error is in each repeat and in their mean, and "
                    "their differences do not show it",
                    about.key, *step, about.unit, series.pooled_sd, about.unit));
  }
}

/// Warns of repeats that leave more than 1 % of the record uncovered.
void warn_of_gaps(const std::vector<Repeat>& repeats, const std::vector<double>& shift,
                  std::vector<std::string>& warnings) {
  const auto samples = static_cast<double>(repeats.front().time_s.size());
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    const auto own = static_cast<double>(repeats[r].time_s.size());
    const double begin = std::max(0.0, -shift[r]);
    const double end = std::min(samples, own - shift[r]);
    if (end - begin < 0.99 * samples)
      warnings.push_back(fmt::format("{} covers {:.3g} % of the samples of {}", repeats[r].source,
                                     100.0 * std::max(0.0, end - begin) / samples,
                                     repeats.front().source));
    if (own > 1.01 * samples)
      warnings.push_back(fmt::format(
          "{} is longer than {}, which determines the length: {:.0f} of its samples are used",
          repeats[r].source, repeats.front().source, std::max(0.0, end - begin)));
  }
}

}  // namespace

Record average(const std::string& condition, const std::vector<Repeat>& repeats,
               const AverageOptions& options) {
  const AlignedRepeats aligned = align(repeats, options.align);
  std::vector<double> time_s = repeats.front().time_s;
  auto stacks = stack_channels(repeats, aligned.shift);
  if (std::any_of(repeats.begin(), repeats.end(),
                  [](const Repeat& repeat) { return !repeat.bridged.empty(); }))
    drop_uncovered(stacks, time_s);
  const Span span = covered_span(stacks, time_s.size());
  if (span.end == span.begin)
    throw std::invalid_argument(fmt::format(
        "the repeats of {} have no sample at which every channel is recorded", condition));

  Record record;
  record.condition = condition;
  record.warnings = aligned.warnings;
  record.repeats =
      repeats.size() == 1 ? options.repeats_averaged : static_cast<int>(repeats.size());
  for (std::size_t r = 0; r < repeats.size(); ++r)
    record.repeat_reports.push_back({repeats[r].source, aligned.offset_s[r], 0.0, false,
                                     aligned.shifted_s[r], aligned.shift[r]});
  record.time_s.assign(time_s.begin() + static_cast<std::ptrdiff_t>(span.begin),
                       time_s.begin() + static_cast<std::ptrdiff_t>(span.end));
  warn_of_gaps(repeats, aligned.shift, record.warnings);
  for (const auto& [channel, stack] : stacks) {
    Series series = moments(stack, span);
    conclude_sd(series, channel, options, record.warnings);
    judge_repeats(stack, series, channel, span, options, repeats, record);
    if (stack.rows.size() > 1) {
      auto deviations = deviations_from(stack, series, span);
      warn_of_noise(deviations, series, channel, options, repeats, record.warnings);
      if (options.keep_deviations &&
          (!is_drive(channel) || channel == Channel::command ||
           channel == Channel::pilot_pressure || any_differs(deviations)))
        series.deviations = std::move(deviations);
    }
    if (repeats.size() == 1) series.repeats = options.repeats_averaged;
    record.channels.emplace(channel, std::move(series));
  }
  if (repeats.size() == 1 && options.repeats_averaged == 1)
    record.warnings.emplace_back("a single repeat: its repeatability is unknown");
  return record;
}

}  // namespace rigcal::datasets
