// Measures how often 95 % intervals cover the truth if the rig has a small effect that the fitted
// model lacks, and how often the verdict is a plain PASS although an interval misses the truth by
// more than three half-widths (false assurance). Also measures how often residual tests of the
// validation record reject, and how often the two-sided uncertainty of a score covers the score
// against the true motion. The records come from bench/foreign_rig.hpp, which has no code in common
// with the product. Prints the second table of docs/uncertainty.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <mutex>
#include <numbers>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench/foreign_campaign.hpp"
#include "bench/foreign_day.hpp"
#include "calib/fit.hpp"
#include "common/parallel.hpp"
#include "common/significant.hpp"
#include "datasets/prepare/load_record.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::bench {
namespace {

using datasets::Channel;

constexpr double kNoise_m = 0.05e-3;
constexpr double kOff = 1.1;

/// A rig, and the references of its records.
struct Bench {
  ForeignRig rig;
  std::vector<Reference> fitted{
      {"square", 1.0, 0.05, 2.0}, {"square", 4.0, 0.02, 1.0}, {"sine", 5.0, 0.02, 1.0}};
  Reference validated{"sine", 2.0, 0.05, 1.0};
};

/// Seed for the fresh rows, whose rigs, amplitudes and noise were not used for choosing sizes in
/// the catalogue.
constexpr unsigned kFreshSeed = 7'042'026;

/// Draws another rig of the same kind with other amplitudes. Values differ from the usual ones by
/// up to a quarter, amplitudes by up to a third.
Bench drawn_bench(boost::random::mt19937_64& stream) {
  boost::random::uniform_real_distribution<double> quarter(0.75, 1.25);
  boost::random::uniform_real_distribution<double> third(0.67, 1.33);
  Bench bench;
  for (double ForeignRig::*value :
       {&ForeignRig::mass_kg, &ForeignRig::damping_n_s_per_m, &ForeignRig::bulk_modulus_pa,
        &ForeignRig::valve_gain_m_per_v, &ForeignRig::leak_coefficient})
    bench.rig.*value *= quarter(stream);
  for (Reference& each : bench.fitted) each.amplitude_m *= third(stream);
  bench.validated.amplitude_m *= third(stream);
  return bench;
}

/// An effect in the rig, with the plausible size from the catalogue.
struct ForeignEffect {
  const char* name;
  double plausible;
  bool one_sided;
  void (*apply)(ForeignRig&, double size);
  bool first_only = false;  ///< the effect acts in the first record only
};

const std::vector<ForeignEffect> kEffects{
    {"valve_time_constant", 0.5e-3, true, [](ForeignRig& r, double s) { r.valve_lag_s = s; }},
    {"transport_delay", 0.5e-3, true, [](ForeignRig& r, double s) { r.delay_s = s; }},
    {"valve_offset", 0.01, false, [](ForeignRig& r, double s) { r.null_shift_v = s; }},
    {"valve_dead_band", 0.01, true, [](ForeignRig& r, double s) { r.dead_band_v = s; }},
    {"coulomb_friction", 10.0, true, [](ForeignRig& r, double s) { r.friction_n = s; }},
    {"laminar_leakage", 3.9e-12, true, [](ForeignRig& r, double s) { r.laminar_m3_per_s_pa = s; }},
    {"kp", 0.6, false, [](ForeignRig& r, double s) { r.kp_error_v_per_m = s; }},
    {"kd", 3e-3, false, [](ForeignRig& r, double s) { r.kd_error_v_s_per_m = s; }},
    {"ki", 2.4, true, [](ForeignRig& r, double s) { r.integral_v_per_m_s = s; }},
    {"total_volume", 2.47e-6, true, [](ForeignRig& r, double s) { r.hose_volume_m3 = s; }},
    {"supply_sag", 0.01, true, [](ForeignRig& r, double s) { r.sag = s; }},
    {"position_lag", 0.32e-3, true, [](ForeignRig& r, double s) { r.sensor_lag_s = s; }},
    {"position_gain", 2e-3, false, [](ForeignRig& r, double s) { r.sensor_gain = s; }},
    {"position_offset", 0.03e-3, false, [](ForeignRig& r, double s) { r.sensor_offset_m = s; }},
    {"position_bow", 0.152e-3, false, [](ForeignRig& r, double s) { r.sensor_bow_m = s; }},
    {"position_wave", 0.152e-3, false, [](ForeignRig& r, double s) { r.sensor_wave_m = s; }},
    {"position_hysteresis", 0.03e-3, true,
     [](ForeignRig& r, double s) { r.sensor_hysteresis_m = s; }},
    {"valve_hysteresis", 0.01, true, [](ForeignRig& r, double s) { r.valve_play_v = s; }},
    {"stribeck_friction", 10.0, true, [](ForeignRig& r, double s) { r.breakaway_n = s; }},
    {"sample_time", 1e-3, true,
     [](ForeignRig& r, double s) { r.controller_tick_s = 1e-5 * std::round(1e5 * s); }},
    {"loop_gain", 2e-3, false, [](ForeignRig& r, double s) { r.loop_gain = s; }},
    {"trigger", 0.1e-3, false, [](ForeignRig& r, double s) { r.delay_s -= s; }},
    {"valve_underlap", 0.01, true, [](ForeignRig& r, double s) { r.underlap_v = s; }}};

/// Effects that are not in the catalogue. The detectable size is computed by scaling the size given
/// here.
const std::vector<ForeignEffect> kOthers{
    {"a valve of second order, lag of", 0.3e-3, true,
     [](ForeignRig& r, double s) { r.valve_corner_hz = 1.4 / (2.0 * std::numbers::pi * s); }},
    {"friction of the seals by their pressure", 2e-6, true,
     [](ForeignRig& r, double s) { r.pressure_friction_m2 = s; }},
    {"damping by the square of the speed", 200.0, false,
     [](ForeignRig& r, double s) { r.square_damping = s; }},
    {"a valve that opens further one way", 2e-3, false,
     [](ForeignRig& r, double s) { r.valve_skew = s; }},
    {"oil that grows softer within a record", 0.05, false,
     [](ForeignRig& r, double s) { r.oil_drift = -s; }},
    {"a supply that falls within a record", 0.01, false,
     [](ForeignRig& r, double s) { r.supply_drift = s; }},
    {"chambers whose oil varies with the travel", 0.1, false,
     [](ForeignRig& r, double s) { r.volume_bow = s; }},
    {"a lag of the reference", 0.3e-3, true,
     [](ForeignRig& r, double s) { r.reference_lag_s = s; }},
    {"steps of the converter", 0.1e-3, true, [](ForeignRig& r, double s) { r.quantum_m = s; }},
    {"a piston area that is off", 0.005, false, [](ForeignRig& r, double s) { r.area_error = s; }},
    {"pressure in the return line", 0.031e6, true,
     [](ForeignRig& r, double s) { r.return_pa = s; }},
    {"a return line that backs up", 0.01, true,
     [](ForeignRig& r, double s) { r.back_pressure = s; }},
    {"oil that stiffens with its pressure", 0.1, true,
     [](ForeignRig& r, double s) { r.oil_stiffening = s; }},
    {"a valve whose gain rises with its opening", 0.02, false,
     [](ForeignRig& r, double s) { r.valve_curve = s; }},
    {"a valve whose gain falls with its opening", 0.02, false,
     [](ForeignRig& r, double s) { r.valve_curve = -s; }},
    {"a valve of limited rate, over full command", 0.003, true,
     [](ForeignRig& r, double s) { r.slew_v_per_s = r.limit_v / s; }},
    {"hum in the supply", 0.01, false, [](ForeignRig& r, double s) { r.supply_ripple = s; }},
    {"an accumulator that empties", 0.02, true, [](ForeignRig& r, double s) { r.accumulator = s; }},
    {"a supply that falls midway", 0.01, false, [](ForeignRig& r, double s) { r.supply_step = s; }},
    {"a leak that grows within a record", 0.1, false,
     [](ForeignRig& r, double s) { r.leak_drift = s; }},
    {"a leak that varies with the travel", 0.1, false,
     [](ForeignRig& r, double s) { r.leak_by_travel = s; }},
    {"a leak between orifice and laminar, power more by", 0.1, true,
     [](ForeignRig& r, double s) { r.leak_power = s; }},
    {"friction one way", 5.0, true, [](ForeignRig& r, double s) { r.sided_friction_n = s; }},
    {"friction at one end", 5.0, true, [](ForeignRig& r, double s) { r.travel_friction_n = s; }},
    {"friction from midway on", 5.0, true, [](ForeignRig& r, double s) { r.late_friction_n = s; }},
    {"friction that fades", 5.0, true, [](ForeignRig& r, double s) { r.fading_friction_n = s; }},
    {"a constant force", 20.0, false, [](ForeignRig& r, double s) { r.constant_force_n = s; }},
    {"a spring", 500.0, true, [](ForeignRig& r, double s) { r.spring_n_per_m = s; }},
    {"a loose mass", 0.02, true, [](ForeignRig& r, double s) { r.loose_mass = s; }},
    {"a sensor on a bracket that rings", 0.02, true,
     [](ForeignRig& r, double s) { r.bracket = s; }},
    {"a filter of second order behind the sensor", 0.0003, true,
     [](ForeignRig& r, double s) { r.reader_lag_s = s; }},
    {"hum of the sensor", 3e-05, false, [](ForeignRig& r, double s) { r.sensor_hum_m = s; }},
    {"a sensor that drifts", 3e-05, false, [](ForeignRig& r, double s) { r.sensor_drift_m = s; }},
    {"a sensor that jumps midway", 3e-05, false,
     [](ForeignRig& r, double s) { r.sensor_jump_m = s; }},
    {"a clock that is off", 0.0001, false, [](ForeignRig& r, double s) { r.clock_error = s; }},
    {"a derivative filter that is off", 0.05, false,
     [](ForeignRig& r, double s) { r.filter_error = s; }},
    {"an output limit that is off", 0.01, false,
     [](ForeignRig& r, double s) { r.limit_error = s; }},
    {"a gain of the reference", 0.001, false,
     [](ForeignRig& r, double s) { r.reference_gain = s; }},
    {"steps of the reference", 0.0001, true,
     [](ForeignRig& r, double s) { r.reference_step_m = s; }},
    {"a start off the middle", 0.0001, false, [](ForeignRig& r, double s) { r.start_m = s; }},
    {"a controller that sees the sensor's bow", 0.000152, false,
     [](ForeignRig& r, double s) {
       r.sensor_in_loop = true;
       r.sensor_bow_m = s;
     }},
    {"a controller that sees the sensor's wave", 0.000152, false,
     [](ForeignRig& r, double s) {
       r.sensor_in_loop = true;
       r.sensor_wave_m = s;
     }},
    {"a controller that sees the sensor's play", 3e-05, true,
     [](ForeignRig& r, double s) {
       r.sensor_in_loop = true;
       r.sensor_hysteresis_m = s;
     }},
    {"a supply line that resonates", 0.02, true, [](ForeignRig& r, double s) { r.line_drop = s; }},
    {"samples that are off", 0.001, true, [](ForeignRig& r, double s) { r.spike_m = s; }},
    {"a delay of one record", 0.0003, true, [](ForeignRig& r, double s) { r.delay_s = s; }, true},
    {"a supply lower in one record", 0.01, false,
     [](ForeignRig& r, double s) { r.supply_pa *= 1.0 - s; }, true},
    {"friction in one record", 5.0, true, [](ForeignRig& r, double s) { r.friction_n = s; }, true},
    {"a sensor gain of one record", 0.002, false,
     [](ForeignRig& r, double s) { r.sensor_gain = s; }, true},
    {"a zero of one record", 3e-05, false, [](ForeignRig& r, double s) { r.sensor_offset_m = s; },
     true},
    {"friction and half of it as underlap", 5.0, true,
     [](ForeignRig& r, double s) {
       r.friction_n = s;
       r.underlap_v = 1e-3 * s;
     }},
    {"a lag and a derivative gain that is high", 0.0002, true,
     [](ForeignRig& r, double s) {
       r.valve_lag_s = s;
       r.kd_error_v_s_per_m = 100.0 * s * r.kd_v_s_per_m;
     }},
    {"dead band and play of the valve", 0.005, true,
     [](ForeignRig& r, double s) {
       r.dead_band_v = s;
       r.valve_play_v = s;
     }},
    {"a wave of the sensor and a valve of falling gain", 6e-05, false, [](ForeignRig& r, double s) {
       r.sensor_wave_m = s;
       r.valve_curve = -200.0 * s;
     }}};

/// Days of a row whose validation record has another date than the other records. The campaign
/// states the sizes.
struct RowDays {
  DaySizes stated;
  bool of_fit = false;  ///< the day of the fitted records differs from the stated values, too
};

struct Row {
  std::string name;
  std::string effect;  ///< the effect that should be named; empty if there are none or several, or
                       ///< if it is not in the catalogue
  std::function<void(ForeignRig&, boost::random::mt19937_64&)> apply;
  bool drawn = false;  ///< the effect is drawn anew for each campaign
  bool fresh = false;  ///< rig, amplitudes and seeds are drawn as well
  std::optional<RowDays> days = std::nullopt;
  bool first_only = false;  ///< the effect acts in the first record only
};

/// A row in which the size of the effect is a multiple of the detectable size. The latter is
/// computed when it is first needed.
struct SizedRow {
  const ForeignEffect* effect;
  double factor;
  bool known;  ///< whether the effect is in the catalogue
};

void draw_all(ForeignRig& rig, boost::random::mt19937_64& stream) {
  boost::random::normal_distribution<double> normal;
  for (const ForeignEffect& each : kEffects) {
    const double size = each.plausible * normal(stream);
    each.apply(rig, each.one_sided ? std::abs(size) : size);
  }
}

struct Omission {
  const char* name;
  const char* effect;
  void (*apply)(ForeignRig& rig);
};
const std::vector<Omission> kOmissions{
    {"valve lag of 0.2 ms", "valve_time_constant", [](ForeignRig& r) { r.valve_lag_s = 0.2e-3; }},
    {"valve lag of 0.3 ms", "valve_time_constant", [](ForeignRig& r) { r.valve_lag_s = 0.3e-3; }},
    {"friction of 3 N", "coulomb_friction", [](ForeignRig& r) { r.friction_n = 3.0; }},
    {"friction of 10 N", "coulomb_friction", [](ForeignRig& r) { r.friction_n = 10.0; }},
    {"dead band of 0.05 %", "valve_dead_band", [](ForeignRig& r) { r.dead_band_v = 0.005; }},
    {"dead band of 0.1 %", "valve_dead_band", [](ForeignRig& r) { r.dead_band_v = 0.01; }},
    {"laminar leak of 5e-12", "laminar_leakage",
     [](ForeignRig& r) { r.laminar_m3_per_s_pa = 5e-12; }},
    {"delay of 0.5 ms", "transport_delay", [](ForeignRig& r) { r.delay_s = 0.5e-3; }},
    {"null shift of 0.2 %", "valve_offset", [](ForeignRig& r) { r.null_shift_v = 0.02; }},
    {"nonlinearity of 0.05 %", "position_wave", [](ForeignRig& r) { r.sensor_wave_m = 0.06e-3; }},
    {"nonlinearity of 0.1 %", "position_wave", [](ForeignRig& r) { r.sensor_wave_m = 0.12e-3; }},
    {"integral gain of 5 V/(m s)", "ki", [](ForeignRig& r) { r.integral_v_per_m_s = 5.0; }},
    {"play of the valve of 0.1 %", "valve_hysteresis",
     [](ForeignRig& r) { r.valve_play_v = 0.01; }},
    {"play of the sensor of 0.05 mm", "position_hysteresis",
     [](ForeignRig& r) { r.sensor_hysteresis_m = 0.05e-3; }},
    {"controller sampled at 1 kHz", "sample_time",
     [](ForeignRig& r) { r.controller_tick_s = 1e-3; }},
    {"supply that sags by 1 %", "supply_sag", [](ForeignRig& r) { r.sag = 0.01; }}};

std::vector<Row> rows() {
  std::vector<Row> all;
  for (const bool fresh : {false, true}) {
    const std::string prefix = fresh ? "fresh: " : "";
    all.push_back({prefix + "none", "", [](ForeignRig&, auto&) {}, fresh, fresh});
    all.push_back({prefix + "all, drawn from their sizes", "", draw_all, true, fresh});
    for (const Omission& each : kOmissions) {
      all.push_back({fmt::format("{}omission: {}", prefix, each.name), each.effect,
                     [apply = each.apply](ForeignRig& rig, auto&) { apply(rig); }, fresh, fresh});
    }
  }
  for (const bool of_fit : {false, true}) {
    all.push_back({of_fit ? "fresh: days, of all records" : "fresh: days, of the validation record",
                   "", [](ForeignRig&, auto&) {}, true, true, RowDays{kUsualDaySizes, of_fit}});
  }
  for (const ForeignEffect& each : kEffects) {
    for (const double factor : {0.3, 1.0, 3.0}) {
      all.push_back(
          {fmt::format("{} of {} times its size", each.name, factor), each.name,
           [each, factor](ForeignRig& rig, auto&) { each.apply(rig, factor * each.plausible); },
           false, false});
    }
  }
  return all;
}

struct Estimate {
  const char* key;
  double ForeignRig::*truth;
};
constexpr std::size_t kEstimateCount = 5;
const std::array<Estimate, kEstimateCount> kEstimates{
    {{"mass", &ForeignRig::mass_kg},
     {"damping", &ForeignRig::damping_n_s_per_m},
     {"bulk_modulus", &ForeignRig::bulk_modulus_pa},
     {"valve_gain", &ForeignRig::valve_gain_m_per_v},
     {"leakage_coefficient", &ForeignRig::leak_coefficient}}};

int row_of(const std::string& key) {
  return model::parameter_index(model::PlantKind::load_pressure, key);
}

datasets::Condition condition_of(const Reference& reference, datasets::Use use) {
  datasets::Condition condition;
  condition.id = fmt::format("{}_{}Hz", reference.waveform, reference.frequency_hz);
  condition.waveform =
      reference.waveform == "sine" ? datasets::Waveform::sine : datasets::Waveform::square;
  condition.frequency_hz = reference.frequency_hz;
  condition.amplitude = reference.amplitude_m;
  condition.duration_s = reference.duration_s;
  condition.use = use;
  return condition;
}

/// Returns the campaign as its user would write it: exact except for the effects in the rig.
datasets::Campaign campaign_of(const Bench& bench,
                               const std::optional<RowDays>& days = std::nullopt) {
  const ForeignRig& rig = bench.rig;
  datasets::Campaign campaign = foreign_campaign(rig);
  for (const Estimate& each : kEstimates) {
    datasets::ParameterSetting setting;
    setting.index = row_of(each.key);
    setting.fit = true;
    const double truth = rig.*each.truth;
    setting.value = kOff * truth;
    setting.lower = truth / 5.0;
    setting.upper = truth * 5.0;
    campaign.parameters.push_back(setting);
  }
  for (const Reference& each : bench.fitted)
    campaign.conditions.push_back(condition_of(each, datasets::Use::fit));
  campaign.conditions.push_back(condition_of(bench.validated, datasets::Use::validate));
  if (days) {
    campaign.between_days = stated_days(rig, days->stated);
    for (datasets::Condition& each : campaign.conditions)
      each.date = date_of(each.use == datasets::Use::fit ? 0 : 7);
  }
  campaign.acceptance = {{Channel::position, "rho2", 0.99, 0.995},
                         {Channel::position, "ccc", 0.99, std::nullopt},
                         {Channel::position, "absolute_error_percent", 1.0, std::nullopt}};
  return campaign;
}

datasets::Record record_of(const datasets::Campaign& campaign, const datasets::Condition& condition,
                           const std::vector<double>& readings, int repeats,
                           boost::random::mt19937_64& stream, const ForeignRig& rig) {
  constexpr double kSpikes = 0.005;  // fraction of the samples
  boost::random::normal_distribution<double> normal(0.0, kNoise_m);
  boost::random::uniform_real_distribution<double> even(0.0, 1.0);
  const double quantum_m = rig.quantum_m;
  std::vector<datasets::Repeat> all;
  for (int r = 0; r < repeats; ++r) {
    datasets::Repeat& repeat = all.emplace_back();
    repeat.source = fmt::format("repeat {}", r + 1);
    std::vector<double>& x = repeat.values[Channel::position];
    for (std::size_t k = 0; k < readings.size(); ++k) {
      repeat.time_s.push_back(static_cast<double>(k) / 1000.0);
      double reading = readings[k] + normal(stream);
      if (rig.spike_m > 0.0 && even(stream) < kSpikes)
        reading += even(stream) < 0.5 ? rig.spike_m : -rig.spike_m;
      x.push_back(quantum_m > 0.0 ? quantum_m * std::round(reading / quantum_m) : reading);
    }
  }
  return datasets::average_of(campaign, condition, all, true);
}

/// Motion of a rig in one condition, without noise.
struct Motion {
  std::vector<double> readings;  ///< readings of the rig's sensor [m]
  std::vector<double> position;  ///< as an ideal sensor reads it [m]
};

Motion motion_of(const ForeignRig& rig, const Reference& reference) {
  ForeignRig ideal = rig;
  bool same = true;
  for (double ForeignRig::*value :
       {&ForeignRig::sensor_lag_s, &ForeignRig::sensor_gain, &ForeignRig::sensor_offset_m,
        &ForeignRig::sensor_bow_m, &ForeignRig::sensor_wave_m, &ForeignRig::sensor_hysteresis_m}) {
    same = same && rig.*value == 0.0;
    ideal.*value = 0.0;
  }
  Motion motion;
  motion.readings = foreign_readings(rig, reference);
  motion.position = same ? motion.readings : foreign_readings(ideal, reference);
  for (double& each : motion.position) each /= 1.0 + rig.loop_gain;
  return motion;
}

/// Returns the motion in each condition, in the order of the campaign.
///
/// @param first              the rig during the first record
/// @param fitted, validated  the rig on the days of the other records
std::vector<Motion> motions_of_all(const Bench& bench, const ForeignRig& first,
                                   const ForeignRig& fitted, const ForeignRig& validated) {
  std::vector<Motion> all;
  for (const Reference& reference : bench.fitted)
    all.push_back(motion_of(all.empty() ? first : fitted, reference));
  all.push_back(motion_of(validated, bench.validated));
  return all;
}

std::vector<Motion> motions_of_all(const Bench& bench) {
  return motions_of_all(bench, bench.rig, bench.rig, bench.rig);
}

std::vector<datasets::Record> records_of(const datasets::Campaign& campaign,
                                         const std::vector<Motion>& motions, int repeats,
                                         boost::random::mt19937_64& stream, const ForeignRig& rig) {
  std::vector<datasets::Record> records;
  for (std::size_t c = 0; c < campaign.conditions.size(); ++c)
    records.push_back(
        record_of(campaign, campaign.conditions[c], motions[c].readings, repeats, stream, rig));
  return records;
}

/// Detectable size in standard errors: Holm's limit for about fifteen tests, plus the 95 %
/// quantile.
constexpr double kFound = 4.7;

/// Returns, for each effect in the catalogue, the size at which 95 % of the score tests find it
/// although all other effects are tested, too. It is computed from the standard error of the size
/// in records without effects.
const std::map<std::string, double>& detectable_sizes(int repeats) {
  static const std::map<std::string, double> found = [repeats] {
    boost::random::mt19937_64 stream(kFreshSeed);
    const Bench bench;
    const datasets::Campaign campaign = campaign_of(bench);
    const auto fit = calib::fit(
        campaign, records_of(campaign, motions_of_all(bench), repeats, stream, bench.rig), {});
    std::map<std::string, double> sizes;
    for (const calib::ConsideredEffect& each : fit.considered.value().effects)
      if (each.alone_error) sizes[each.key] = kFound * *each.alone_error;
    return sizes;
  }();
  return found;
}

/// Returns half the sum of squared residuals of a fit whose model is considered exact. The noise is
/// the same for every rig.
///
/// @param first  the rig during the first record
double cost_of(const Bench& bench, const ForeignRig& first, int repeats) {
  boost::random::mt19937_64 stream(kFreshSeed);
  datasets::Campaign campaign = campaign_of(bench);
  campaign.considered.none = true;
  campaign.channels.at(Channel::position).sd = kNoise_m;
  const auto records = records_of(campaign, motions_of_all(bench, first, bench.rig, bench.rig),
                                  repeats, stream, bench.rig);
  return calib::fit(campaign, records, {}).cost;
}

/// Returns the detectable size of an effect that is not in the catalogue: the size at which it
/// leaves as much in the residuals as a detectable one. It is scaled from the given size, because
/// the sum of squares that an effect leaves grows with the square of its size. An effect that
/// leaves less than one residual's variance is absorbed by the estimates and has no such size.
double detectable_size(const ForeignEffect& effect, int repeats) {
  static const double none = cost_of({}, {}, repeats);
  Bench bench;
  ForeignRig first;
  effect.apply(first, effect.plausible);
  if (!effect.first_only) bench.rig = first;
  const double left = 2.0 * (cost_of(bench, first, repeats) - none);
  return left < 1.0 ? HUGE_VAL : effect.plausible * kFound / std::sqrt(left);
}

std::string name_of(const SizedRow& row) {
  return fmt::format("{}: {} {} times what can be detected", row.known ? "fresh" : "other",
                     row.effect->name, row.factor);
}

std::vector<SizedRow> sized_rows() {
  std::vector<SizedRow> all;
  for (const bool known : {true, false}) {
    for (const ForeignEffect& each : known ? kEffects : kOthers)
      for (const double factor : {0.3, 1.0, 3.0}) all.push_back({&each, factor, known});
  }
  return all;
}

/// Returns a row with the size of an effect: a multiple of its detectable size. Some effects, such
/// as the volume of a hose, are absorbed by an estimate and stay undetected at ten times their
/// plausible size. Their size is a multiple of the plausible one.
Row with_size(const SizedRow& row, int repeats) {
  constexpr double kNeverFound = 10.0;
  const ForeignEffect& effect = *row.effect;
  double size = HUGE_VAL;
  if (row.known) {
    const auto found = detectable_sizes(repeats).find(effect.name);
    if (found != detectable_sizes(repeats).end()) size = found->second;
  } else {
    size = detectable_size(effect, repeats);
  }
  const bool found = size <= kNeverFound * effect.plausible;
  if (!found) size = effect.plausible;
  return Row{fmt::format("{} ({:.2g}{})", name_of(row), row.factor * size,
                         found ? "" : ", by its plausible size"),
             row.known ? effect.name : "",
             [&effect, of = row.factor * size](ForeignRig& rig, auto&) { effect.apply(rig, of); },
             true,
             true,
             std::nullopt,
             effect.first_only};
}

struct EstimateOutcome {
  bool has_interval = false;
  bool holds = false, exact = false;  ///< whether `ci95` and `ci95_if_exact` include the truth
  double half_width = 0.0;            ///< relative to the true value; 0 without an interval
  double error = 0.0;                 ///< relative to the true value
};

/// Number of trials, and how many of them had a certain outcome.
struct Tally {
  int trials = 0, hits = 0;
  void add(bool hit) {
    ++trials;
    hits += hit ? 1 : 0;
  }
};

constexpr std::array kTests{"autocorrelation", "cross-correlation", "periodogram", "normality",
                            "drift"};

struct StudyOutcome {
  bool converged = false;
  std::array<EstimateOutcome, kEstimateCount> estimates{};
  /// Largest distance of a missed truth from the centre of its interval, in half-widths.
  double worst = 0.0;
  calib::Verdict verdict = calib::Verdict::fail;
  std::string named;  ///< the effect that the residuals indicate first
  /// For each residual test, how many validation records it rejects of those that it can judge.
  std::array<Tally, kTests.size()> rejected{};
  /// For each metric, how many scores differ from those of the true motion by at most the two-sided
  /// uncertainty.
  std::array<Tally, metrics::kMetrics.size()> covered{};
};

/// Compares an estimate with the truth.
///
/// @param days_error  standard error due to the day of the fit, by which the interval is widened
EstimateOutcome compared(const calib::FittedParameter& parameter, double truth, double days_error,
                         double& worst) {
  EstimateOutcome result;
  const double value = parameter.value;
  result.error = (value - truth) / truth;
  if (const auto& exact = parameter.ci95_if_exact)
    result.exact = exact->low <= truth && truth <= exact->high;
  const auto& ci95 = parameter.ci95;
  if (!ci95 || !std::isfinite(ci95->low) || !std::isfinite(ci95->high)) return result;
  constexpr double kNormal95 = 1.959964;
  const double low = value - std::hypot(value - ci95->low, kNormal95 * days_error);
  const double high = value + std::hypot(ci95->high - value, kNormal95 * days_error);
  result.has_interval = true;
  result.holds = low <= truth && truth <= high;
  const double half = (high - low) / 2.0;
  result.half_width = half / truth;
  const double outside = std::max({low - truth, truth - high, 0.0});
  if (outside > 0.0) worst = std::max(worst, outside / half + 1.0);
  return result;
}

void count_tests(const metrics::ResidualTests& tests, StudyOutcome& outcome) {
  const metrics::CrossCorrelation none;
  const std::array<const metrics::Judged*, kTests.size()> judged{
      &tests.autocorrelation, tests.cross_correlation ? &*tests.cross_correlation : &none,
      &tests.periodogram, &tests.normality, &tests.drift};
  for (std::size_t i = 0; i < judged.size(); ++i)
    if (judged[i]->outcome != metrics::TestOutcome::not_judged)
      outcome.rejected[i].add(judged[i]->failed());
}

void count_scores(const calib::ConditionScore& condition, const calib::ChannelScore& channel,
                  const std::vector<double>& position, StudyOutcome& outcome) {
  if (std::isnan(channel.metrics.rho2) || !channel.two_sided_uncertainty) return;
  const std::vector<double>& simulated = condition.series.at(channel.channel).second;
  const metrics::Agreement truth = metrics::agreement(position, simulated);
  for (std::size_t m = 0; m < metrics::kMetrics.size(); ++m) {
    const auto metric = metrics::kMetrics[m].value;
    const double distance = std::abs(truth.*metric - channel.metrics.*metric);
    outcome.covered[m].add(distance <= (*channel.two_sided_uncertainty).*metric);
  }
}

/// @param rig      true values, without the deviations of a day
/// @param motions  one per condition
StudyOutcome outcome_of(const Row& row, const ForeignRig& rig, const std::vector<Motion>& motions,
                        const calib::Fit& fit) {
  StudyOutcome result;
  result.converged = fit.status == calib::FitStatus::converged;
  if (!result.converged) return result;
  for (std::size_t j = 0; j < kEstimates.size(); ++j) {
    const auto found = std::find_if(
        fit.parameters.begin(), fit.parameters.end(),
        [&](const auto& parameter) { return parameter.index == row_of(kEstimates[j].key); });
    const bool other_day = row.days && row.days->of_fit;
    result.estimates[j] =
        compared(*found, rig.*kEstimates[j].truth,
                 other_day ? found->between_days_error.value_or(0.0) : 0.0, result.worst);
  }
  result.verdict = fit.verdict.value_or(calib::Verdict::fail);
  if (fit.considered && !fit.considered->missing.empty())
    result.named = fit.considered->missing.front();
  for (std::size_t c = 0; c < fit.conditions.size(); ++c) {
    const calib::ConditionScore& condition = fit.conditions[c];
    for (const calib::ChannelScore& channel : condition.channels) {
      count_scores(condition, channel, motions[c].position, result);
      if (condition.use == datasets::Use::validate && channel.residual_tests)
        count_tests(*channel.residual_tests, result);
    }
  }
  return result;
}

/// First line of a file with results. The number is the version of its lines.
constexpr const char* kFileVersion = "rigcal_considered_study 2";

/// Stores the results, one line per campaign, so that a study that was stopped can continue.
class OutcomeFile {
 public:
  /// @throws std::invalid_argument  if the file has another version
  explicit OutcomeFile(std::string path) : path_(std::move(path)) {
    if (path_.empty()) return;
    std::ifstream in(path_);
    std::string line;
    if (!std::getline(in, line)) {
      std::ofstream(path_, std::ios::app) << kFileVersion << '\n';
      return;
    }
    if (line != kFileVersion)
      throw std::invalid_argument(
          fmt::format("{}: the first line is \"{}\", expected \"{}\"; results of other versions "
                      "lack columns, so "
                      "state a new file",
                      path_, line, kFileVersion));
    while (std::getline(in, line)) {
      const auto end = line.rfind('\t');
      if (end != std::string::npos) lines_[line.substr(0, end)] = line.substr(end + 1);
    }
  }

