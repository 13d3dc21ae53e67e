#include "calib/consider/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "calib/consider/sensor_error.hpp"
#include "calib/consider/thinned_line.hpp"
#include "datasets/synthetic/model_output.hpp"
#include "model/plant/piston_travel.hpp"

namespace rigcal::calib {
namespace {

using datasets::Channel;
using model::Output;

/// Characteristic sizes of a rig, SI; NaN if a value is missing.
struct RigScale {
  double force_n = 0.0;        ///< piston area times supply pressure
  double moment_n_m = 0.0;     ///< that force times the lever
  double command_v = 0.0;      ///< full scale of the command [V] or of the pilot pressure [Pa]
  double flow_m3_per_s = 0.0;  ///< flow through the valve at full command without load
  double travel_m = 0.0;       ///< stroke, or oil volume divided by piston area
  double turn_rad = 0.0;       ///< angle between the stops
  double middle_rad = 0.0;     ///< angle midway between the stops
  double pressure_pa = 0.0;    ///< supply pressure
  double sample_s = 0.0;       ///< shortest sampling interval
  double kp = 0.0;             ///< gain of the rig's control loop, in the units of that loop
  double kd = 0.0;
  double mass_kg = 0.0;
  double leak_per_coefficient =
      0.0;  ///< flow of the orifice leak at supply pressure, per leakage coefficient
};

/// A plausible size derived from the rig.
struct EffectSize {
  double value = 0.0;  ///< standard deviation, SI
  const char* from = "";
};

/// One row of the catalogue. To add an effect, add a row here, and its key to
/// datasets/stated_sizes.cpp. The rows kp, ki and kd represent the gains of whichever loop
/// the rig has.
struct CatalogueRow {
  const char* key;
  EffectKind kind;
  bool one_sided;
  const char* meaning;
  EffectSize (*size)(const RigScale& rig);
};

/// Full scale of a typical laboratory converter. It is used if the controller has no limit of its
/// own.
constexpr double kUsualCommand_v = 10.0;
/// Limits of the plausible lags and delays, which follow from the sampling interval.
constexpr double kLeastLag_s = 0.05e-3;
constexpr double kMostLag_s = 0.5e-3;
/// Plausible time between the start of the drive and that of the record, as a fraction of the
/// sampling interval, and its limits.
constexpr double kAheadFraction = 0.1;
constexpr double kLeastAhead_s = 0.02e-3;
constexpr double kMostAhead_s = 0.1e-3;
/// Typical range of controller periods.
constexpr double kShortestPeriod_s = 0.1e-3;
constexpr double kLongestPeriod_s = 1e-3;
/// Number of times that the error of a spool is recomputed from the resulting command.
constexpr int kSpoolRounds = 2;

/// An effect that matters changes an output by at least a ten-thousandth of its peak. This
/// tolerance resolves a hundredth of such a change.
constexpr double kSecantTolerance = 1e-6;
/// Tolerance for a sampled controller, which ends a step at every tick. Its effect on a sine or
/// square of 0.1 to 10 Hz is then accurate to 0.6 %, in half the steps that kSecantTolerance takes.
constexpr double kTickingTolerance = 1e-5;
/// Tolerance for secants with a recorded drive, as a multiple of the measured tolerance, and its
/// upper limit. It may exceed the measured tolerance, because most of the error cancels in the
/// difference between two similar runs.
constexpr double kRecordedShare = 30.0;
constexpr double kLargestSecantTolerance = 1e-3;

double lag_of(double intervals, const RigScale& rig) {
  return std::clamp(intervals * rig.sample_s, kLeastLag_s, kMostLag_s);
}

EffectSize sensor_lag(const RigScale& rig) {
  return {lag_of(1.0 / std::numbers::pi, rig), "a filter at half the sampling rate"};
}
EffectSize valve_play(const RigScale& rig) {
  return {1e-3 * rig.command_v, "0.1 % of full command"};
}
EffectSize dry_friction_size(const RigScale& rig) {
  return {1e-3 * rig.force_n, "0.1 % of area times supply"};
}
EffectSize acceleration_gain(const RigScale&) { return {0.01, "1 % of the reading"}; }
EffectSize acceleration_offset(const RigScale& rig) {
  return {1e-3 * rig.force_n / rig.mass_kg, "0.1 % of area times supply over the mass"};
}
EffectSize pressure_gain(const RigScale&) { return {5e-3, "0.5 % of the reading"}; }
EffectSize pressure_offset(const RigScale& rig) {
  return {2.5e-3 * rig.pressure_pa, "0.25 % of the supply"};
}

constexpr std::array kCatalogue{
    CatalogueRow{"valve_time_constant", EffectKind::parameter, true, "lag of the valve",
                 [](const RigScale&) {
                   return EffectSize{0.5e-3, "a servo valve with a corner of 300 Hz"};
                 }},
    CatalogueRow{"transport_delay", EffectKind::parameter, true, "delay of the drive",
                 [](const RigScale& rig) {
                   return EffectSize{lag_of(0.5, rig), "half a sampling interval"};
                 }},
    CatalogueRow{"trigger", EffectKind::parameter, false, "drive ahead of its record",
                 [](const RigScale& rig) {
                   return EffectSize{
                       std::clamp(kAheadFraction * rig.sample_s, kLeastAhead_s, kMostAhead_s),
                       "a tenth of a sampling interval"};
                 }},
    CatalogueRow{"valve_offset", EffectKind::parameter, false, "null shift of the valve",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.command_v, "0.1 % of full command"};
                 }},
    CatalogueRow{"valve_dead_band", EffectKind::parameter, true, "overlap of the spool",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.command_v, "0.1 % of full command"};
                 }},
    CatalogueRow{"valve_underlap", EffectKind::underlap, true, "underlap of the spool", valve_play},
    CatalogueRow{"valve_hysteresis", EffectKind::valve_play, true, "hysteresis of the valve",
                 valve_play},
    CatalogueRow{"coulomb_friction", EffectKind::parameter, true, "friction of the seals",
                 dry_friction_size},
    CatalogueRow{"stribeck_friction", EffectKind::parameter, true, "breakaway of the seals",
                 dry_friction_size},
    CatalogueRow{"pilot_dead_band", EffectKind::parameter, true, "overlap of the spool",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.command_v, "0.1 % of full pilot pressure"};
                 }},
    CatalogueRow{"pilot_hysteresis", EffectKind::valve_play, true, "hysteresis of the valve",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.command_v, "0.1 % of full pilot pressure"};
                 }},
    CatalogueRow{"joint_friction", EffectKind::parameter, true, "friction of joint and seals",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.moment_n_m, "0.1 % of lever, area and supply"};
                 }},
    CatalogueRow{"laminar_leakage", EffectKind::parameter, true, "laminar leak",
                 [](const RigScale& rig) {
                   return EffectSize{0.05 * rig.flow_m3_per_s / rig.pressure_pa,
                                     "5 % of the valve's flow at full command"};
                 }},
    CatalogueRow{"valve_null_leakage", EffectKind::parameter, true,
                 "leak of the valve's closed edges",
                 [](const RigScale& rig) {
                   return EffectSize{0.02 * rig.flow_m3_per_s / rig.pressure_pa,
                                     "2 % of the valve's flow at full command"};
                 }},
    CatalogueRow{"leakage_coefficient", EffectKind::parameter, true, "leak through an orifice",
                 [](const RigScale& rig) {
                   return EffectSize{0.02 * rig.flow_m3_per_s / rig.leak_per_coefficient,
                                     "2 % of the valve's flow at full command"};
                 }},
    CatalogueRow{"ki", EffectKind::parameter, true, "integral gain of the controller",
                 [](const RigScale& rig) {
                   return EffectSize{0.02 * rig.kp, "a reset time of 50 s"};
                 }},
    CatalogueRow{"kp", EffectKind::parameter, false, "error of the proportional gain",
                 [](const RigScale& rig) {
                   return EffectSize{5e-3 * rig.kp, "0.5 % of its value"};
                 }},
    CatalogueRow{"kd", EffectKind::parameter, false, "error of the derivative gain",
                 [](const RigScale& rig) {
                   return EffectSize{0.01 * rig.kd, "1 % of its value"};
                 }},
    CatalogueRow{"loop_gain", EffectKind::loop_gain, false, "gain of the sensor that the loop sees",
                 [](const RigScale&) {
                   return EffectSize{2e-3, "0.2 % of the reading"};
                 }},
    CatalogueRow{"sample_time", EffectKind::sampling, true, "sampling of the controller",
                 [](const RigScale& rig) {
                   return EffectSize{std::clamp(rig.sample_s, kShortestPeriod_s, kLongestPeriod_s),
                                     "a controller as fast as the sampling"};
                 }},
    CatalogueRow{"total_volume", EffectKind::parameter, true, "oil of hoses and ports",
                 [](const RigScale& rig) {
                   return EffectSize{0.01 * rig.travel_m, "1 % of the volume"};
                 }},
    CatalogueRow{"dead_volume_a", EffectKind::parameter, true, "oil of hoses and ports, chamber A",
                 [](const RigScale& rig) {
                   return EffectSize{0.01 * rig.travel_m, "1 % of the area times the stroke"};
                 }},
    CatalogueRow{"dead_volume_b", EffectKind::parameter, true, "oil of hoses and ports, chamber B",
                 [](const RigScale& rig) {
                   return EffectSize{0.01 * rig.travel_m, "1 % of the area times the stroke"};
                 }},
    CatalogueRow{"supply_sag", EffectKind::supply_sag, true, "supply pressure that drops with flow",
                 [](const RigScale&) {
                   return EffectSize{0.01, "1 % of the supply at the flow of full command"};
                 }},
    CatalogueRow{"position_lag", EffectKind::parameter, true, "lag of the position sensor",
                 sensor_lag},
    CatalogueRow{"position_gain", EffectKind::parameter, false, "gain of the position sensor",
                 [](const RigScale&) {
                   return EffectSize{2e-3, "0.2 % of the reading"};
                 }},
    CatalogueRow{"position_offset", EffectKind::parameter, false, "offset of the position sensor",
                 [](const RigScale& rig) {
                   return EffectSize{2e-4 * rig.travel_m, "0.02 % of the travel"};
                 }},
    CatalogueRow{"position_bow", EffectKind::bow, false,
                 "nonlinearity of the position sensor, even",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.travel_m, "0.1 % of the travel"};
                 }},
    CatalogueRow{"position_wave", EffectKind::wave, false,
                 "nonlinearity of the position sensor, odd",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.travel_m, "0.1 % of the travel"};
                 }},
    CatalogueRow{"position_hysteresis", EffectKind::hysteresis, true,
                 "hysteresis of the position sensor",
                 [](const RigScale& rig) {
                   return EffectSize{2e-4 * rig.travel_m, "0.02 % of the travel"};
                 }},
    CatalogueRow{"angle_lag", EffectKind::parameter, true, "lag of the angle sensor", sensor_lag},
    CatalogueRow{"angle_gain", EffectKind::parameter, false, "gain of the angle sensor",
                 [](const RigScale&) {
                   return EffectSize{2e-3, "0.2 % of the reading"};
                 }},
    CatalogueRow{"angle_offset", EffectKind::parameter, false, "offset of the angle sensor",
                 [](const RigScale& rig) {
                   return EffectSize{2e-4 * rig.turn_rad, "0.02 % of the angle between the stops"};
                 }},
    CatalogueRow{"angle_bow", EffectKind::bow, false, "nonlinearity of the angle sensor, even",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.turn_rad, "0.1 % of the angle between the stops"};
                 }},
    CatalogueRow{"angle_wave", EffectKind::wave, false, "nonlinearity of the angle sensor, odd",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.turn_rad, "0.1 % of the angle between the stops"};
                 }},
    CatalogueRow{"angle_hysteresis", EffectKind::hysteresis, true, "hysteresis of the angle sensor",
                 [](const RigScale& rig) {
                   return EffectSize{2e-4 * rig.turn_rad, "0.02 % of the angle between the stops"};
                 }},
    CatalogueRow{"load_pressure_lag", EffectKind::parameter, true,
                 "lag of the load pressure sensor", sensor_lag},
    CatalogueRow{"load_pressure_gain", EffectKind::parameter, false,
                 "gain of the load pressure sensor", pressure_gain},
    CatalogueRow{"load_pressure_offset", EffectKind::parameter, false,
                 "offset of the load pressure sensor", pressure_offset},
    CatalogueRow{"pressure_a_lag", EffectKind::parameter, true, "lag of the pressure sensor A",
                 sensor_lag},
    CatalogueRow{"pressure_a_gain", EffectKind::parameter, false, "gain of the pressure sensor A",
                 pressure_gain},
    CatalogueRow{"pressure_a_offset", EffectKind::parameter, false,
                 "offset of the pressure sensor A", pressure_offset},
    CatalogueRow{"pressure_b_lag", EffectKind::parameter, true, "lag of the pressure sensor B",
                 sensor_lag},
    CatalogueRow{"pressure_b_gain", EffectKind::parameter, false, "gain of the pressure sensor B",
                 pressure_gain},
    CatalogueRow{"pressure_b_offset", EffectKind::parameter, false,
                 "offset of the pressure sensor B", pressure_offset},
    CatalogueRow{"acceleration_lag", EffectKind::parameter, true, "lag of the accelerometer",
                 sensor_lag},
    CatalogueRow{"acceleration_gain", EffectKind::parameter, false, "gain of the accelerometer",
                 acceleration_gain},
    CatalogueRow{"acceleration_offset", EffectKind::parameter, false, "offset of the accelerometer",
                 acceleration_offset},
    CatalogueRow{"payload_acceleration_lag", EffectKind::parameter, true,
                 "lag of the payload's accelerometer", sensor_lag},
    CatalogueRow{"payload_acceleration_gain", EffectKind::parameter, false,
                 "gain of the payload's accelerometer", acceleration_gain},
    CatalogueRow{"payload_acceleration_offset", EffectKind::parameter, false,
                 "offset of the payload's accelerometer", acceleration_offset},
    CatalogueRow{"force_lag", EffectKind::parameter, true, "lag of the load cell", sensor_lag},
    CatalogueRow{"force_gain", EffectKind::parameter, false, "gain of the load cell",
                 [](const RigScale&) {
                   return EffectSize{5e-3, "0.5 % of the reading"};
                 }},
    CatalogueRow{"force_offset", EffectKind::parameter, false, "offset of the load cell",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.force_n, "0.1 % of area times supply"};
                 }},
    CatalogueRow{"torque_lag", EffectKind::parameter, true, "lag of the torque sensor", sensor_lag},
    CatalogueRow{"torque_gain", EffectKind::parameter, false, "gain of the torque sensor",
                 [](const RigScale&) {
                   return EffectSize{5e-3, "0.5 % of the reading"};
                 }},
    CatalogueRow{"torque_offset", EffectKind::parameter, false, "offset of the torque sensor",
                 [](const RigScale& rig) {
                   return EffectSize{1e-3 * rig.moment_n_m, "0.1 % of lever, area and supply"};
                 }},
};

