#include "bench/leak_law_study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <cstdio>
#include <initializer_list>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bench/foreign_cylinder.hpp"
#include "bench/healthy_rig.hpp"
#include "bench/kept_counts.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "datasets/prepare/load_record.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/diagnose.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;
using datasets::LeakLaw;

/// Standard deviations of white noise in each sample: a position transducer as in the other studies
/// of leaks, and pressure transducers of 100 bar with 0.1 % of their range.
constexpr double kPositionNoise_m = 0.05e-3;
constexpr double kPressureNoise_pa = 1e4;
/// Relative standard deviation of the supply pressure between repeats, as of a regulated pump.
constexpr double kSupplyVariation = 1e-3;
constexpr int kLawRepeats = 5;
constexpr int kLawTrials = 2;  ///< states of the machine of each size in a campaign
constexpr double kFlowsPerMinute = 60e3;
constexpr double kOneFlow_m3_per_s = 1.0 / kFlowsPerMinute;  ///< 1 L/min
constexpr std::array kSizes_l_per_min{0.0, 0.005, 0.01, 0.02};
const std::vector<Reference> kLawSignals{{"sine", 0.5, 0.05, 2.0}, {"square", 1.0, 0.02, 2.0}};

using LawStream = boost::random::mt19937_64;
using Readings = std::vector<std::pair<Channel, std::vector<double>>>;

double noise_of(Channel channel) {
  return channel == Channel::position ? kPositionNoise_m : kPressureNoise_pa;
}

/// Makes repeats of a noise-free record.
///
/// @param by_supply  change in each channel per relative change in the supply pressure; may be
/// empty
std::vector<datasets::Repeat> noisy_repeats(const std::vector<double>& time_s,
                                            const Readings& readings, const Readings& by_supply,
                                            LawStream& stream) {
  boost::random::normal_distribution<double> normal;
  std::vector<datasets::Repeat> repeats;
  for (int r = 0; r < kLawRepeats; ++r) {
    datasets::Repeat& repeat = repeats.emplace_back();
    repeat.source = fmt::format("repeat {}", r + 1);
    repeat.time_s = time_s;
    const double supply = kSupplyVariation * normal(stream);
    for (std::size_t c = 0; c < readings.size(); ++c) {
      const auto& [channel, clean] = readings[c];
      std::vector<double>& values = repeat.values[channel];
      for (std::size_t k = 0; k < clean.size(); ++k) {
        const double moved = by_supply.empty() ? 0.0 : supply * by_supply[c].second[k];
        values.push_back(clean[k] + moved + noise_of(channel) * normal(stream));
      }
    }
  }
  return repeats;
}

/// A campaign to which conditions are added one by one, with their records.
struct LawCampaign {
  datasets::Campaign campaign;
  std::vector<datasets::RepeatRecords> records;

  /// Adds a condition. Single repeats are kept only of healthy records, which are the reference.
  void add(const datasets::Condition& condition, const std::vector<datasets::Repeat>& repeats) {
    campaign.conditions.push_back(condition);
    datasets::RepeatRecords made = datasets::repeat_records(campaign, condition, repeats);
    if (condition.use == datasets::Use::fit) {
      std::vector<datasets::Repeat> averaged = repeats;
      made.average = datasets::average_of(campaign, condition, averaged, true);
    } else {
      made.singles.clear();
      made.covered.clear();
    }
    records.push_back(std::move(made));
  }

  diagnosis::RigFit healthy_fit() const {
    std::vector<datasets::Record> averages;
    for (const auto& each : records) averages.push_back(each.average);
    const calib::Fit fit = calib::fit(campaign, averages, {});
    if (!fit.usable()) throw std::runtime_error("the healthy fit failed: " + fit.message);
    return bench::rig_of(campaign, fit);
  }
};

void set_known(datasets::Campaign& campaign, const char* key, double value) {
  const int index = model::parameter_index(campaign.rig.plant, key);
  std::erase_if(campaign.parameters, [&](const auto& each) { return each.index == index; });
  datasets::ParameterSetting setting;
  setting.index = index;
  setting.value = value;
  campaign.parameters.push_back(setting);
}

