#include "datasets/prepare/bridged_holes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "common/error.hpp"
#include "datasets/prepare/time_holes.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kLostSample = 1.5;  // median steps: at least one sample is missing
constexpr double kRounding = 1e-9;   // relative to the length of a hole

/// Returns the number of samples that are missing before each sample.
std::vector<std::size_t> missing_before(const std::vector<double>& time_s, double longest_s) {
  const double step_s = median_step(time_s);
  std::vector<std::size_t> missing(time_s.size(), 0);
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    const double own_s = time_s[i] - time_s[i - 1];
    if (own_s <= kLostSample * step_s || own_s > longest_s * (1.0 + kRounding)) continue;
    const double lost = std::round(own_s / step_s) - 1.0;
    // Capped, because the caller refuses a record with more missing samples than samples.
    missing[i] = static_cast<std::size_t>(std::min(lost, static_cast<double>(time_s.size()) + 1.0));
  }
  return missing;
}

/// Inserts the missing samples, evenly spaced in each hole.
std::vector<double> filled(const std::vector<double>& x, const std::vector<std::size_t>& missing,
                           bool held) {
  std::vector<double> result;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t k = 1; k <= missing[i]; ++k) {
      const double part = static_cast<double>(k) / static_cast<double>(missing[i] + 1);
      result.push_back(held ? x[i - 1] : x[i - 1] + part * (x[i] - x[i - 1]));
    }
    result.push_back(x[i]);
  }
  return result;
}

}  // namespace

void bridge_holes(const Campaign& campaign, Repeat& repeat) {
  if (!campaign.longest_bridge_s || campaign.time_in_counts || repeat.time_s.size() < 3) return;
  const auto missing = missing_before(repeat.time_s, *campaign.longest_bridge_s);
  std::size_t lost = 0;
  for (const std::size_t each : missing) lost += each;
  if (lost == 0) return;
  if (lost > repeat.time_s.size())
    throw InputError({campaign.file.string()},
                     fmt::format("{}: more samples are missing than the {} recorded; expected a "
                                 "shorter recording.longest_hole, or the file split into parts",
                                 repeat.source, repeat.time_s.size()));
  repeat.bridged.clear();
  for (const std::size_t each : missing) {
    repeat.bridged.insert(repeat.bridged.end(), each, true);
    repeat.bridged.push_back(false);
  }
  repeat.time_s = filled(repeat.time_s, missing, false);
  for (auto& [channel, values] : repeat.values)
    values = filled(values, missing, campaign.is_held_input(channel));
  std::erase_if(repeat.holes, [&](const TimeHole& hole) {
    return hole.to_s - hole.from_s <= *campaign.longest_bridge_s * (1.0 + kRounding);
  });
}

void forget_bridged(std::vector<double>& row, const std::vector<bool>& bridged, double shift) {
  if (bridged.empty()) return;
  // As in shifted(): a whole shift reads one sample, any other shift reads both neighbours.
  const double nearest = std::round(shift);
  const bool whole = std::abs(shift - nearest) < 1e-6;
  const auto below = static_cast<std::ptrdiff_t>(whole ? nearest : std::floor(shift));
  const auto is_bridged = [&bridged](std::ptrdiff_t at) {
    return at >= 0 && at < std::ssize(bridged) && bridged[static_cast<std::size_t>(at)];
  };
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(i) + below;
    if (is_bridged(at) || (!whole && is_bridged(at + 1)))
      row[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::vector<std::string> bridged_notes(const std::vector<Repeat>& repeats) {
  std::vector<std::string> notes;
  for (const Repeat& repeat : repeats) {
    std::size_t holes = 0;
    std::size_t longest = 0;
    std::size_t behind_longest = 0;
    std::size_t run = 0;
    for (std::size_t i = 0; i < repeat.bridged.size(); ++i) {
      if (!repeat.bridged[i]) {
        run = 0;
        continue;
      }
      if (run == 0) ++holes;
      if (++run > longest) {
        longest = run;
        behind_longest = i + 1;
      }
    }
    if (holes == 0) continue;
    const auto samples = std::count(repeat.bridged.begin(), repeat.bridged.end(), true);
    notes.push_back(fmt::format(
        "{}: holes bridged: {} sample{} missing in {} place{}, the longest between {:.6g} s and "
        "{:.6g} s; nothing is compared there",
        repeat.source, samples, samples == 1 ? " is" : "s are", holes, holes == 1 ? "" : "s",
        repeat.time_s[behind_longest - longest - 1], repeat.time_s[behind_longest]));
  }
  return notes;
}

std::string guessed_drive_warning(const Campaign& campaign, const Condition& condition,
                                  const Record& record) {
  if (!campaign.longest_bridge_s || condition.waveform != Waveform::recorded) return {};
  const auto holes = time_holes(record.time_s);
  if (holes.empty()) return {};
  const Channel drive = drive_channel(campaign);
  const auto longest = std::max_element(
      holes.begin(), holes.end(),
      [](const TimeHole& a, const TimeHole& b) { return a.to_s - a.from_s < b.to_s - b.from_s; });
  return fmt::format(
      "the {} was not recorded in {} hole{}, the longest between {:.6g} s and {:.6g} s: the model "
      "uses {}; no interval includes the difference from the real drive",
      info(drive).key, holes.size(), holes.size() == 1 ? "" : "s", longest->from_s, longest->to_s,
      campaign.is_held_input(drive) ? "its last value" : "a line across");
}

}  // namespace rigcal::datasets
