#include "datasets/prepare/single_repeats.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/prepare/bridged_holes.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/resample.hpp"
#include "datasets/prepare/time_holes.hpp"

namespace rigcal::datasets {
namespace {

/// Fills the ends that a repeat does not cover with its nearest sample, since a record must be
/// finite everywhere. `covered` excludes these ends.
void fill_ends(std::vector<double>& x, std::size_t& first, std::size_t& last) {
  const auto finite = [](double value) { return std::isfinite(value); };
  const auto begin = std::find_if(x.begin(), x.end(), finite);
  const auto end = std::find_if(x.rbegin(), x.rend(), finite).base();
  if (begin == x.end()) return;
  first = std::max(first, static_cast<std::size_t>(begin - x.begin()));
  last = std::min(last, static_cast<std::size_t>(end - x.begin()) - 1);
  std::fill(x.begin(), begin, *begin);
  std::fill(end, x.end(), *(end - 1));
}

/// @param base_s  the common time base
/// @param kept    indices in base_s of the samples that the average has
Record single_record(const Record& average, const Repeat& repeat, double shift,
                     const std::vector<double>& base_s, std::vector<std::size_t> kept,
                     TimeWindow& covered) {
  Record record;
  record.condition = average.condition;
  std::vector<double> bridged = base_s;
  forget_bridged(bridged, repeat.bridged, shift);
  std::erase_if(kept, [&bridged](std::size_t i) { return std::isnan(bridged[i]); });
  for (const std::size_t i : kept) record.time_s.push_back(base_s[i]);
  record.windows = average.windows;
  record.generated_drive = average.generated_drive;
  std::size_t first = 0;
  std::size_t last = record.time_s.size() - 1;
  for (const auto& [channel, values] : repeat.values) {
    const bool held = is_drive(channel);
    auto x = shifted(values, shift, base_s.size(),
                     held ? Interpolator::linear : Interpolator::band_limited);
    Series series;
    for (const std::size_t i : kept) series.mean.push_back(x[i]);
    fill_ends(series.mean, first, last);
    series.count.assign(series.mean.size(), 1);
    series.pooled_sd = average.channels.at(channel).pooled_sd;
    series.sd_of_mean = series.pooled_sd;
    record.channels.emplace(channel, std::move(series));
  }
  covered = {record.time_s[first], record.time_s[last]};
  return record;
}

}  // namespace

RepeatRecords repeat_records(const Campaign& campaign, const Condition& condition,
                             std::vector<Repeat> repeats) {
  RepeatRecords result;
  result.average = average_of(campaign, condition, repeats);
  if (condition.averaged || repeats.size() < 2) return result;
  const std::vector<double>& base = repeats.front().time_s;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < base.size() && kept.size() < result.average.time_s.size(); ++i)
    if (base[i] == result.average.time_s[kept.size()]) kept.push_back(i);
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    const double shift = result.average.repeat_reports[r].shift;
    result.singles.push_back(single_record(result.average, repeats[r], shift, base, kept,
                                           result.covered.emplace_back()));
  }
  return result;
}

RepeatRecords load_repeats(const Campaign& campaign, const Condition& condition) {
  std::vector<FileState> files = files_of(campaign, condition);
  RepeatRecords result = repeat_records(campaign, condition, load_all_repeats(campaign, condition));
  require_no_holes(campaign, result.average);
  result.average.files = std::move(files);
  return result;
}

}  // namespace rigcal::datasets