/// Frees a parameter, starting 10 % off its true value.
void set_free(datasets::Campaign& campaign, const char* key, double truth) {
  set_known(campaign, key, 1.1 * truth);
  datasets::ParameterSetting& setting = campaign.parameters.back();
  setting.fit = true;
  setting.lower = truth / 5.0;
  setting.upper = 5.0 * truth;
}

struct LawRow {
  std::string name;
  LeakLaw truth = LeakLaw::laminar;
  LeakLaw fitted = LeakLaw::laminar;
  bool pressures = true;  ///< false if the position alone is recorded
};

std::vector<LawRow> law_rows() {
  std::vector<LawRow> rows;
  for (const bool pressures : {true, false}) {
    for (const LeakLaw truth : enumerators_like(LeakLaw{})) {
      for (const LeakLaw fitted : enumerators_like(LeakLaw{})) {
        rows.push_back({fmt::format("{}: {} leak fitted as {}",
                                    pressures ? "position and pressures" : "position alone",
                                    to_string(truth), to_string(fitted)),
                        truth, fitted, pressures});
      }
    }
  }
  return rows;
}

datasets::Campaign law_campaign(const LawRow& row) {
  const ForeignCylinder rig;
  datasets::Campaign campaign;
  campaign.rig.plant = model::PlantKind::two_chamber;
  for (const auto& [key, value] : std::initializer_list<std::pair<const char*, double>>{
           {"mass", rig.mass_kg},
           {"damping", rig.damping_n_s_per_m},
           {"stiffness", 0.0},
           {"area_a", rig.area_m2},
           {"area_b", rig.area_m2},
           {"stroke", rig.stroke_m},
           {"dead_volume_a", rig.dead_volume_m3},
           {"dead_volume_b", rig.dead_volume_m3},
           {"supply_pressure", rig.supply_pa},
           {"tank_pressure", rig.tank_pa},
           {"density", rig.density_kg_per_m3},
           {"discharge_coefficient", rig.discharge},
           {"area_gradient", rig.gradient_m},
           {"leakage_coefficient", 0.0},
           {"leakage_area", rig.leak_area_m2},
           {"leakage_smoothing", rig.straight_below_pa},
           {"kp", rig.kp_v_per_m},
           {"output_limit", rig.limit_v}})
    set_known(campaign, key, value);
  set_free(campaign, "bulk_modulus", rig.bulk_modulus_pa);
  set_free(campaign, "valve_gain", rig.valve_gain_m_per_v);
  std::vector<Channel> channels{Channel::position};
  if (row.pressures) channels.insert(channels.end(), {Channel::pressure_a, Channel::pressure_b});
  for (const Channel channel : channels) campaign.channels[channel].channel = channel;
  campaign.rig.before = model::Before::rest;
  campaign.before_stated = true;
  campaign.considered.none = true;  // the healthy reference takes off what they do without a leak
  campaign.diagnosis.leak_law = row.fitted;
  campaign.diagnosis.level_class["healthy"] = datasets::LeakClass::normal;
  return campaign;
}

Readings channels_of(const CylinderReadings& made, bool pressures) {
  Readings readings{{Channel::position, made.position_m}};
  if (!pressures) return readings;
  readings.emplace_back(Channel::pressure_a, made.pressure_a_pa);
  readings.emplace_back(Channel::pressure_b, made.pressure_b_pa);
  return readings;
}

/// Returns the change in each channel per relative change in the supply pressure.
Readings supply_changes(const Reference& signal, bool pressures) {
  constexpr double kStep = 0.01;
  ForeignCylinder rig;
  rig.supply_pa *= 1.0 + kStep;
  Readings high = channels_of(foreign_readings(rig, signal), pressures);
  rig.supply_pa *= (1.0 - kStep) / (1.0 + kStep);
  const Readings low = channels_of(foreign_readings(rig, signal), pressures);
  for (std::size_t c = 0; c < high.size(); ++c) {
    for (std::size_t k = 0; k < high[c].second.size(); ++k)
      high[c].second[k] = (high[c].second[k] - low[c].second[k]) / (2.0 * kStep);
  }
  return high;
}

