#include "datasets/prepare/condition_repeats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "datasets/prepare/decimate.hpp"
#include "datasets/prepare/spikes.hpp"

namespace rigcal::datasets {
namespace {

/// Drives are excluded because they may jump on purpose.
bool is_measured(Channel channel) { return !is_drive(channel); }

/// A spike and the repeat that contains it.
struct Found {
  const Repeat* repeat = nullptr;
  Spike spike;
};

/// Describes the spikes in one channel: their number, and the largest ones.
std::string spikes_text(Channel channel, std::vector<Found> found) {
  constexpr std::size_t kMostNamed = 3;
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    return std::abs(a.spike.height) > std::abs(b.spike.height);
  });
  std::set<const Repeat*> repeats;
  for (const Found& each : found) repeats.insert(each.repeat);
  std::string text =
      fmt::format("{}: {} spike{} in {} repeat{}", info(channel).key, found.size(),
                  found.size() == 1 ? "" : "s", repeats.size(), repeats.size() == 1 ? "" : "s");
  for (std::size_t i = 0; i < std::min(found.size(), kMostNamed); ++i) {
    const Spike& spike = found[i].spike;
    text += fmt::format("{} {} sample {} ({:.6g} s) {:+.3g} {}",
                        i > 0              ? ","
                        : found.size() > 1 ? ", the largest:"
                                           : ":",
                        found[i].repeat->source, spike.sample + 1,
                        found[i].repeat->time_s[spike.sample], spike.height, info(channel).unit);
  }
  return text;
}

void treat_spikes(const Campaign& campaign, std::vector<Repeat>& repeats, Conditioning& done) {
  const bool exclude = campaign.spikes == SpikeTreatment::exclude;
  std::map<Channel, std::vector<Found>> found;
  std::size_t replaced = 0;
  for (Repeat& repeat : repeats) {
    for (auto& [channel, values] : repeat.values) {
      if (!is_measured(channel)) continue;
      const std::vector<Spike> spikes = find_spikes(values);
      for (const Spike& spike : spikes) {
        found[channel].push_back({&repeat, spike});
        replaced += spike.length;
      }
      if (exclude && !spikes.empty()) values = without_spikes(std::move(values), spikes);
    }
  }
  for (auto& [channel, spikes] : found)
    done.warnings.push_back(spikes_text(channel, std::move(spikes)) +
                            (exclude ? "; excluded" : "; they stay in the record"));
  if (exclude)
    done.notes.push_back(fmt::format(
        "spikes excluded: {} samples replaced by lines between their neighbours", replaced));
}

/// Marks each decimated sample that was computed from at least one marked sample.
std::vector<bool> decimated_marks(const std::vector<bool>& marks, std::size_t factor) {
  std::vector<bool> result;
  for (std::size_t i = 0; i < marks.size(); i += factor) {
    const auto begin = marks.begin() + static_cast<std::ptrdiff_t>(i - std::min(i, factor - 1));
    const auto end =
        marks.begin() + static_cast<std::ptrdiff_t>(std::min(i + factor, marks.size()));
    result.push_back(std::find(begin, end, true) != end);
  }
  return result;
}

void decimate(const Campaign& campaign, std::vector<Repeat>& repeats, Conditioning& done) {
  const double wanted_hz = *campaign.decimate_to_hz;
  const std::size_t factor = decimation_factor(repeats.front(), wanted_hz);
  for (const Repeat& repeat : repeats) {
    const std::size_t own = decimation_factor(repeat, wanted_hz);
    if (own != factor)
      throw std::invalid_argument(
          fmt::format("decimate_to takes every {}th sample of {} but every {}th of {}: repeats of "
                      "one condition "
                      "must be sampled at the same rate",
                      factor, repeats.front().source, own, repeat.source));
  }
  if (factor == 1) {
    done.notes.push_back(
        fmt::format("not decimated: no denser than decimate_to = {:.6g} Hz", wanted_hz));
    return;
  }
  const AntiAliasFilter filter = anti_alias_filter(factor);
  for (Repeat& repeat : repeats) {
    for (auto& [channel, values] : repeat.values)
      values = campaign.is_held_input(channel) ? decimated_hold(values, factor)
                                               : decimated(values, filter);
    std::vector<double> time_s;
    for (std::size_t i = 0; i < repeat.time_s.size(); i += factor)
      time_s.push_back(repeat.time_s[i]);
    repeat.time_s = std::move(time_s);
    repeat.bridged = decimated_marks(repeat.bridged, factor);
  }
  done.noise_gain = filter.noise_gain();
  done.notes.push_back(
      fmt::format("decimated {}-fold to {:.6g} Hz; zero-phase FIR of {} taps (-6 dB at {:.6g} Hz), "
                  "which leaves "
                  "{:.3g} of the sd of white noise",
                  factor, wanted_hz, filter.taps.size(), 0.5 * wanted_hz, done.noise_gain));
}

}  // namespace

Conditioning condition_repeats(const Campaign& campaign, std::vector<Repeat>& repeats) {
  Conditioning done;
  treat_spikes(campaign, repeats, done);
  if (campaign.decimate_to_hz) decimate(campaign, repeats, done);
  return done;
}

}  // namespace rigcal::datasets