double value_of_key(const Problem& problem, const model::ParameterValues& values,
                    std::string_view key) {
  const int index = model::parameter_index(problem.campaign->rig.plant, key);
  return index < 0 ? std::nan("") : values.value[static_cast<std::size_t>(index)];
}

double first_finite(double a, double b) { return std::isfinite(a) ? a : b; }

/// Area of the piston [m2]; of a rotary actuator its displacement, which is an area on a lever of 1
/// m/rad.
double usual_area(const Problem& problem, const model::ParameterValues& values) {
  if (values.is_given("displacement_per_radian")) return values["displacement_per_radian"];
  return first_finite(value_of_key(problem, values, "piston_area"),
                      value_of_key(problem, values, "area_a"));
}

/// Lever of a linkage at the reference angle or, by a triangle or a table, its mean between the
/// stops [m/rad].
double usual_lever(const model::ParameterValues& values) {
  if (values.is_given("lever")) return values["lever"];
  if (values.is_given("displacement_per_radian")) return 1.0;
  const double lower_rad = values["lower_stop"];
  const double upper_rad = values["upper_stop"];
  return (model::piston_travel(values, upper_rad).travel_m -
          model::piston_travel(values, lower_rad).travel_m) /
         (upper_rad - lower_rad);
}

RigScale scale_of(const Problem& problem, std::span<const double> z) {
  const model::ParameterValues values = problem.values_at(0, z);
  const auto get = [&](std::string_view key) { return value_of_key(problem, values, key); };
  RigScale rig;
  const double area = usual_area(problem, values);
  rig.pressure_pa = get("supply_pressure");
  rig.force_n = area * rig.pressure_pa;
  const double limit = get("output_limit");
  rig.command_v = std::isfinite(limit) && limit > 0.0 ? limit : kUsualCommand_v;
  rig.flow_m3_per_s = get("discharge_coefficient") * get("area_gradient") * get("valve_gain") *
                      rig.command_v * std::sqrt(rig.pressure_pa / get("density"));
  rig.travel_m = first_finite(get("stroke"), get("total_volume") / area);
  if (problem.campaign->rig.plant == model::PlantKind::linkage) {
    rig.turn_rad = get("upper_stop") - get("lower_stop");
    rig.middle_rad = 0.5 * (get("upper_stop") + get("lower_stop"));
    const double lever = usual_lever(values);
    rig.travel_m = lever * rig.turn_rad;
    rig.moment_n_m = rig.force_n * lever;
  }
  if (problem.campaign->rig.pilot) {
    rig.command_v = get("pilot_dead_band") + get("pilot_range");
    rig.flow_m3_per_s = get("discharge_coefficient") * get("area_gradient") * get("pilot_gain") *
                        get("pilot_range") * std::sqrt(rig.pressure_pa / get("density"));
  }
  rig.sample_s = problem.shortest_interval_s();
  const model::FeedbackRow& loop = model::gain_keys(problem.campaign->rig.feedback);
  rig.kp = get(loop.kp);
  rig.kd = get(loop.kd);
  rig.mass_kg = get("mass");
  rig.leak_per_coefficient =
      get("leakage_area") * std::sqrt(2.0 * rig.pressure_pa / get("density"));
  return rig;
}