/// Returns the rig with a leak whose mean flow over all signals has the given size. The flow of
/// such a small leak is proportional to its coefficient.
ForeignCylinder leaking(LeakLaw law, double l_per_min) {
  ForeignCylinder rig;
  double& own = law == LeakLaw::laminar ? rig.laminar_m3_per_s_pa : rig.leak_coefficient;
  const double trial = law == LeakLaw::laminar ? 1e-12 : 1e-4;
  own = trial;
  double flow = 0.0;
  for (const Reference& signal : kLawSignals)
    flow += foreign_readings(rig, signal).leak_m3_per_s / static_cast<double>(kLawSignals.size());
  own = trial * l_per_min * kOneFlow_m3_per_s / flow;
  return rig;
}

/// Counts for one campaign: one entry for each size, the first without a leak.
struct LawCounts {
  std::array<int, kSizes_l_per_min.size()> states{}, found{}, averages{}, averages_found{};
  std::array<double, kSizes_l_per_min.size()> l_per_min{};  ///< sum of the flows of the averages

  template <typename Take>
  void for_each(Take take) {
    for (auto* each : {&states, &found, &averages, &averages_found})
      for (int& count : *each) take(count);
    for (double& flow : l_per_min) take(flow);
  }
};

datasets::Condition condition_of(const Reference& signal, const std::string& level) {
  datasets::Condition condition;
  condition.id = fmt::format("{}_{}Hz_{}", signal.waveform, signal.frequency_hz, level);
  condition.waveform =
      signal.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
  condition.frequency_hz = signal.frequency_hz;
  condition.amplitude = signal.amplitude_m;
  condition.duration_s = signal.duration_s;
  condition.leak_level = level;
  condition.date = "2026-03-02";
  condition.use = level == "healthy" ? datasets::Use::fit : datasets::Use::diagnose;
  return condition;
}

std::string level_of(std::size_t size, int trial) { return fmt::format("size{}_{}", size, trial); }

LawCounts count_laws(const LawRow& row, std::uint64_t seed) {
  LawStream stream(seed);
  LawCampaign made{law_campaign(row), {}};
  std::vector<Readings> by_supply;
  std::vector<double> time_s;
  for (const Reference& signal : kLawSignals)
    by_supply.push_back(supply_changes(signal, row.pressures));
  const auto add = [&](const ForeignCylinder& rig, const std::vector<std::string>& levels) {
    for (std::size_t s = 0; s < kLawSignals.size(); ++s) {
      const Readings clean = channels_of(foreign_readings(rig, kLawSignals[s]), row.pressures);
      time_s.resize(clean.front().second.size());
      for (std::size_t k = 0; k < time_s.size(); ++k) time_s[k] = static_cast<double>(k) / 1000.0;
      for (const std::string& level : levels)
        made.add(condition_of(kLawSignals[s], level),
                 noisy_repeats(time_s, clean, by_supply[s], stream));
    }
  };
  add(ForeignCylinder(), {"healthy"});
  const diagnosis::RigFit rig = made.healthy_fit();
  for (std::size_t i = 0; i < kSizes_l_per_min.size(); ++i) {
    std::vector<std::string> levels;
    for (int trial = 0; trial < kLawTrials; ++trial) levels.push_back(level_of(i, trial));
    add(leaking(row.truth, kSizes_l_per_min.at(i)), levels);
  }
  const diagnosis::Diagnosis found = diagnosis::diagnose(made.campaign, made.records, rig, {});
  LawCounts counts;
  const auto size_of = [](const std::string& level) -> std::optional<std::size_t> {
    for (std::size_t i = 0; i < kSizes_l_per_min.size(); ++i) {
      for (int trial = 0; trial < kLawTrials; ++trial)
        if (level == level_of(i, trial)) return i;
    }
    return std::nullopt;
  };
  for (const diagnosis::RecordDiagnosis& record : found.records) {
    const auto size = size_of(made.campaign.find(record.condition)->leak_level.value());
    if (!size || record.repeat) continue;
    if (!record.fit.ok()) throw std::runtime_error(record.fit.failure);
    ++counts.averages.at(*size);
    counts.averages_found.at(*size) += record.estimate.leak_detected ? 1 : 0;
    counts.l_per_min.at(*size) += kFlowsPerMinute * record.estimate.leak_flow_m3_per_s;
  }
  for (const diagnosis::MachineState& state : found.states) {
    const auto size = size_of(state.key.leak_level.value_or(""));
    if (!size) continue;
    ++counts.states.at(*size);
    counts.found.at(*size) += state.ok() && state.estimate.leak_detected ? 1 : 0;
  }
  return counts;
}

