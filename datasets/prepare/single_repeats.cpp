#include "datasets/prepare/single_repeats.hpp"

#include <algorithm>
#include <cmath>

#include "datasets/prepare/alignment.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/resample.hpp"
#include "datasets/prepare/time_holes.hpp"

namespace rigcal::datasets {
namespace {

/// A record of one repeat holds numbers only: at the ends that it does not cover, its nearest
/// sample, which `covered` keeps from counting.
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

Record single_record(const Record& average, const Repeat& repeat, double shift, std::size_t begin,
                     std::size_t samples, TimeWindow& covered) {
  Record record;
  record.condition = average.condition;
  record.time_s = average.time_s;
  record.windows = average.windows;
  std::size_t first = 0;
  std::size_t last = record.time_s.size() - 1;
  for (const auto& [channel, values] : repeat.values) {
    const bool held = is_drive(channel);
    auto x =
        shifted(values, shift, samples, held ? Interpolator::linear : Interpolator::band_limited);
    Series series;
    series.mean.assign(x.begin() + static_cast<std::ptrdiff_t>(begin),
                       x.begin() + static_cast<std::ptrdiff_t>(begin + record.time_s.size()));
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
  const AlignedRepeats aligned = align(repeats, campaign.alignment == Alignment::correlate);
  const std::vector<double>& base = repeats.front().time_s;
  const auto begin = static_cast<std::size_t>(
      std::find(base.begin(), base.end(), result.average.time_s.front()) - base.begin());
  for (std::size_t r = 0; r < repeats.size(); ++r) {
    result.singles.push_back(single_record(result.average, repeats[r], aligned.shift[r], begin,
                                           base.size(), result.covered.emplace_back()));
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