bool is_compared(const Problem& problem, Channel channel) {
  return std::any_of(problem.conditions.begin(), problem.conditions.end(), [&](const auto& each) {
    return std::any_of(each.channels.begin(), each.channels.end(),
                       [&](const auto& one) { return one.channel == channel; });
  });
}

bool is_curved(std::string_view key) {
  return key == "coulomb_friction" || key == "joint_friction" || key == "valve_dead_band" ||
         key == "pilot_dead_band" || key == "valve_underlap" || key == "stribeck_friction" ||
         key.ends_with("_hysteresis");
}

/// Returns true if a key belongs to the kind of valve that the rig does not have (voltage-driven or
/// pilot-operated).
bool is_of_other_valve(std::string_view key, bool pilot) {
  if (key.starts_with("pilot_")) return !pilot;
  return pilot && (key == "valve_dead_band" || key == "valve_underlap" || key == "valve_offset" ||
                   key == "valve_hysteresis");
}

/// Returns the key of the parameter that describes an effect. A drive that is ahead of its record
/// has a negative delay, and an underlap is a negative overlap.
std::string_view parameter_of(std::string_view key) {
  if (key == "trigger") return "transport_delay";
  return key == "valve_underlap" ? "valve_dead_band" : key;
}

bool is_volume(std::string_view key) {
  return key == "total_volume" || key.starts_with("dead_volume");
}