std::string percent_of(int part, int all) {
  return fmt::format("{:.0f} ({} of {})", 100.0 * part / std::max(1, all), part, all);
}

template <typename Counts, typename Make>
std::vector<Counts> counted(const StudyRange& range, KeptCounts<Counts>& kept,
                            const std::string& row, Make make) {
  std::vector<Counts> all(range.last - range.first + 1);
  parallel_for(all.size(), range.threads,
               [&](std::size_t i) { all[i] = kept.of(row, range.first + i, make); });
  return all;
}

/// Adds up the counts of all campaigns.
template <typename Counts>
Counts sum_of(std::vector<Counts> all) {
  Counts sum;
  for (Counts& each : all) {
    std::vector<double> values;
    each.for_each([&](auto& value) { values.push_back(static_cast<double>(value)); });
    std::size_t next = 0;
    sum.for_each(
        [&](auto& value) { value += static_cast<std::decay_t<decltype(value)>>(values[next++]); });
  }
  return sum;
}

}  // namespace

void study_leak_laws(const StudyRange& range, const std::string& only) {
  KeptCounts<LawCounts> kept(range.file);
  fmt::print("| records, true and fitted law | false alarms of machines, % |");
  for (std::size_t i = 1; i < kSizes_l_per_min.size(); ++i)
    fmt::print(" {} L/min found, % |", kSizes_l_per_min.at(i));
  fmt::print(
      " false alarms of averages, % | 0.01 L/min found in an average, % | flow found there, L/min "
      "|\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  constexpr std::size_t kGoal = 2;  // 0.01 L/min
  for (const LawRow& row : law_rows()) {
    if (row.name.find(only) == std::string::npos) continue;
    const LawCounts sum = sum_of(
        counted(range, kept, row.name, [&](std::uint64_t seed) { return count_laws(row, seed); }));
    fmt::print("| {} |", row.name);
    for (std::size_t i = 0; i < kSizes_l_per_min.size(); ++i)
      fmt::print(" {} |", percent_of(sum.found.at(i), sum.states.at(i)));
    fmt::print(" {} | {} | {:.4f} |\n", percent_of(sum.averages_found[0], sum.averages[0]),
               percent_of(sum.averages_found[kGoal], sum.averages[kGoal]),
               sum.l_per_min[kGoal] / std::max(1, sum.averages[kGoal]));
    std::fflush(stdout);
  }
}

namespace {

/// A record of the other simulator, and the healthy record of the same signal.
struct OtherCase {
  const char* id;
  const char* healthy;
  double conductance_m3_per_s_pa;
  double l_per_min;  ///< mean |leakage flow| in the record (column q_leak_m3_s)
};
constexpr const char* kSlowSine = "sine_0p1hz_noleak_kp79_w2000_vd0";
constexpr const char* kSlowSquare = "square_0p1hz_noleak_kp79_w2000_vd0";
constexpr const char* kFastSquare = "square_10hz_noleak_kp79_w2000_vd0";
/// The first three are the healthy records themselves, with noise of their own.
constexpr std::array kOtherCases{
    OtherCase{kSlowSine, kSlowSine, 0.0, 0.0},
    OtherCase{kSlowSquare, kSlowSquare, 0.0, 0.0},
    OtherCase{kFastSquare, kFastSquare, 0.0, 0.0},
    OtherCase{"sine_0p1hz_lam5em12_kp79_w2000_vd0", kSlowSine, 5e-12, 0.00354},
    OtherCase{"square_0p1hz_lam2em11_kp79_w2000_vd0", kSlowSquare, 2e-11, 0.01135},
    OtherCase{"square_10hz_lam1em12_kp79_w2000_vd0", kFastSquare, 1e-12, 0.00770},
    OtherCase{"square_10hz_lam2em11_kp79_w2000_vd0", kFastSquare, 2e-11, 0.03167}};

/// Counts for one campaign: one entry for each case.
struct OtherCounts {
  std::array<int, kOtherCases.size()> averages{}, found{};
  std::array<double, kOtherCases.size()> l_per_min{};

  template <typename Take>
  void for_each(Take take) {
    for (int& count : averages) take(count);
    for (int& count : found) take(count);
    for (double& flow : l_per_min) take(flow);
  }
};

std::string diagnosed_id(const OtherCase& each) { return fmt::format("{}_diagnosed", each.id); }

/// Returns the campaign of the records with all values known, except bulk modulus and valve gain.
datasets::Campaign other_campaign(const std::filesystem::path& folder, LeakLaw law) {
  const std::string rigs = RIGCAL_SOURCE_DIR "/datasets/rigs/hopsan_leaky_servo/";
  datasets::Campaign campaign = datasets::load_campaign(rigs + "two_chamber.toml", folder);
  campaign.channels = datasets::load_campaign(rigs + "two_chamber_fit.toml", folder).channels;
  campaign.simulation.tolerance.reset();
  for (const char* key : {"bulk_modulus", "valve_gain"}) {
    const int index = model::parameter_index(campaign.rig.plant, key);
    set_free(campaign, key, campaign.setting(index)->value);
  }
  campaign.considered.none = true;
  campaign.diagnosis.leak_law = law;
  campaign.diagnosis.level_class["none"] = datasets::LeakClass::normal;
  return campaign;
}

OtherCounts count_other(const datasets::Campaign& all, std::uint64_t seed) {
  LawStream stream(seed);
  LawCampaign made{all, {}};
  made.campaign.conditions.clear();
  const auto add = [&](const char* of, const std::string& id, const std::string& level,
                       datasets::Use use) {
    const datasets::Condition* source = all.find(of);
    if (source == nullptr) throw std::runtime_error(fmt::format("no condition \"{}\"", of));
    datasets::Condition condition = *source;
    const datasets::Repeat clean = datasets::load_all_repeats(all, condition).front();
    Readings readings;
    for (const auto& [channel, setting] : all.channels)
      readings.emplace_back(channel, clean.values.at(channel));
    condition.id = id;
    condition.leak_level = level;
    condition.date = "2026-03-02";
    condition.use = use;
    made.add(condition, noisy_repeats(clean.time_s, readings, {}, stream));
  };
  for (const char* healthy : {kSlowSine, kSlowSquare, kFastSquare})
    add(healthy, healthy, "none", datasets::Use::fit);
  const diagnosis::RigFit rig = made.healthy_fit();
  for (const OtherCase& each : kOtherCases)
    add(each.id, diagnosed_id(each), diagnosed_id(each), datasets::Use::diagnose);
  const diagnosis::Diagnosis found = diagnosis::diagnose(made.campaign, made.records, rig, {});
  OtherCounts counts;
  for (const diagnosis::RecordDiagnosis& record : found.records) {
    for (std::size_t i = 0; i < kOtherCases.size(); ++i) {
      if (record.condition != diagnosed_id(kOtherCases.at(i))) continue;
      if (!record.fit.ok()) throw std::runtime_error(record.fit.failure);
      ++counts.averages.at(i);
      counts.found.at(i) += record.estimate.leak_detected ? 1 : 0;
      counts.l_per_min.at(i) += kFlowsPerMinute * record.estimate.leak_flow_m3_per_s;
    }
  }
  return counts;
}

}  // namespace

void study_other_simulator(const std::filesystem::path& folder, const StudyRange& range) {
  KeptCounts<OtherCounts> kept(range.file);
  std::vector<OtherCounts> sums;
  for (const LeakLaw law : {LeakLaw::laminar, LeakLaw::orifice}) {
    const datasets::Campaign campaign = other_campaign(folder, law);
    sums.push_back(
        sum_of(counted(range, kept, fmt::format("fitted as {}", to_string(law)),
                       [&](std::uint64_t seed) { return count_other(campaign, seed); })));
  }
  fmt::print(
      "| record | conductance, m3/(s Pa) | leak, L/min | found as laminar, % | flow, L/min | found "
      "as orifice, % | flow, L/min |\n| --- | --- | --- | --- | --- | --- | --- |\n");
  for (std::size_t i = 0; i < kOtherCases.size(); ++i) {
    const OtherCase& each = kOtherCases.at(i);
    fmt::print("| `{}` | {:g} | {:.4f} |", each.id, each.conductance_m3_per_s_pa, each.l_per_min);
    for (const OtherCounts& sum : sums)
      fmt::print(" {} | {:.4f} |", percent_of(sum.found.at(i), sum.averages.at(i)),
                 sum.l_per_min.at(i) / std::max(1, sum.averages.at(i)));
    fmt::print("\n");
  }
}

}  // namespace rigcal::bench