  std::optional<StudyOutcome> find(const std::string& key) const {
    const auto line = lines_.find(key);
    if (line == lines_.end()) return std::nullopt;
    std::istringstream in(line->second);
    StudyOutcome result;
    int verdict = 0;
    in >> result.converged >> verdict >> result.worst >> result.named;
    result.verdict = static_cast<calib::Verdict>(verdict);
    if (result.named == "-") result.named.clear();
    for (EstimateOutcome& each : result.estimates)
      in >> each.has_interval >> each.holds >> each.exact >> each.half_width >> each.error;
    for (Tally& each : result.rejected) in >> each.trials >> each.hits;
    for (Tally& each : result.covered) in >> each.trials >> each.hits;
    std::string end;
    in >> end;
    return end == kEndOfLine ? std::optional(result) : std::nullopt;  // ignores an incomplete line
  }

  void add(const std::string& key, const StudyOutcome& outcome) {
    if (path_.empty()) return;
    std::string line =
        fmt::format("{}\t{:d} {} {} {}", key, outcome.converged, static_cast<int>(outcome.verdict),
                    outcome.worst, outcome.named.empty() ? "-" : outcome.named);
    for (const EstimateOutcome& each : outcome.estimates)
      line += fmt::format(" {:d} {:d} {:d} {} {}", each.has_interval, each.holds, each.exact,
                          each.half_width, each.error);
    for (const Tally& each : outcome.rejected)
      line += fmt::format(" {} {}", each.trials, each.hits);
    for (const Tally& each : outcome.covered) line += fmt::format(" {} {}", each.trials, each.hits);
    const std::lock_guard lock(mutex_);
    std::ofstream(path_, std::ios::app) << line << ' ' << kEndOfLine << '\n';
  }