/// Returns the key of a row for the rig's loop. For a force loop, "kp" becomes "force_kp".
std::string_view key_in_loop(std::string_view key, const model::FeedbackRow& loop) {
  if (key == "kp") return loop.kp;
  if (key == "ki") return loop.ki;
  return key == "kd" ? loop.kd : key;
}

bool is_of_controller(std::string_view key, const model::FeedbackRow& loop) {
  return key == loop.kp || key == loop.ki || key == loop.kd || key == "sample_time";
}

/// Returns true if an effect is an error in a value that the model already contains: hoses add to a
/// volume, converters change a gain, and a trigger changes a delay.
bool changes_value(std::string_view key, const model::FeedbackRow& loop) {
  return is_volume(key) || key == loop.kp || key == loop.kd || key == "trigger";
}

/// Returns true if the model already includes the effect, or if its size is given elsewhere: the
/// parameter is free, or given in any condition, or the sensor has a certificate.
bool is_in_model(const Problem& problem, std::string_view key, int index) {
  const auto& unknowns = problem.map.unknowns();
  if (std::any_of(unknowns.begin(), unknowns.end(),
                  [&](const Unknown& each) { return each.index == index; }))
    return true;
  const auto* setting = problem.campaign->setting(index);
  if (setting != nullptr && (setting->fit || setting->prior)) return true;
  const model::FeedbackRow& loop = model::gain_keys(problem.campaign->rig.feedback);
  if (is_of_controller(key, loop) &&
      std::any_of(problem.conditions.begin(), problem.conditions.end(), [](const auto& each) {
        return each.rig.controller == model::ControllerKind::none;
      }))
    return true;
  if (changes_value(key, loop)) return false;
  const auto& spec = model::parameter_spec(problem.campaign->rig.plant, index);
  const double neutral = spec.default_value.value_or(0.0);
  for (const ProblemCondition& each : problem.conditions) {
    if (each.values.value[static_cast<std::size_t>(index)] != neutral) return true;
    if (key == "valve_time_constant" && each.values.is_given("valve_frequency")) return true;
  }
  if (const auto channel = sensor_channel(key)) {
    const auto stated = problem.campaign->channels.find(*channel);
    if (stated == problem.campaign->channels.end()) return false;
    if (key.ends_with("_gain") && stated->second.gain_sd > 0.0) return true;
    if (key.ends_with("_offset") && stated->second.offset_sd > 0.0) return true;
  }
  return false;
}

/// Returns the gain of the sensor that a motion loop sees; empty for loops on other quantities.
std::string_view sensor_gain_of(model::Feedback feedback) {
  if (feedback == model::Feedback::position) return "position_gain";
  return feedback == model::Feedback::angle ? "angle_gain" : "";
}

/// Returns true if a loop may see the same error of the sensor's gain as the records: a motion loop
/// with generated references, whose sensor has no stated or fitted gain.
bool sees_its_sensor(const Problem& problem) {
  const std::string_view gain = sensor_gain_of(problem.campaign->rig.feedback);
  const int index = model::parameter_index(problem.campaign->rig.plant, gain);
  if (index < 0 || is_in_model(problem, gain, index)) return false;
  return std::all_of(problem.conditions.begin(), problem.conditions.end(), [](const auto& each) {
    return each.rig.controller != model::ControllerKind::none &&
           each.condition->waveform != datasets::Waveform::recorded;
  });
}

