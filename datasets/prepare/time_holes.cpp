#include "datasets/prepare/time_holes.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/error.hpp"
#include "datasets/checks/median.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kLongestStep = 3.0;  // in median steps

bool counts(const TimeHole& hole, const std::vector<TimeWindow>& windows, bool is_felt_later) {
  return windows.empty() || std::any_of(windows.begin(), windows.end(), [&](const TimeWindow& own) {
           return hole.from_s < own.end_s && (is_felt_later || hole.to_s > own.start_s);
         });
}

}  // namespace

double median_step(const std::vector<double>& time_s) {
  std::vector<double> steps;
  steps.reserve(time_s.size());
  for (std::size_t i = 1; i < time_s.size(); ++i) steps.push_back(time_s[i] - time_s[i - 1]);
  return median(std::move(steps));
}

std::vector<TimeHole> time_holes(const std::vector<double>& time_s) {
  if (time_s.size() < 3) return {};
  const double longest = kLongestStep * median_step(time_s);
  std::vector<TimeHole> holes;
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (time_s[i] - time_s[i - 1] > longest) holes.push_back({i + 1, time_s[i - 1], time_s[i]});
  return holes;
}

std::vector<std::string> holes_in_what_counts(const Campaign& campaign, const Condition& condition,
                                              const std::vector<Repeat>& repeats,
                                              const std::vector<TimeWindow>& windows) {
  const bool is_felt_later = condition.waveform == Waveform::recorded &&
                             campaign.rig.controller == model::ControllerKind::none;
  std::vector<std::string> texts;
  for (const Repeat& repeat : repeats) {
    std::vector<TimeHole> holes = repeat.holes;
    std::erase_if(holes,
                  [&](const TimeHole& hole) { return !counts(hole, windows, is_felt_later); });
    if (holes.empty()) continue;
    const TimeHole& first = holes.front();
    const std::string others = holes.size() == 1
                                   ? std::string()
                                   : fmt::format(", and {} more such step{}", holes.size() - 1,
                                                 holes.size() == 2 ? "" : "s");
    texts.push_back(fmt::format(
        "{}: samples are missing before sample {}: nothing between {:.6g} s and {:.6g} s{}; "
        "{}",
        repeat.source, first.row, first.from_s, first.to_s, others,
        is_felt_later
            ? "the command during the hole moves the piston permanently: end the window before it, "
              "save the rest as a separate recording, or bridge it (holes = \"bridge\")"
            : "leave out the hole with two windows, save both sides as separate recordings, or "
              "bridge it (holes = \"bridge\")"));
  }
  return texts;
}

void require_no_holes(const Campaign& campaign, const Record& record) {
  if (record.holes.empty()) return;
  const Condition* condition = campaign.find(record.condition);
  throw InputError(condition == nullptr ? Location{campaign.file.string()} : condition->where,
                   fmt::format("condition \"{}\": {}", record.condition, record.holes.front()));
}

}  // namespace rigcal::datasets