 private:
  static constexpr const char* kEndOfLine = "end";
  std::string path_;
  std::map<std::string, std::string> lines_;
  std::mutex mutex_;
};

/// Which campaigns a study runs, and how.
struct StudyExtent {
  std::size_t campaigns = 200;
  int threads = 1;
  int repeats = 5;
  /// Index of the first campaign; earlier ones are skipped together with their seeds.
  std::size_t first = 0;
};

std::string percent(std::size_t count, std::size_t of) {
  if (of == 0) return "-";
  return fmt::format("{:.1f}", 100.0 * static_cast<double>(count) / static_cast<double>(of));
}

std::string ratio(const std::optional<double>& value, double unit) {
  return value ? significant(*value / unit, 2) : "-";
}

/// Formats the percentages of all tallies together, then of each.
template <typename Tallies>
std::string rates(const std::vector<StudyOutcome>& outcomes, Tallies StudyOutcome::*member) {
  const auto in_percent = [](const Tally& tally) {
    return percent(static_cast<std::size_t>(tally.hits), static_cast<std::size_t>(tally.trials));
  };
  Tally all;
  std::string text;
  for (std::size_t i = 0; i < Tallies{}.size(); ++i) {
    Tally one;
    for (const StudyOutcome& each : outcomes) {
      one.trials += (each.*member)[i].trials;
      one.hits += (each.*member)[i].hits;
    }
    all.trials += one.trials;
    all.hits += one.hits;
    text += " " + in_percent(one);
  }
  return fmt::format("{};{}", in_percent(all), text);
}

template <typename Each>
std::string of_each(const Each& text) {
  std::vector<std::string> words;
  for (std::size_t j = 0; j < kEstimates.size(); ++j) words.push_back(text(j));
  return fmt::format("{}", fmt::join(words, " "));
}

void study_row(const Row& row, const StudyExtent& extent, OutcomeFile& file) {
  const std::size_t asked = extent.campaigns;
  const int repeats = extent.repeats;
  std::vector<StudyOutcome> outcomes(asked);
  Bench same;
  std::vector<Motion> same_motions;
  if (!row.drawn) {
    boost::random::mt19937_64 unused;
    row.apply(same.rig, unused);
    same_motions = motions_of_all(same);
  }
  parallel_for(asked, extent.threads, [&](std::size_t k) {
    const std::size_t i = extent.first + k;
    const std::string key = fmt::format("{}\t{}\t{}", row.name, repeats, i);
    if (const auto known = file.find(key)) {
      outcomes[k] = *known;
      return;
    }
    boost::random::mt19937_64 stream(row.fresh ? kFreshSeed + i : i + 1);
    Bench bench = row.fresh ? drawn_bench(stream) : same;
    ForeignRig first = bench.rig;
    if (row.first_only)
      row.apply(first, stream);
    else if (row.drawn)
      row.apply(bench.rig, stream);
    ForeignRig fitted = bench.rig;
    ForeignRig validated = bench.rig;
    if (row.days) {
      if (row.days->of_fit) fitted = rig_of_day(bench.rig, row.days->stated, stream);
      validated = rig_of_day(bench.rig, row.days->stated, stream);
    }
    if (!row.first_only) first = fitted;
    const datasets::Campaign campaign = campaign_of(bench, row.days);
    const std::vector<Motion> motions =
        row.drawn ? motions_of_all(bench, first, fitted, validated) : same_motions;
    const auto records = records_of(campaign, motions, repeats, stream, bench.rig);
    outcomes[k] = outcome_of(row, bench.rig, motions, calib::fit(campaign, records, {}));
    file.add(key, outcomes[k]);
  });
  std::erase_if(outcomes, [](const StudyOutcome& each) { return !each.converged; });
  const std::size_t campaigns = outcomes.size();
  const auto count = [&](const auto& holds) {
    return static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(), holds));
  };
  const auto covered = [&](bool EstimateOutcome::*member) {
    return of_each([&](std::size_t j) {
      return percent(count([&](const StudyOutcome& each) { return each.estimates[j].*member; }),
                     campaigns);
    });
  };
  const auto median = [&](std::size_t j) -> std::optional<double> {
    std::vector<double> widths;
    for (const StudyOutcome& each : outcomes)
      if (each.estimates[j].has_interval) widths.push_back(each.estimates[j].half_width);
    if (widths.empty()) return std::nullopt;
    const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
    std::nth_element(widths.begin(), middle, widths.end());
    return *middle;
  };
  const auto rms = [&](std::size_t j) {
    double sum = 0.0;
    for (const StudyOutcome& each : outcomes)
      sum += each.estimates[j].error * each.estimates[j].error;
    return std::sqrt(sum / static_cast<double>(campaigns));
  };
  std::size_t without = 0;
  for (const StudyOutcome& each : outcomes)
    for (const EstimateOutcome& estimate : each.estimates) without += estimate.has_interval ? 0 : 1;
  const auto verdicts =
      fmt::format("{}/{}/{}{}{}",
                  count([](const StudyOutcome& o) { return o.verdict == calib::Verdict::pass; }),
                  count([](const StudyOutcome& o) { return o.verdict == calib::Verdict::warn; }),
                  count([](const StudyOutcome& o) { return o.verdict == calib::Verdict::fail; }),
                  campaigns == asked ? "" : fmt::format(", {} not converged", asked - campaigns),
                  without == 0 ? "" : fmt::format(", {} estimates without an interval", without));
  const std::size_t falsely = count(
      [](const StudyOutcome& o) { return o.verdict == calib::Verdict::pass && o.worst > 3.0; });
  const std::size_t named =
      count([&](const StudyOutcome& o) { return !o.named.empty() && o.named == row.effect; });
  std::map<std::string, int> others;
  for (const StudyOutcome& each : outcomes)
    if (!each.named.empty() && each.named != row.effect) ++others[each.named];
  std::string other;
  for (const auto& [name, times] : others) other += fmt::format(" `{}` {}", name, times);
  std::cout << fmt::format("| {} | {} | {} | {} | {} | {} | {} | {}{} | {} | {} |\n", row.name,
                           covered(&EstimateOutcome::holds), covered(&EstimateOutcome::exact),
                           of_each([&](std::size_t j) { return ratio(median(j), 0.01); }),
                           of_each([&](std::size_t j) { return ratio(median(j), rms(j)); }),
                           verdicts, percent(falsely, campaigns), percent(named, campaigns),
                           other.empty() ? "" : ";" + other,
                           rates(outcomes, &StudyOutcome::rejected),
                           rates(outcomes, &StudyOutcome::covered))
            << std::flush;
}

}  // namespace
}  // namespace rigcal::bench