/// Gives a loop the error of its sensor's gain. Its controller computes with the reading (1 + e) x
/// and therefore acts as if its gains were larger and its reference smaller by this factor. The
/// reading itself has the gain, too. A recorded reference stays as it is.
void see_with_gain(const Problem& problem, std::size_t condition, double error,
                   model::ParameterValues& values, model::SimulationInputs& inputs) {
  const ProblemCondition& data = problem.conditions[condition];
  if (data.condition->waveform == datasets::Waveform::recorded) return;
  const double factor = 1.0 + error;
  const model::FeedbackRow& loop = model::gain_keys(data.rig.feedback);
  for (const std::string_view key :
       {loop.kp, loop.ki, loop.kd, loop.velocity_feedforward, loop.acceleration_feedforward,
        sensor_gain_of(data.rig.feedback)}) {
    const int index = model::parameter_index(data.rig.plant, key);
    if (index < 0) continue;
    const double value = values.value[static_cast<std::size_t>(index)];
    if (value != 0.0) values.set(index, factor * value);
  }
  datasets::Condition smaller = *data.condition;
  if (smaller.amplitude) *smaller.amplitude /= factor;
  inputs.drive = datasets::inputs_of(*problem.campaign, smaller, values, data.record).drive;
}

/// Returns the effects in the catalogue that may act in a problem, regardless of the campaign's
/// settings.
std::vector<Effect> possible_effects(const Problem& problem, std::span<const double> z) {
  std::vector<Effect> result;
  if (problem.conditions.empty()) return result;
  const model::PlantKind plant = problem.campaign->rig.plant;
  const RigScale rig = scale_of(problem, z);
  const model::ParameterValues values = problem.values_at(0, z);
  const auto names = datasets::effect_names(plant);
  const model::FeedbackRow& loop = model::gain_keys(problem.campaign->rig.feedback);
  for (const CatalogueRow& row : kCatalogue) {
    const std::string_view key = key_in_loop(row.key, loop);
    const auto name =
        std::find_if(names.begin(), names.end(), [&](const auto& each) { return each.key == key; });
    if (name == names.end()) continue;
    if (is_of_other_valve(key, problem.campaign->rig.pilot)) continue;
    if (row.kind == EffectKind::loop_gain && !sees_its_sensor(problem)) continue;
    Effect effect;
    effect.kind = row.kind;
    effect.curved = is_curved(key);
    const auto channel = sensor_channel(key);
    if (channel && !is_compared(problem, *channel)) continue;
    if (row.kind == EffectKind::parameter || row.kind == EffectKind::sampling ||
        row.kind == EffectKind::underlap) {
      const std::string_view parameter = parameter_of(key);
      effect.index = model::parameter_index(plant, parameter);
      if (is_in_model(problem, key, effect.index)) continue;
      if (parameter != key) effect.sign = -1.0;
    }
    effect.range = row.kind == EffectKind::supply_sag ? rig.flow_m3_per_s : rig.travel_m;
    if (channel == Channel::angle) {
      effect.range = rig.turn_rad;
      effect.middle = rig.middle_rad;
    }
    EffectSize size = row.size(rig);
    if (is_volume(key)) size.value *= usual_area(problem, values);
    if (row.kind == EffectKind::supply_sag &&
        std::any_of(problem.conditions.begin(), problem.conditions.end(),
                    [](const auto& each) { return each.inputs.supply_pressure_pa.has_value(); }))
      continue;  // the recorded pressure already includes the sag
    if (row.kind == EffectKind::supply_sag && values.is_given("pump_flow"))
      continue;  // the pump determines how far the pressure falls
    if (!(effect.range > 0.0) || !std::isfinite(size.value) || !(size.value > 0.0)) continue;
    effect.about.key = key;
    effect.about.meaning = row.meaning;
    effect.about.unit = name->unit;
    effect.about.size = size.value;
    effect.about.size_from = size.from;
    effect.about.one_sided = row.one_sided;
    result.push_back(std::move(effect));
  }
  return result;
}

/// Returns the periods with which a run may repeat, half a period first.
std::vector<model::SampledPeriod> periods_of(const model::SimulationInputs& inputs,
                                             std::span<const double> time_s) {
  std::vector<model::SampledPeriod> periods;
  for (const bool reversible : {true, false}) {
    const auto period = model::sampled_period(inputs, time_s, reversible, std::nullopt);
    if (period && (periods.empty() || periods.back().reversed)) periods.push_back(*period);
  }
  return periods;
}

/// Returns the supply pressure at the end of a line along which the fraction `sag` of it is lost
/// when the flow equals the effect's range.
model::Signal sagging_supply(const Effect& effect, const model::ParameterValues& values,
                             std::span<const double> time_s, const Eigen::VectorXd& flow,
                             double sag, std::span<const model::SampledPeriod> periods) {
  std::vector<double> supply;
  const double full = values["supply_pressure"];
  for (Eigen::Index i = 0; i < flow.size(); ++i)
    supply.push_back(full * (1.0 - std::min(0.5, sag * std::abs(flow(i)) / effect.range)));
  return repeating_line(time_s, supply, periods, Reverses::no);
}

/// Returns the output that drives the valve.
Output valve_drive(const model::ParameterValues& values) {
  return model::has_output(values, Output::command) ? Output::command : Output::pilot_pressure;
}

/// Returns the position of a sensor or spool with play, which moves only after the play has been
/// taken up.
Eigen::VectorXd with_play(const Eigen::VectorXd& x, double half_width) {
  Eigen::VectorXd y = x;
  for (Eigen::Index i = 1; i < x.size(); ++i)
    y(i) = std::clamp(y(i - 1), x(i) - half_width, x(i) + half_width);
  return y;
}

