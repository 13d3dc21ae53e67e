#include "calib/problem/initial_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "datasets/draft/start_motion.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;
using datasets::Channel;
using datasets::Condition;
using datasets::InitialMode;
using datasets::Record;

/// Minimum half-widths of the bounds if a record shows no motion, in m, m/s and Pa, or in rad and
/// rad/s.
constexpr double kLeastTravel_m = 1e-6;
constexpr double kLeastSpeed_m_per_s = 1e-6;
constexpr double kLeastPressure_pa = 1e3;

/// Returns the recorded mean of a channel; empty if it was not recorded.
std::vector<double> recorded(const Record& record, Channel channel) {
  const auto found = record.channels.find(channel);
  return found == record.channels.end() ? std::vector<double>{} : found->second.mean;
}

/// Returns the reading of a load pressure sensor, or the load pressure computed from the two
/// chamber pressures. Empty if neither was recorded.
std::vector<double> load_pressure(const Record& record, const model::ParameterValues& values) {
  if (auto direct = recorded(record, Channel::load_pressure); !direct.empty()) return direct;
  std::vector<double> a = recorded(record, Channel::pressure_a);
  const std::vector<double> b = recorded(record, Channel::pressure_b);
  if (a.empty() || b.empty()) return {};
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), [&](double p_a, double p_b) {
    const double P_A = (p_a - values["pressure_a_offset"]) / values["pressure_a_gain"];
    const double P_B = (p_b - values["pressure_b_offset"]) / values["pressure_b_gain"];
    return values["load_pressure_gain"] * (P_A - P_B) + values["load_pressure_offset"];
  });
  return a;
}

double initial_mean(const Record& record, const std::vector<double>& signal, double window_s) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < signal.size(); ++i) {
    if (i > 0 && record.time_s[i] - record.time_s.front() > window_s) break;
    sum += signal[i];
    ++count;
  }
  return sum / count;
}

double peak_to_peak(const std::vector<double>& signal) {
  const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
  return *high - *low;
}

double fastest_change(const Record& record, const std::vector<double>& signal) {
  double fastest = 0.0;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    fastest = std::max(
        fastest, std::abs(signal[i] - signal[i - 1]) / (record.time_s[i] - record.time_s[i - 1]));
  }
  return fastest;
}

/// Keys of the initial value and rate of the motion.
struct InitialKeys {
  std::string_view value;
  std::string_view rate;
};
InitialKeys initial_keys(const Campaign& campaign) {
  if (motion_channel(campaign) == Channel::angle)
    return {"initial_angle", "initial_angular_velocity"};
  return {"initial_position", "initial_velocity"};
}

/// An initial_* parameter, with its value from the record and its allowed deviation.
struct Guess {
  std::string_view key;
  double value = 0.0;
  double half_width = 0.0;
  bool recorded = false;
};

}  // namespace

InitialPlan plan_initial_state(const Campaign& campaign, const Condition& condition,
                               const Record& record, const model::ParameterValues& values) {
  InitialPlan plan;
  if (campaign.initial == InitialMode::rest) return plan;
  plan.state = model::InitialState::given;
  const Channel motion = motion_channel(campaign);
  const auto position = record.channels.find(motion);
  if (position == record.channels.end() || position->second.mean.empty()) {
    throw InputError(
        condition.where,
        fmt::format("condition \"{}\": `initial` is \"{}\", but no {} is "
                    "recorded: expected a channel {}, or initial = \"rest\"",
                    condition.id, campaign.initial == InitialMode::fit ? "fit" : "record",
                    info(motion).key, info(motion).key));
  }
  const InitialKeys keys = initial_keys(campaign);
  const auto& x = position->second.mean;
  const double window_s = campaign.initial_window_s;
  const double supply_pa = values["supply_pressure"];
  std::vector<Guess> guesses{
      {keys.value, initial_mean(record, x, window_s), std::max(peak_to_peak(x), kLeastTravel_m),
       true},
      {keys.rate, 0.0, std::max(fastest_change(record, x), kLeastSpeed_m_per_s), true},
  };
  const auto add_pressure = [&](std::string_view key, const std::vector<double>& signal,
                                double unrecorded_pa) {
    if (model::parameter_index(campaign.rig.plant, key) < 0) return;
    if (signal.empty()) {
      guesses.push_back({key, unrecorded_pa, std::max(supply_pa, kLeastPressure_pa), false});
    } else {
      guesses.push_back({key, initial_mean(record, signal, window_s),
                         std::max(peak_to_peak(signal), kLeastPressure_pa), true});
    }
  };
  add_pressure("initial_load_pressure", load_pressure(record, values), 0.0);
  add_pressure("initial_pressure_a", recorded(record, Channel::pressure_a), 0.5 * supply_pa);
  add_pressure("initial_pressure_b", recorded(record, Channel::pressure_b), 0.5 * supply_pa);
  // A rig that has settled before the run starts with the speed and pressures at which it settled.
  if (campaign.rig.before == model::Before::steady) guesses.resize(1);
  for (const Guess& guess : guesses) {
    const int index = model::parameter_index(campaign.rig.plant, guess.key);
    if (campaign.setting(index) != nullptr || known_in(campaign, condition, index)) continue;
    if (campaign.initial == InitialMode::record) {
      if (!guess.recorded) continue;  // the model then starts in equilibrium with the load
      plan.known.emplace_back(index, guess.value);
    } else {
      plan.unknowns.push_back({index, datasets::Scope::condition, condition.id, guess.value,
                               guess.value - guess.half_width, guess.value + guess.half_width,
                               std::nullopt, true});
    }
  }
  return plan;
}

std::string moving_start(const Campaign& campaign, const std::vector<const Condition*>& conditions,
                         const std::vector<Record>& records) {
  if (campaign.initial != InitialMode::record) return {};
  std::vector<std::string> moving;
  double farthest = 0.0;
  for (const Condition* condition : conditions) {
    const auto record = std::find_if(records.begin(), records.end(), [&](const Record& each) {
      return each.condition == condition->id;
    });
    if (record == records.end()) continue;
    const auto moved = datasets::motion_at_start(
        record->time_s, recorded(*record, motion_channel(campaign)), campaign.initial_window_s);
    if (!moved) continue;
    moving.push_back(condition->id);
    farthest = std::max(farthest, *moved);
  }
  if (moving.empty()) return {};
  const std::size_t shown = std::min<std::size_t>(moving.size(), 3);
  const std::string more = moving.size() > shown ? fmt::format(", ... ({})", moving.size()) : "";
  moving.resize(shown);
  return fmt::format(
      "the {} moves by up to {:.3g} {} within the initial_window of {:g} s ({}{}), and its "
      "mean "
      "there is not where the run starts: expected rest within the window, a shorter one, or "
      "initial = \"fit\"",
      info(motion_channel(campaign)).key, farthest, info(motion_channel(campaign)).unit,
      campaign.initial_window_s, fmt::join(moving, ", "), more);
}

}  // namespace rigcal::calib