int main(int argc, char** argv) {
  const auto number = [&](int k, int otherwise) {
    return argc > k ? std::atoi(argv[k]) : otherwise;
  };
  const std::string only = argc > 3 ? argv[3] : "";
  rigcal::bench::StudyExtent extent;
  extent.threads = number(2, 1);
  extent.repeats = number(4, 5);
  const int campaigns = number(1, 200);
  const int first = number(5, 0);
  if (campaigns < 1 || first < 0 || extent.threads < 1 || extent.repeats < 2 || argc > 7) {
    std::cerr << "usage: rigcal_considered_study [campaigns] [threads] [part of a row's name] "
                 "[repeats] [first campaign] [file]\n"
                 "A study that was stopped goes on from the file.\n";
    return 2;
  }
  extent.campaigns = static_cast<std::size_t>(campaigns);
  extent.first = static_cast<std::size_t>(first);
  std::optional<rigcal::bench::OutcomeFile> kept;
  try {
    kept.emplace(argc > 6 ? argv[6] : "");
  } catch (const std::invalid_argument& wrong) {
    std::cerr << "rigcal_considered_study: " << wrong.what() << "\n";
    return 2;
  }
  rigcal::bench::OutcomeFile& file = *kept;
  std::string metrics;
  for (const auto& metric : rigcal::metrics::kMetrics) metrics += fmt::format(" {}", metric.name);
  std::cout << fmt::format(
      "| {} campaigns each, {} repeats | intervals with the truth, % (mass, damping, "
      "bulk modulus, valve gain, leak) | `ci95_if_exact`, % | median half width, % | over the rms "
      "error | PASS/WARN/FAIL | false assurance, % | named first, %; others | residual tests of "
      "validation that reject, % (all; {}) | scores with the truth within U, % (all;{}) |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
      campaigns, extent.repeats, fmt::join(rigcal::bench::kTests, ", "), metrics);
  for (const auto& row : rigcal::bench::rows()) {
    if (row.name.find(only) != std::string::npos) rigcal::bench::study_row(row, extent, file);
  }
  for (const auto& each : rigcal::bench::sized_rows()) {
    if (rigcal::bench::name_of(each).find(only) == std::string::npos) continue;
    rigcal::bench::study_row(rigcal::bench::with_size(each, extent.repeats), extent, file);
  }
  return 0;
}