/// How a spool departs from its signal [V or Pa].
struct SpoolShape {
  double play = 0.0;      ///< half-width within which the signal turns without moving the spool
  double underlap = 0.0;  ///< half-width within which the spool opens twice as far

  bool is_exact() const { return play == 0.0 && underlap == 0.0; }
};

/// Returns the error in the spool position.
model::Signal spool_error(std::span<const double> time_s, const Eigen::VectorXd& signal,
                          const SpoolShape& shape, std::span<const model::SampledPeriod> periods) {
  const Eigen::VectorXd played = with_play(signal, shape.play);
  const Eigen::VectorXd error =
      played - signal + played.cwiseMax(-shape.underlap).cwiseMin(shape.underlap);
  return repeating_line(time_s, {error.data(), static_cast<std::size_t>(error.size())}, periods,
                        Reverses::yes);
}

/// Simulates a rig whose delay may be negative, as that of a drive that is ahead of its record. The
/// readings are then those of later times.
model::Simulation simulated_ahead(const model::Rig& rig, const model::ParameterValues& values,
                                  const std::vector<int>& free,
                                  const model::SimulationInputs& inputs,
                                  std::span<const double> times_s,
                                  const std::vector<Output>& outputs,
                                  const model::SimulationOptions& options) {
  const double ahead_s = -values["transport_delay"];
  if (!(ahead_s > 0.0))
    return model::simulate(rig, values, free, inputs, times_s, outputs, options);
  model::ParameterValues without = values;
  without.set("transport_delay", 0.0);
  std::vector<double> later_s(times_s.begin(), times_s.end());
  for (double& t : later_s) t += ahead_s;
  return model::simulate(rig, without, free, inputs, later_s, outputs, options);
}

/// @param least_tolerance  kSecantTolerance, or kTickingTolerance for a sampled controller
model::SimulationOptions effect_options(const Problem& problem, std::size_t condition,
                                        double least_tolerance, const std::atomic<bool>* cancel) {
  auto options = problem.simulation_options(cancel);
  options.tolerance = std::max(problem.tolerance_of(condition), least_tolerance);
  const double measured = problem.conditions[condition].measured_tolerance;
  if (measured > 0.0)
    options.tolerance =
        std::max(options.tolerance, std::min(kRecordedShare * measured, kLargestSecantTolerance));
  // The search sets its budget by the steps at its start, where a run may soon become periodic. A
  // sampled controller and an input taken from a simulation need more steps than that.
  const ProblemCondition& data = problem.conditions[condition];
  options.max_steps = std::max(data.max_steps, ample_steps(data.record->time_s.size()));
  return options;
}

}  // namespace

std::optional<Channel> sensor_channel(std::string_view key) {
  // "force_kp" is the gain of a loop, "force_gain" is the gain of a sensor.
  const std::string_view error = key.substr(std::min(key.rfind('_'), key.size()));
  if (error != "_lag" && error != "_gain" && error != "_offset" && error != "_bow" &&
      error != "_wave" && error != "_hysteresis")
    return std::nullopt;
  for (const Channel channel : {Channel::load_pressure, Channel::pressure_a, Channel::pressure_b,
                                Channel::position, Channel::angle, Channel::force, Channel::torque,
                                Channel::acceleration, Channel::payload_acceleration}) {
    const std::string_view name = datasets::info(channel).key;
    if (key.starts_with(name) && key.substr(name.size()).starts_with('_')) return channel;
  }
  return std::nullopt;
}

Eigen::VectorXd reading_error(const Effect& effect, const Eigen::VectorXd& reading, double size) {
  const Eigen::ArrayXd turn =
      (reading.array() - effect.middle) / effect.range;  // fraction of the range
  if (effect.kind == EffectKind::bow) return size * (2.0 * turn).square();
  if (effect.kind == EffectKind::wave) return size * (2.0 * std::numbers::pi * turn).sin();
  return with_play(reading, size) - reading;
}

std::vector<Effect> effects_of(const Problem& problem, std::span<const double> z) {
  const datasets::StatedSizes& stated = problem.campaign->considered;
  std::vector<Effect> result;
  for (Effect& effect : possible_effects(problem, z)) {
    if (stated.leaves_out(effect.about.key)) continue;
    if (const auto size = stated.size(effect.about.key)) {
      effect.about.size = *size;
      effect.about.size_from = "[considered]";
    }
    result.push_back(std::move(effect));
  }
  return result;
}

std::vector<std::string> left_out_effects(const Problem& problem, std::span<const double> z) {
  std::vector<std::string> keys;
  for (const Effect& effect : possible_effects(problem, z)) {
    if (problem.campaign->considered.leaves_out(effect.about.key)) keys.push_back(effect.about.key);
  }
  return keys;
}

OutputsWith outputs_with(const Problem& problem, std::size_t condition, std::span<const double> z,
                         const std::vector<Effect>& effects, const Eigen::VectorXd& sizes,
                         Derivatives derivatives, const std::atomic<bool>* cancel) {
  const ProblemCondition& data = problem.conditions[condition];
  const auto samples = static_cast<Eigen::Index>(data.rows.size());
  const auto channels = static_cast<Eigen::Index>(data.channels.size());
  const auto options = effect_options(problem, condition, kSecantTolerance, cancel);
  const auto ticking_options = effect_options(problem, condition, kTickingTolerance, cancel);
  const std::vector<int> free =
      derivatives == Derivatives::of_unknowns ? data.free : std::vector<int>();
  model::ParameterValues values = problem.values_at(condition, z);
  const auto size_of = [&](std::size_t e) {
    return effects[e].about.size * sizes(static_cast<Eigen::Index>(e));
  };
  double sag = 0.0;
  const Effect* line = nullptr;
  SpoolShape shape;
  double loop_gain = 0.0;
  std::size_t sampling = effects.size();
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (size_of(e) == 0.0) continue;
    const int index = effects[e].index;
    if (effects[e].kind == EffectKind::parameter) {
      values.set(index,
                 values.value[static_cast<std::size_t>(index)] + effects[e].sign * size_of(e));
    } else if (effects[e].kind == EffectKind::supply_sag) {
      sag = size_of(e);
      line = &effects[e];
    } else if (effects[e].kind == EffectKind::valve_play) {
      shape.play = size_of(e);
    } else if (effects[e].kind == EffectKind::underlap) {
      shape.underlap = size_of(e);
    } else if (effects[e].kind == EffectKind::sampling) {
      sampling = e;
    } else if (effects[e].kind == EffectKind::loop_gain) {
      loop_gain = size_of(e);
    }
  }
  model::SimulationInputs driven = data.inputs;
  if (loop_gain != 0.0) see_with_gain(problem, condition, loop_gain, values, driven);
  const auto run = [&](const model::ParameterValues& at, const std::vector<int>& rows,
                       const model::SimulationOptions& with) {
    std::vector<Output> outputs = data.outputs;
    const auto simulated = [&](const model::SimulationInputs& inputs,
                               const std::vector<int>& columns) {
      return simulated_ahead(data.rig, at, columns, inputs, data.fit_times(), outputs, with);
    };
    if (line == nullptr && shape.is_exact()) return simulated(driven, rows);
    outputs.insert(outputs.end(), {Output::servo_flow, valve_drive(at)});
    model::SimulationInputs inputs = driven;
    const auto periods = periods_of(inputs, data.fit_times());
    model::Simulation simulation = simulated(inputs, {});
    const int rounds = shape.is_exact() ? 1 : kSpoolRounds;
    for (int round = 1; round <= rounds && simulation.ok(); ++round) {
      if (line != nullptr && round == 1) {
        inputs.supply_pressure_pa = sagging_supply(*line, at, data.fit_times(),
                                                   simulation.outputs.col(channels), sag, periods);
      }
      if (!shape.is_exact()) {
        inputs.spool_error =
            spool_error(data.fit_times(), simulation.outputs.col(channels + 1), shape, periods);
      }
      simulation = simulated(inputs, round == rounds ? rows : std::vector<int>());
    }
    return simulation;
  };
  model::Simulation simulation = run(values, free, options);
  if (!simulation.ok()) return {};
  // A change in the sampling period shifts, by a fraction of the period, when the controller sees
  // an edge between two ticks. The output is therefore not a smooth function of the period, and the
  // effect is taken to be proportional to that of the plausible period.
  if (sampling < effects.size()) {
    model::ParameterValues ticking = values;
    ticking.set(effects[sampling].index, effects[sampling].about.size);
    const model::Simulation sampled = run(ticking, {}, ticking_options);
    if (!sampled.ok()) return {};
    simulation.outputs +=
        sizes(static_cast<Eigen::Index>(sampling)) * (sampled.outputs - simulation.outputs).eval();
  }
  OutputsWith result;
  result.outputs.resize(samples * channels);
  result.jacobian.resize(samples * channels, static_cast<Eigen::Index>(free.size()));
  result.by_sensor = Eigen::MatrixXd::Zero(samples * channels,
                                           derivatives == Derivatives::none ? 0 : sizes.size());
  const std::vector<Eigen::Index> counted(data.rows.begin(), data.rows.end());
  for (Eigen::Index k = 0; k < channels; ++k) {
    const ProblemChannel& channel = data.channels[static_cast<std::size_t>(k)];
    const auto reading_with = [&](const Eigen::VectorXd& of_each) {
      Eigen::VectorXd reading = simulation.outputs.col(k);
      for (std::size_t e = 0; e < effects.size(); ++e) {
        const double size = effects[e].about.size * of_each(static_cast<Eigen::Index>(e));
        if (effects[e].is_of_sensor() && channel.channel == sensor_channel(effects[e].about.key) &&
            size != 0.0)
          reading += reading_error(effects[e], reading, size);
      }
      return reading;
    };
    const Eigen::VectorXd reading = reading_with(sizes);
    const auto own = Eigen::seqN(k * samples, samples);
    result.outputs(own) = reading(counted) / channel.sd;
    if (!free.empty()) {
      result.jacobian(own, Eigen::all) =
          simulation.sensitivities[static_cast<std::size_t>(k)].leftCols(result.jacobian.cols())(
              counted, Eigen::all) /
          channel.sd;
      for (Eigen::Index e = 0; e < sizes.size(); ++e) {
        if (!effects[static_cast<std::size_t>(e)].is_of_sensor()) continue;
        Eigen::VectorXd further = sizes;
        further(e) += kEffectStep;
        result.by_sensor(own, e) =
            (reading_with(further) - reading)(counted) / (channel.sd * kEffectStep);
      }
    }
  }
  return result;
}

std::vector<Eigen::MatrixXd> effect_changes(const Problem& problem, std::size_t condition,
                                            const model::ParameterValues& values,
                                            std::span<const double> times_s,
                                            const std::vector<Effect>& effects,
                                            const std::atomic<bool>* cancel,
                                            std::span<const Output> further) {
  const ProblemCondition& data = problem.conditions[condition];
  const auto samples = static_cast<Eigen::Index>(times_s.size());
  const auto channels = static_cast<Eigen::Index>(data.channels.size());
  std::vector<Output> outputs = data.outputs;
  outputs.insert(outputs.end(), further.begin(), further.end());
  const auto kept = static_cast<Eigen::Index>(outputs.size());
  std::vector<Eigen::MatrixXd> result(
      static_cast<std::size_t>(kept),
      Eigen::MatrixXd::Constant(samples, static_cast<Eigen::Index>(effects.size()), std::nan("")));
  const auto options = effect_options(problem, condition, kSecantTolerance, cancel);
  const auto ticking_options = effect_options(problem, condition, kTickingTolerance, cancel);
  const auto simulated = [&](const model::ParameterValues& at, const model::SimulationInputs& in,
                             const std::vector<Output>& wanted,
                             const model::SimulationOptions& with) {
    return simulated_ahead(data.rig, at, std::vector<int>(), in, times_s, wanted, with);
  };
  const auto run_with = [&](const model::ParameterValues& at, const model::SimulationInputs& in,
                            const std::vector<Output>& wanted) {
    return simulated(at, in, wanted, options);
  };
  const model::Simulation base = run_with(values, data.inputs, outputs);
  if (!base.ok()) return result;
  // The flow is simulated separately, because requesting it makes a simulation take more steps and
  // longer to sample.
  Eigen::VectorXd flow;
  Eigen::VectorXd drive;
  std::vector<model::SampledPeriod> periods;
  if (std::any_of(effects.begin(), effects.end(), [](const Effect& each) {
        return each.kind == EffectKind::supply_sag || each.is_of_spool();
      })) {
    const model::Simulation run =
        run_with(values, data.inputs, {Output::servo_flow, valve_drive(values)});
    if (!run.ok()) return result;
    flow = run.outputs.col(0);
    drive = run.outputs.col(1);
    periods = periods_of(data.inputs, times_s);
  }
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const Effect& effect = effects[e];
    const double size = effect.secant * effect.about.size;
    Eigen::MatrixXd change = Eigen::MatrixXd::Zero(samples, kept);
    if (effect.is_of_sensor()) {
      for (Eigen::Index k = 0; k < channels; ++k) {
        if (data.channels[static_cast<std::size_t>(k)].channel == sensor_channel(effect.about.key))
          change.col(k) = reading_error(effect, base.outputs.col(k), size);
      }
    } else {
      model::ParameterValues changed = values;
      model::SimulationInputs inputs = data.inputs;
      model::Simulation run;
      std::vector<Output> wanted = outputs;
      if (effect.is_of_spool()) {
        const SpoolShape shape{effect.kind == EffectKind::valve_play ? size : 0.0,
                               effect.kind == EffectKind::underlap ? size : 0.0};
        Eigen::VectorXd driven = drive;
        for (int round = 1; round < kSpoolRounds && driven.size() > 0; ++round) {
          inputs.spool_error = spool_error(times_s, driven, shape, periods);
          run = run_with(changed, inputs, {valve_drive(values)});
          driven = run.ok() ? Eigen::VectorXd(run.outputs.col(0)) : Eigen::VectorXd();
        }
        if (driven.size() == 0) continue;
        inputs.spool_error = spool_error(times_s, driven, shape, periods);
      } else if (effect.kind == EffectKind::supply_sag) {
        inputs.supply_pressure_pa = sagging_supply(effect, values, times_s, flow, size, periods);
      } else if (effect.kind == EffectKind::loop_gain) {
        see_with_gain(problem, condition, size, changed, inputs);
      } else {
        changed.set(effect.index,
                    values.value[static_cast<std::size_t>(effect.index)] + effect.sign * size);
        // A sensor changes no reading but its own, since the loop does not use it, unless the run
        // starts from its reading.
        const auto channel = sensor_channel(effect.about.key);
        const auto output = channel ? datasets::model_output(*channel) : std::nullopt;
        if (output && !changes_start(data.rig, values, *output, effect.index)) {
          const auto own = std::find(outputs.begin(), outputs.end(), *output);
          wanted.assign(own, own == outputs.end() ? own : own + 1);
          if (!wanted.empty()) {
            const Eigen::Index k = own - outputs.begin();
            const auto error =
                sensor_error(*own, values, effect.index, size, times_s, base.outputs.col(k));
            if (error) {
              change.col(k) = *error;
              wanted.clear();
            }
          }
        }
      }
      if (!wanted.empty()) {
        const bool ticks = effect.kind == EffectKind::sampling;
        run = simulated(changed, inputs, wanted, ticks ? ticking_options : options);
      }
      if (!run.ok()) continue;
      for (Eigen::Index k = 0; k < kept; ++k) {
        const auto found =
            std::find(wanted.begin(), wanted.end(), outputs[static_cast<std::size_t>(k)]);
        if (found != wanted.end())
          change.col(k) = run.outputs.col(found - wanted.begin()) - base.outputs.col(k);
      }
    }
    for (Eigen::Index k = 0; k < kept; ++k)
      result[static_cast<std::size_t>(k)].col(static_cast<Eigen::Index>(e)) =
          change.col(k) / effect.secant;
  }
  return result;
}

Eigen::MatrixXd effect_rows(const Problem& problem, std::size_t condition,
                            std::span<const double> z, const std::vector<Effect>& effects,
                            const std::atomic<bool>* cancel) {
  const ProblemCondition& data = problem.conditions[condition];
  const auto samples = static_cast<Eigen::Index>(data.rows.size());
  const auto changes = effect_changes(problem, condition, problem.values_at(condition, z),
                                      data.fit_times(), effects, cancel);
  const std::vector<Eigen::Index> counted(data.rows.begin(), data.rows.end());
  Eigen::MatrixXd result(samples * static_cast<Eigen::Index>(changes.size()),
                         static_cast<Eigen::Index>(effects.size()));
  for (std::size_t k = 0; k < changes.size(); ++k) {
    result.middleRows(static_cast<Eigen::Index>(k) * samples, samples) =
        changes[k](counted, Eigen::all) / data.channels[k].sd;
  }
  return result;
}

}  // namespace rigcal::calib
