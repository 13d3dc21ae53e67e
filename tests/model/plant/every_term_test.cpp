// Compares every optional term of every plant with an integrator of another kind and equations that
// this file states for itself, and finds the rows of the parameter tables that no case compares
// (docs/model.md).

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/model/linkage_rig.hpp"
#include "tests/model/runge_kutta.hpp"

using namespace rigcal::model;

namespace {

/// Places of the states below. A rig has some of them; the others stay at zero.
struct At {
  enum : std::size_t {
    motion,
    speed,
    a,  ///< pressure A, or the load pressure of a rig that has no other
    b,
    hose_a,
    hose_b,
    supply,
    demand,
    second,
    second_speed,
    bristle,
    film,
    spool,
    pilot,
    pilot_rate,
    integral,
    error_filter,
    reference,
    reference_rate,
    count
  };
};
using Whole = std::array<double, At::count>;

/// Line between six values at 0 to 5, with a parabola in place of each corner.
///
/// @param rounded  half of the width of the parabola
double rounded_line(double place, const std::array<double, 6>& values, double rounded) {
  const double piece = std::clamp(std::floor(place), 0.0, 4.0);
  const auto from = static_cast<std::size_t>(piece);
  double value = values[from] + (place - piece) * (values[from + 1] - values[from]);
  for (std::size_t i = 1; i < 5; ++i) {
    const double inside = rounded - std::abs(place - static_cast<double>(i));
    const double bend = values[i + 1] - 2.0 * values[i] + values[i - 1];
    if (inside > 0.0) value += bend * inside * inside / (4.0 * rounded);
  }
  return value;
}

/// Flow at which the losses of an orifice and of a line in series add up, (Q / G)^2 + R Q = |P|, by
/// bisection.
double flow_in_series(double head_pa, double conductance, double resistance) {
  double low = 0.0;
  double high = conductance * std::sqrt(std::abs(head_pa));
  for (int i = 0; i < 50 && high > 0.0; ++i) {
    const double flow = 0.5 * (low + high);
    const double orifice_pa = std::abs(head_pa) - resistance * flow;
    (flow * flow > conductance * conductance * orifice_pa ? high : low) = flow;
  }
  return std::copysign(0.5 * (low + high), head_pa);
}

/// The equations of docs/model.md for a rig whose drive is a sine.
class OwnRig {
 public:
  /// @param amplitude, frequency_hz  of the drive
  OwnRig(const Experiment& e, double amplitude, double frequency_hz)
      : plant_(e.rig.plant),
        rig_(e.rig),
        values_(e.values),
        amplitude_(amplitude),
        turn_(2.0 * kPi * frequency_hz) {
    if (!given("reference_temperature")) return;
    const double above_k = value("oil_temperature") - value("reference_temperature");
    const double thin = std::exp(-value("viscosity_decay") * above_k);
    density /= 1.0 + value("thermal_expansion") * above_k;
    modulus *= std::exp(-value("bulk_modulus_decay") * above_k);
    for (double* resistance : {&damping, &leak_resistance, &return_resistance}) *resistance *= thin;
    for (double* path : {&laminar, &clearance, &outside_a, &outside_b}) *path /= thin;
  }

  /// State at rest, with the motion and the pressures at the first sample.
  Whole start(double motion, double a_pa, double b_pa) const {
    Whole x{};
    x[At::motion] = x[At::second] = x[At::reference] = motion;
    x[At::a] = a_pa;
    x[At::b] = b_pa;
    x[At::supply] = source_pa;
    const auto memory = [&](double p) {
      return std::clamp((2.0 * p - source_pa - tank_pa) / (source_pa - tank_pa), -1.0, 1.0);
    };
    x[At::hose_a] = memory(a_pa);
    x[At::hose_b] = memory(b_pa);
    return x;
  }

  /// Command to the valve, or pilot pressure.
  double command(const Whole& x, double t) const {
    return std::clamp(unlimited(x, t), -limit, limit);
  }

  Whole rates(const Whole& x, double t) const {
    Whole dx{};
    const double asked = command(x, t);
    take_loop(x, t, dx);
    take_valve(x, asked, dx);
    const double spool = lag_of_valve > 0 ? x[At::spool] : asked;
    dx[At::motion] = x[At::speed];
    dx[At::speed] = acceleration(x);
    dx[At::second] = x[At::second_speed];
    dx[At::second_speed] = pull(x);
    if (bristle > 0.0) dx[At::bristle] = bristle_rate(x);
    if (film_speed > 0.0) dx[At::film] = film_rate(x);
    if (plant_ == PlantKind::load_pressure) {
      take_load_pressure(x, spool, dx);
    } else {
      take_chambers(x, spool, dx);
    }
    return dx;
  }

 private:
  bool given(std::string_view key) const {
    const int index = parameter_index(plant_, key);
    return index >= 0 && values_.given[static_cast<std::size_t>(index)];
  }
  /// Zero if the plant has no such row.
  double value(std::string_view key) const {
    const int index = parameter_index(plant_, key);
    return index >= 0 ? values_.value[static_cast<std::size_t>(index)] : 0.0;
  }
  double value_if_given(std::string_view key, double otherwise) const {
    return given(key) ? value(key) : otherwise;
  }

  PlantKind plant_;
  Rig rig_;
  ParameterValues values_;
  double amplitude_;
  double turn_;

  // Motion.
  double mass = value(plant_ == PlantKind::linkage ? "inertia" : "mass");
  double damping = value("damping");
  double joint_damping = value("joint_damping");
  double spring = value("stiffness");
  double gravity = value("gravity");
  double second_mass = value("payload_mass");
  double second_frequency = value("payload_frequency");
  double second_ratio = value("payload_damping_ratio");
  double stop_stiffness = value("stop_stiffness");
  double stop_damping = value("stop_damping");
  double lower_stop = plant_ == PlantKind::linkage
                          ? value("lower_stop")
                          : value_if_given("retracted_position", -0.5 * value("stroke"));
  double upper_stop =
      plant_ == PlantKind::linkage ? value("upper_stop") : lower_stop + value("stroke");
  // Load and dry friction.
  double load = value("external_force");
  double load_slope = value("load_gradient");
  double load_bend = value("load_curvature");
  bool load_table = given("load_table_to");
  double table_from = value("load_table_from");
  double table_to = value("load_table_to");
  std::array<double, 6> table_n{value("load_0"),  value("load_20"), value("load_40"),
                                value("load_60"), value("load_80"), value("load_100")};
  double dry = value("coulomb_friction");
  double breakaway = value("stribeck_friction");
  double breakaway_speed = value("stribeck_velocity");
  double still_speed = value("friction_smoothing");
  double seal = value("seal_friction");
  double bristle = value("bristle_stiffness");
  double bristle_damping = value("bristle_damping");
  double film_speed = value("film_velocity");
  double film_growth = value("film_growth_time");
  double film_decay = value("film_decay_time");
  double film_dwell = value("film_dwell_time");
  // Joint.
  double joint_dry = value("joint_friction");
  double joint_still_rate = value("joint_friction_smoothing");
  double reference_angle = value("reference_angle");
  std::array<double, 3> lever_terms{value("lever"), value("lever_gradient"),
                                    value("lever_curvature")};
  std::array<double, 3> moment_terms{value("gravity_moment"), value("gravity_moment_gradient"),
                                     value("gravity_moment_curvature")};
  double base = value("triangle_base");
  double arm = value("triangle_arm");
  double triangle_angle = value("triangle_angle");
  bool travel_table = given("travel_table_to");
  double travel_from = value("travel_table_from");
  double travel_to = value("travel_table_to");
  std::array<double, 6> travel_m{value("travel_0"),  value("travel_20"), value("travel_40"),
                                 value("travel_60"), value("travel_80"), value("travel_100")};
  double displacement = value("displacement_per_radian");
  // Oil and chambers.
  double density = value("density");
  double modulus = value("bulk_modulus");
  double area = value("piston_area");
  double oil_volume = value("total_volume");
  double area_a = displacement > 0.0 ? displacement : value("area_a");
  double area_b = displacement > 0.0 ? displacement : value("area_b");
  double dead_a = value("dead_volume_a");
  double dead_b = value("dead_volume_b");
  double tank_pa = value("tank_pressure");
  double air = value("air_fraction");
  double air_exponent = value("air_exponent");
  double hose_a = value("hose_capacity_a");
  double hose_b = value("hose_capacity_b");
  double hose_yield = value("hose_yield");
  double hose_ratio = value("hose_yield_ratio");
  bool hoses = given("hose_yield") || given("hose_yield_ratio");
  double leak_size = value("leakage_coefficient") * value("leakage_area");
  double leak_resistance = value("leakage_resistance");
  double laminar = value("laminar_leakage");
  double outside_a = value("external_leakage_a");
  double outside_b = value("external_leakage_b");
  double make_up = value("make_up_conductance");
  double relief_pa = value("relief_pressure");
  double relief = value("relief_conductance");
  // Valve.
  bool pilot = given("pilot_gain");
  double valve_gain = value(pilot ? "pilot_gain" : "valve_gain");
  double valve_size = value("discharge_coefficient") * value("area_gradient");
  double band = value(pilot ? "pilot_dead_band" : "valve_dead_band");
  double return_band = value_if_given("return_dead_band", band);
  double null_shift = value("valve_offset");
  double clearance = value("valve_null_leakage");
  double null_opening = value("valve_null_opening");
  double line_opening = value("valve_line_opening");
  bool by_power = given(pilot ? "pilot_exponent" : "valve_exponent");
  double power = value(pilot ? "pilot_exponent" : "valve_exponent");
  bool return_by_power = by_power || given("return_exponent");
  double return_power = value_if_given("return_exponent", power);
  double range = value(pilot ? "pilot_range" : "valve_range");
  bool by_table = given("opening_40");
  std::array<double, 6> shares{
      0.0, value("opening_20"), value("opening_40"), value("opening_60"), value("opening_80"), 1.0};
  double return_line = value("return_line_opening");
  double return_resistance = value("return_line_resistance");
  double compensator = value("compensator_pressure");
  std::array<double, 4> edge_sizes{value("gain_supply_to_a"), value("gain_a_to_tank"),
                                   value("gain_supply_to_b"), value("gain_b_to_tank")};
  std::array<double, 4> edge_laps{value("overlap_supply_to_a"), value("overlap_a_to_tank"),
                                  value("overlap_supply_to_b"), value("overlap_b_to_tank")};
  int lag_of_valve = given("valve_frequency") ? 2 : given("valve_time_constant") ? 1 : 0;
  double valve_lag = value("valve_time_constant");
  double valve_frequency = value("valve_frequency");
  double valve_ratio = value("valve_damping_ratio");
  double main_gain = value("main_spool_gain");
  double slew = value_if_given("valve_rate_limit", kInfinity);
  // Supply.
  double source_pa = value("supply_pressure");
  bool supply = given("supply_capacity");
  double supply_capacity = value("supply_capacity");
  double supply_resistance = value("supply_resistance");
  double gas = value("accumulator_volume");
  double precharge_pa = value("accumulator_precharge") + 101325.0;
  double gas_exponent = value("accumulator_exponent");
  double pump = value_if_given("pump_flow", kInfinity);
  bool second_stage = given("pump_second_flow");
  double second_flow = value("pump_second_flow");
  double first_rate = value("pump_first_rate");
  double pump_delay = value("pump_delay");
  double pump_rise = value("pump_rise");
  bool load_sensing = given("load_sensing_margin");
  double margin = value("load_sensing_margin");
  double bypass = value("bypass_opening");
  double bypass_range = value(pilot ? "bypass_range" : "valve_bypass_range");
  // Controller.
  const FeedbackRow& keys = gain_keys(rig_.feedback);
  bool closed_loop = rig_.controller == ControllerKind::pid;
  double delay = value("transport_delay");
  double kp = value(keys.kp);
  double ki = value(keys.ki);
  double kd = value(keys.kd);  // three-variable control: gain of the velocity
  double acceleration_gain = value(keys.acceleration);
  double forward = value(keys.velocity_feedforward);
  double second_forward = value(keys.acceleration_feedforward);
  double inner = value("pressure_feedback");
  double filter = value("derivative_filter");
  double generator = value("reference_frequency");
  double generator_ratio = value("reference_damping_ratio");
  double limit = closed_loop ? value("output_limit") : kInfinity;

  double drive(double t) const { return amplitude_ * std::sin(turn_ * (t - delay)); }

  // Controller.

  bool generates() const { return is_three_variable(rig_.feedback); }

  double generated(const Whole& x, double t) const {
    const double square = generator * generator;
    const double wanted = drive(t) * (rig_.feedback == Feedback::three_variable ? square : 1.0) -
                          square * x[At::reference];
    return wanted - 2.0 * generator_ratio * generator * x[At::reference_rate];
  }

  double error(const Whole& x, double t) const {
    switch (rig_.feedback) {
      case Feedback::force:
        return drive(t) - rod_force(x);
      case Feedback::torque:
        return drive(t) - shaft_moment(x);
      case Feedback::load_pressure:
        return drive(t) - (x[At::a] - x[At::b]);
      case Feedback::acceleration:
        return drive(t) - acceleration(x);
      case Feedback::three_variable:
      case Feedback::three_variable_acceleration:
        return x[At::reference] - x[At::motion];
      case Feedback::position:
      case Feedback::angle:
        break;
    }
    return drive(t) - x[At::motion];
  }

  /// First and second rate of the reference, as they are fed forward.
  std::array<double, 2> forward_rates(const Whole& x, double t) const {
    if (generates()) return {x[At::reference_rate], generated(x, t)};
    const double rate = filter * (drive(t) - x[At::reference]);
    return {rate, filter * (rate - x[At::reference_rate])};
  }

  double unlimited(const Whole& x, double t) const {
    if (!closed_loop) return drive(t);
    const double e = error(x, t);
    double u = kp * e + x[At::integral] - inner * (x[At::a] - x[At::b]);
    if (generates()) {
      u += kd * (x[At::reference_rate] - x[At::speed]);
      u += acceleration_gain * (generated(x, t) - acceleration(x));
    } else if (kd > 0.0) {
      u += kd * filter * (e - x[At::error_filter]);
    }
    const auto rates = forward_rates(x, t);
    return u + forward * rates[0] + second_forward * rates[1];
  }

  void take_loop(const Whole& x, double t, Whole& dx) const {
    if (!closed_loop) return;
    const double wanted = unlimited(x, t);
    const double cut = std::clamp(wanted, -limit, limit) - wanted;
    if (ki > 0.0) dx[At::integral] = ki * error(x, t) + cut * (kp > 0.0 ? ki / kp : 100.0);
    if (kd > 0.0 && !generates())
      dx[At::error_filter] = filter * (error(x, t) - x[At::error_filter]);
    const auto rates = forward_rates(x, t);
    dx[At::reference] = rates[0];
    dx[At::reference_rate] = rates[1];
  }

  void take_valve(const Whole& x, double asked, Whole& dx) const {
    if (lag_of_valve == 0) return;
    const bool two_stages = main_gain > 0.0;
    const std::size_t first = two_stages ? At::pilot : At::spool;
    const std::size_t second = two_stages ? At::pilot_rate : At::pilot;
    if (two_stages) {
      dx[At::spool] = main_gain * x[At::pilot];
      asked = std::clamp(asked - x[At::spool], -slew / main_gain, slew / main_gain);
    }
    if (lag_of_valve == 1) {
      dx[first] = (asked - x[first]) / valve_lag;
    } else {
      dx[first] = x[second];
      dx[second] = valve_frequency * valve_frequency * (asked - x[first]) -
                   2.0 * valve_ratio * valve_frequency * x[second];
    }
    if (!two_stages) dx[At::spool] = std::clamp(dx[At::spool], -slew, slew);
  }

  // Motion.

  /// Travel of the piston and lever.
  std::array<double, 2> travel(double motion) const {
    if (plant_ != PlantKind::linkage) return {motion, 1.0};
    if (displacement > 0.0) return {motion, 1.0};
    if (base > 0.0) {
      // The cylinder as a vector between its pivots.
      const double side = triangle_angle < 0.0 ? -1.0 : 1.0;
      const double psi = motion - reference_angle + triangle_angle;
      const double x = arm * std::cos(psi);
      const double y = arm * std::sin(psi);
      const double length = std::hypot(x - base, y);
      const double before =
          std::hypot(arm * std::cos(triangle_angle) - base, arm * std::sin(triangle_angle));
      return {side * (length - before), side * base * y / length};
    }
    if (travel_table) {
      const double per_rad = 5.0 / (travel_to - travel_from);
      const double place = (motion - travel_from) * per_rad;
      // The lever is a line between the middles of the pieces.
      const double middle = std::clamp(place - 0.5, 0.0, 4.0);
      const auto at = static_cast<std::size_t>(std::min(std::floor(middle), 3.0));
      const double before = travel_m[at + 1] - travel_m[at];
      const double after = travel_m[at + 2] - travel_m[at + 1];
      const double slope = before + (middle - static_cast<double>(at)) * (after - before);
      return {rounded_line(place, travel_m, 0.5), slope * per_rad};
    }
    const double from = motion - reference_angle;
    const auto& [d0, d1, d2] = lever_terms;
    return {d0 * from + d1 * from * from / 2.0 + d2 * std::pow(from, 3) / 3.0,
            d0 + d1 * from + d2 * from * from};
  }

  double piston_force(const Whole& x) const {
    if (plant_ == PlantKind::load_pressure) return area * x[At::a];
    return area_a * x[At::a] - area_b * x[At::b];
  }

  double stops(const Whole& x) const {
    if (plant_ == PlantKind::load_pressure) return 0.0;
    const auto push = [&](double depth, double approach) {
      return depth > 0.0 ? stop_stiffness * depth * std::max(1.0 + stop_damping * approach, 0.0)
                         : 0.0;
    };
    return push(lower_stop - x[At::motion], -x[At::speed]) -
           push(x[At::motion] - upper_stop, x[At::speed]);
  }

  double piston_speed(const Whole& x) const { return travel(x[At::motion])[1] * x[At::speed]; }

  double sliding(const Whole& x) const {
    const double ratio = piston_speed(x) / breakaway_speed;
    const double more = breakaway > 0.0 ? breakaway * std::exp(-ratio * ratio) : 0.0;
    return dry + more * (1.0 - x[At::film]) + seal * std::abs(x[At::a] - x[At::b]);
  }
  double bristle_rate(const Whole& x) const {
    const double v = piston_speed(x);
    return bristle * (v - std::abs(v) * x[At::bristle] / sliding(x));
  }
  double film_rate(const Whole& x) const {
    const double square = piston_speed(x) * piston_speed(x);
    const double smooth = still_speed * still_speed;
    const double full =
        square / std::pow(square + smooth, 2.0 / 3.0) / std::cbrt(film_speed * film_speed);
    const double steady = std::min(full, 1.0);
    const double still = std::exp(-square / smooth);
    const double moving_s = x[At::film] < steady ? film_growth : film_decay;
    return (steady - x[At::film]) * (still / film_dwell + (1.0 - still) / moving_s);
  }
  /// Dry friction of piston and rod.
  double friction(const Whole& x) const {
    if (bristle > 0.0) return x[At::bristle] + bristle_damping / bristle * bristle_rate(x);
    return sliding(x) * std::tanh(piston_speed(x) / still_speed);
  }

  /// Acceleration of the second mass.
  double pull(const Whole& x) const {
    return second_frequency * second_frequency * (x[At::motion] - x[At::second]) +
           2.0 * second_ratio * second_frequency * (x[At::speed] - x[At::second_speed]);
  }

  /// Reading of a load cell in the rod.
  double rod_force(const Whole& x) const { return piston_force(x) + stops(x) - friction(x); }
  /// Reading of a transducer at the joint.
  double shaft_moment(const Whole& x) const {
    return travel(x[At::motion])[1] * (piston_force(x) - friction(x)) + stops(x) -
           joint_dry * std::tanh(x[At::speed] / joint_still_rate);
  }

  double acceleration(const Whole& x) const {
    if (plant_ == PlantKind::linkage) {
      const double from = x[At::motion] - reference_angle;
      const double weight =
          moment_terms[0] + moment_terms[1] * from + moment_terms[2] * from * from;
      return (shaft_moment(x) - joint_damping * x[At::speed] - weight) / mass;
    }
    double carried = load + spring * x[At::motion] + mass * gravity;
    if (load_table) {
      const double place = 5.0 * (x[At::motion] - table_from) / (table_to - table_from);
      carried += rounded_line(place, table_n, 0.25);
    } else {
      carried += load_slope * x[At::motion] + load_bend * x[At::motion] * x[At::motion];
    }
    carried += second_mass * (pull(x) + gravity);
    return (rod_force(x) - damping * x[At::speed] - carried) / mass;
  }

  // Oil.

  double leak(double head_pa) const {
    const double conductance = leak_size * std::sqrt(2.0 / density);
    const double orifice = leak_resistance > 0.0
                               ? flow_in_series(head_pa, conductance, leak_resistance)
                               : conductance * rounded_root(head_pa);
    return laminar * head_pa + orifice;
  }

  double at_valve_pa(const Whole& x) const { return supply ? x[At::supply] : source_pa; }

  void take_load_pressure(const Whole& x, double signal, Whole& dx) const {
    const double out = signal + null_shift;
    const double beyond = std::copysign(std::max(std::abs(out) - band, 0.0), out);
    const double head = at_valve_pa(x) - std::copysign(x[At::a], beyond * x[At::a]);
    const double through =
        valve_size / std::sqrt(density) * valve_gain * std::abs(beyond) * rounded_root(head);
    // Both chambers share the load pressure equally.
    const auto relieved = [&](double side) {
      return relief * std::max(0.5 * (at_valve_pa(x) + side * x[At::a]) - relief_pa, 0.0);
    };
    double flow = std::copysign(through, out) - clearance * x[At::a] - leak(x[At::a]);
    if (relief > 0.0) flow -= 0.5 * (relieved(1.0) - relieved(-1.0));
    dx[At::a] = 4.0 * modulus / oil_volume * (flow - area * x[At::speed]);
    if (supply) take_supply(x, out, through + clearance * x[At::supply], dx);
  }

  double opening(bool to_tank, double signal, double lap) const {
    const double beyond = signal - (to_tank ? return_band : band) - lap;
    double y = std::max(beyond, 0.0);
    if (null_opening > 0.0)
      y = beyond > 0.0 ? beyond + null_opening
                       : null_opening * null_opening / (null_opening - beyond);
    if (to_tank ? return_by_power : by_power) {
      y = range * std::pow(y / range, to_tank ? return_power : power);
    } else if (by_table) {
      const double place = 5.0 * y / range;
      const double piece = std::clamp(std::floor(place), 0.0, 4.0);
      const auto from = static_cast<std::size_t>(piece);
      y = range * (shares[from] + (place - piece) * (shares[from + 1] - shares[from]));
    }
    if (line_opening > 0.0) y = 1.0 / std::sqrt(std::pow(y, -2) + std::pow(line_opening, -2));
    y *= valve_gain;
    if (to_tank && return_line > 0.0)
      y = 1.0 / std::sqrt(std::pow(y, -2) + std::pow(return_line, -2));
    return y;
  }

  double edge(std::size_t which, double signal, double up_pa, double down_pa) const {
    const bool to_tank = which % 2 == 1;
    const double head = up_pa - down_pa;
    const double conductance = edge_sizes[which] * valve_size * std::sqrt(2.0 / density) *
                               opening(to_tank, signal, edge_laps[which]);
    if (to_tank && return_resistance > 0.0)
      return clearance * head + flow_in_series(head, conductance, return_resistance);
    const bool throttled = !to_tank && compensator > 0.0;
    return clearance * head +
           conductance * rounded_root(throttled ? std::min(head, compensator) : head);
  }

  double modulus_at(double p) const {
    if (!(air > 0.0)) return modulus;
    const double absolute = std::max(p + 101325.0, 1e3);
    const double bubbles = air * std::pow(101325.0 / absolute, 1.0 / air_exponent);
    return (bubbles + 1.0 - air) / (bubbles / (air_exponent * absolute) + (1.0 - air) / modulus);
  }

  void take_chambers(const Whole& x, double signal, Whole& dx) const {
    const double out = signal + null_shift;
    const double to_a = edge(0, out, at_valve_pa(x), x[At::a]);
    const double to_b = edge(2, -out, at_valve_pa(x), x[At::b]);
    const double across = leak(x[At::a] - x[At::b]);
    const auto [s, lever] = travel(x[At::motion]);
    const double rate = lever * x[At::speed];
    const auto ports = [&](double p, double outside) {
      const double above = relief > 0.0 ? std::max(p - relief_pa, 0.0) : 0.0;
      return make_up * std::max(tank_pa - p, 0.0) - relief * above - outside * (p - tank_pa);
    };
    const double flow_a = to_a - edge(1, -out, x[At::a], tank_pa) - across +
                          ports(x[At::a], outside_a) - area_a * rate;
    const double flow_b = to_b - edge(3, out, x[At::b], tank_pa) + across +
                          ports(x[At::b], outside_b) + area_b * rate;
    take_chamber(x, flow_a, dead_a + area_a * (s - travel(lower_stop)[0]), hose_a, At::a,
                 At::hose_a, dx);
    take_chamber(x, flow_b, dead_b + area_b * (travel(upper_stop)[0] - s), hose_b, At::b,
                 At::hose_b, dx);
    if (supply) take_supply(x, out, to_a + to_b, dx);
  }

  void take_chamber(const Whole& x, double flow, double volume, double hose, std::size_t pressure,
                    std::size_t memory, Whole& dx) const {
    const double p = x[pressure];
    const double along = flow > 0.0 ? x[memory] : -x[memory];
    const double share = hoses ? std::pow(std::clamp(0.5 + 0.5 * along, 0.0, 1.0), 2) : 0.0;
    dx[pressure] = flow / (volume / modulus_at(p) + share * hose);
    if (hoses)
      dx[memory] = (1.0 - share) * dx[pressure] / (hose_yield + hose_ratio * (p + 101325.0));
  }

  void take_supply(const Whole& x, double out, double taken, Whole& dx) const {
    const double beyond = std::max(std::abs(out) - band, 0.0);
    const double asked = std::tanh(beyond / (pilot ? 1e5 : 0.1));
    const double driven = out < 0.0 ? x[At::b] : x[At::a];
    double kept = source_pa;
    if (load_sensing)
      kept = std::min(kept, tank_pa + margin + asked * std::max(driven - tank_pa, 0.0));
    double largest = pump;
    if (second_stage) {
      const double first = pump + first_rate * x[At::demand];
      const double rises = 0.5 + 0.5 * std::tanh((x[At::demand] - pump_delay) / pump_rise);
      largest = first + rises * (second_flow - first);
      dx[At::demand] = asked - (1.0 - asked) * x[At::demand] / pump_delay;
    }
    double flow = std::min((kept - x[At::supply]) / supply_resistance, largest) - taken;
    if (bypass > 0.0)
      flow -= valve_size * std::sqrt(2.0 / density) * bypass *
              std::max(1.0 - beyond / bypass_range, 0.0) * rounded_root(x[At::supply] - tank_pa);
    double capacity = supply_capacity;
    if (gas > 0.0) {
      const double p = x[At::supply] + 101325.0;
      capacity += 0.5 * (1.0 + std::tanh((p / precharge_pa - 1.0) / 0.02)) * gas /
                  (gas_exponent * p) * std::pow(precharge_pa / p, 1.0 / gas_exponent);
    }
    dx[At::supply] = flow / capacity;
  }
};

/// A rig under a sine.
struct TermCase {
  std::string name;
  Experiment e;
  double amplitude;
  double frequency_hz;
};

/// Terms that every plant has.
Experiment& with_oil_and_valve(Experiment& e) {
  e.set("reference_temperature", 313.15).set("oil_temperature", 328.15);
  e.set("viscosity_decay", 0.03).set("thermal_expansion", 7e-4).set("bulk_modulus_decay", 4e-3);
  e.set("valve_offset", 0.3).set("valve_dead_band", 0.4).set("transport_delay", 0.03);
  return e;
}

Experiment& with_dry_friction(Experiment& e, double force_n) {
  e.set("coulomb_friction", force_n).set("stribeck_friction", 0.8 * force_n);
  return e.set("stribeck_velocity", 0.02).set("friction_smoothing", 4e-3);
}

Experiment& with_bristles_and_film(Experiment& e, double force_n, double stiffness) {
  with_dry_friction(e, force_n).set("seal_friction", 1e-4);
  e.set("bristle_stiffness", stiffness).set("bristle_damping", 2e-3 * stiffness);
  e.set("film_velocity", 0.05).set("film_growth_time", 0.05).set("film_decay_time", 0.08);
  return e.set("film_dwell_time", 0.06).set("friction_smoothing", 0.02);
}

Experiment& with_two_stages(Experiment& e) {
  e.set("valve_frequency", 400.0).set("valve_damping_ratio", 0.6).set("main_spool_gain", 80.0);
  return e.set("valve_rate_limit", 40.0);
}

Experiment& with_second_mass(Experiment& e, double mass_kg, double frequency_rad_per_s) {
  e.set("payload_mass", mass_kg).set("payload_frequency", frequency_rad_per_s);
  return e.set("payload_damping_ratio", 0.15);
}

Experiment& with_accumulator(Experiment& e, double gas_m3) {
  e.set("accumulator_volume", gas_m3).set("accumulator_precharge", 2e6);
  return e.set("accumulator_exponent", 1.3);
}

Experiment& with_pump(Experiment& e) {
  with_accumulator(e, 2e-4).set("supply_resistance", 2e9).set("supply_capacity", 5e-12);
  e.set("pump_flow", 5e-4).set("pump_second_flow", 8e-4).set("pump_delay", 0.4);
  e.set("pump_rise", 0.1).set("pump_first_rate", 2e-4).set("load_sensing_margin", 2e6);
  e.set("bypass_opening", 5e-5);
  e.set("make_up_conductance", 2e-9).set("relief_pressure", 9e6).set("relief_conductance", 3e-10);
  return e;
}

Experiment& with_pilot(Experiment& e) {
  e.set("pilot_exponent", 1.6).set("pilot_range", 1.5e6).set("bypass_range", 1.2e6);
  e.set("gain_supply_to_a", 1.1).set("gain_a_to_tank", 0.8).set("gain_supply_to_b", 1.2);
  e.set("gain_b_to_tank", 0.7).set("return_dead_band", 0.8e6).set("return_exponent", 1.3);
  return e.set("return_line_opening", 3e-4)
      .set("return_line_resistance", 2e9)
      .set("compensator_pressure", 8e5);
}

Experiment& with_opening_table(Experiment& e, double range_v) {
  e.set("valve_range", range_v).set("opening_20", 0.1).set("opening_40", 0.25);
  return e.set("opening_60", 0.5).set("opening_80", 0.75);
}

Experiment& with_load_table(Experiment& e, double from_m, double to_m, double size_n) {
  e.set("load_table_from", from_m).set("load_table_to", to_m);
  constexpr std::array kKeys{"load_0", "load_20", "load_40", "load_60", "load_80", "load_100"};
  constexpr std::array kShares{0.3, -0.4, 0.2, 0.9, 0.5, 1.5};
  for (std::size_t i = 0; i < kKeys.size(); ++i) e.set(kKeys[i], size_n * kShares[i]);
  return e;
}

/// Gains of a loop on one quantity, with inner feedback and a limit that it reaches.
Experiment& with_loop(Experiment& e, Feedback feedback, double kp, double ki, double kd,
                      double limit_v) {
  e.rig.controller = ControllerKind::pid;
  e.rig.feedback = feedback;
  if (e.values.is_given("kp")) e.unset("kp");
  const FeedbackRow& keys = gain_keys(feedback);
  e.set(keys.kp, kp).set(keys.ki, ki).set(keys.kd, kd).set("output_limit", limit_v);
  return e.set("valve_time_constant", 2e-3);
}

std::vector<TermCase> load_pressure_cases() {
  std::vector<TermCase> cases;
  const auto add = [&](const char* name, Experiment e, double amplitude, double frequency_hz) {
    e.times_s = grid(0.0, 0.6, 13);
    e.outputs = {Output::position, Output::velocity, Output::load_pressure, Output::command};
    cases.push_back({std::string("load_pressure: ") + name, e, amplitude, frequency_hz});
  };
  Experiment plain;
  plain.rig.controller = ControllerKind::none;
  plain.set("stiffness", 1e5).set("damping", 3000.0);
  {
    Experiment e = plain;
    with_dry_friction(with_oil_and_valve(e), 200.0).set("seal_friction", 1e-4);
    e.set("valve_null_leakage", 4e-12).set("laminar_leakage", 1e-11);
    e.set("leakage_resistance", 2e10).set("external_force", 300.0).set("load_gradient", -2e4);
    e.set("load_curvature", 2e7).set("valve_time_constant", 5e-3).set("valve_rate_limit", 70.0);
    add("oil, valve, leaks, load", with_second_mass(e, 40.0, 60.0), 6.0, 4.0);
  }
  {
    Experiment e = plain;
    with_two_stages(with_bristles_and_film(e, 200.0, 1e6));
    add("two stages, bristles and film, load table", with_load_table(e, -1e-3, 4e-3, 400.0), 5.0,
        3.0);
  }
  {
    Experiment e = plain;
    with_accumulator(e, 5e-5).set("supply_resistance", 1e10).set("supply_capacity", 5e-13);
    e.set("pump_flow", 1e-4).set("relief_pressure", 3.2e6).set("relief_conductance", 5e-11);
    e.set("external_force", 2e3);
    add("pump, accumulator, relief valves", e.set("valve_null_leakage", 4e-12), 6.0, 4.0);
  }
  {
    Experiment e = plain;
    with_loop(e, Feedback::position, 100.0, 500.0, 0.3, 2.0).set("derivative_filter", 250.0);
    e.set("velocity_feedforward", 20.0).set("acceleration_feedforward", 0.08);
    add("loop on position", e.set("pressure_feedback", 3e-8), 8e-3, 5.0);
  }
  const auto loop = [&](const char* name, Feedback feedback, double amplitude, double kp, double ki,
                        double kd, double limit_v) {
    Experiment e = plain;
    with_loop(e, feedback, kp, ki, kd, limit_v).set("derivative_filter", 300.0);
    add(name, e, amplitude, 3.0);
  };
  loop("loop on force", Feedback::force, 2e3, 5e-5, 1e-3, 5e-8, 10.0);
  loop("loop on load pressure", Feedback::load_pressure, 1e6, 8e-8, 2e-6, 8e-11, 10.0);
  loop("loop on acceleration", Feedback::acceleration, 20.0, 9e-3, 0.1, 1e-5, 10.0);
  for (const Feedback feedback :
       {Feedback::three_variable, Feedback::three_variable_acceleration}) {
    Experiment e = plain;
    with_loop(e, feedback, 200.0, 900.0, 3.0, 10.0).set("acceleration_kp", 4e-3);
    e.set("velocity_feedforward", 10.0).set("acceleration_feedforward", 0.05);
    e.set("reference_frequency", 60.0).set("reference_damping_ratio", 0.7);
    add("three-variable control", e, feedback == Feedback::three_variable ? 0.01 : 12.0, 5.0);
  }
  return cases;
}

std::vector<TermCase> two_chamber_cases() {
  std::vector<TermCase> cases;
  const auto add = [&](const char* name, Experiment e, double amplitude, double frequency_hz) {
    e.times_s = grid(0.0, 1.4, 15);
    e.outputs = {Output::position, Output::velocity, Output::pressure_a, Output::pressure_b,
                 e.rig.pilot ? Output::pilot_pressure : Output::command};
    cases.push_back({std::string("two_chamber: ") + name, e, amplitude, frequency_hz});
  };
  {
    Experiment e = proportional_rig();
    with_dry_friction(with_oil_and_valve(e), 2e3).set("seal_friction", 2e-4);
    e.set("gain_supply_to_a", 1.1).set("gain_a_to_tank", 0.8).set("gain_supply_to_b", 1.3);
    e.set("gain_b_to_tank", 0.9).set("overlap_supply_to_a", 0.2).set("overlap_a_to_tank", -0.6);
    e.set("overlap_supply_to_b", 0.3).set("overlap_b_to_tank", -0.5);
    e.set("hose_capacity_a", 1.5e-12).set("hose_capacity_b", 1e-12).set("hose_yield", 5e5);
    e.set("hose_yield_ratio", 0.2).set("air_fraction", 0.02).set("air_exponent", 1.3);
    e.set("supply_resistance", 5e9).set("supply_capacity", 5e-12).set("gravity", 9.81);
    e.set("external_leakage_a", 3e-12).set("external_leakage_b", 4e-12);
    e.set("laminar_leakage", 2e-12).set("leakage_coefficient", 0.5).set("leakage_resistance", 5e10);
    e.set("valve_null_leakage", 2e-12).set("valve_time_constant", 0.01).set("stiffness", 5e4);
    add("laps, hoses, air, leaks, supply", e.set("valve_rate_limit", 35.0), 8.0, 0.8);
  }
  {
    Experiment e = proportional_rig();
    e.set("valve_null_opening", 0.3).set("valve_line_opening", 4.0).set("valve_gain", 6e-6);
    e.set("retracted_position", -4e-3).set("stroke", 8e-3).set("stop_stiffness", 3e7);
    e.set("stop_damping", 2.0).set("external_force", 4e3).set("hose_yield", 3e5);
    e.set("hose_capacity_a", 1e-12).set("hose_capacity_b", 1e-12);
    add("covered edges, lines, stops", e, 8.0, 0.8);
  }
  {
    Experiment e = proportional_rig();
    with_bristles_and_film(e, 3e3, 3e6).set("valve_gain", 6e-6).set("external_force", 2e3);
    e.set("load_gradient", 2e5).set("load_curvature", 3e6).set("gravity", 9.81);
    add("two stages, bristles and film, second mass",
        with_second_mass(with_two_stages(e), 600.0, 25.0), 8.0, 0.8);
  }
  {
    Experiment e = proportional_rig();
    with_load_table(e, -5e-4, 3e-3, 1e4).set("valve_gain", 6e-6);
    add("opening and load by tables", with_opening_table(e, 9.0), 9.0, 0.8);
  }
  {
    Experiment e = proportional_rig();
    with_pump(e).set("valve_exponent", 1.7).set("valve_range", 6.0).set("valve_bypass_range", 4.0);
    e.set("valve_gain", 3e-5).set("external_force", 2.5e4).set("load_gradient", 3e4);
    add("electric valve by a power, pump", e, 6.0, 0.8);
  }
  {
    Experiment e = pilot_rig();
    with_pilot(with_pump(e)).set("pilot_gain", 8e-11).set("external_force", 8e3);
    add("pilot-operated valve, pump", e.set("load_gradient", 3e4), 2.6e6, 0.8);
  }
  const auto looped = [](Feedback feedback, double kp, double ki, double kd, double limit_v) {
    Experiment e = proportional_rig();
    e.set("stiffness", 2e5).set("valve_dead_band", 0.0);
    with_loop(e, feedback, kp, ki, kd, limit_v);
    return e;
  };
  {
    Experiment e = looped(Feedback::position, 300.0, 400.0, 0.6, 3.0);
    e.set("velocity_feedforward", 20.0).set("acceleration_feedforward", 0.6);
    e.set("derivative_filter", 100.0).set("pressure_feedback", 1e-7);
    add("loop on position", e, 0.02, 1.0);
  }
  const auto loop = [&](const char* name, Feedback feedback, double amplitude, double kp, double ki,
                        double kd) {
    add(name, looped(feedback, kp, ki, kd, 10.0).set("derivative_filter", 300.0), amplitude, 3.0);
  };
  loop("loop on force", Feedback::force, 8e3, 2e-4, 2e-3, 1e-6);
  loop("loop on load pressure", Feedback::load_pressure, 2.5e6, 6e-7, 6e-7, 1e-9);
  loop("loop on acceleration", Feedback::acceleration, 4.0, 0.4, 4.0, 2e-3);
  for (const Feedback feedback :
       {Feedback::three_variable, Feedback::three_variable_acceleration}) {
    Experiment e = looped(feedback, 150.0, 300.0, 3.0, 10.0).set("acceleration_kp", 0.05);
    e.set("velocity_feedforward", 10.0).set("acceleration_feedforward", 0.05);
    e.set("reference_frequency", 40.0).set("reference_damping_ratio", 0.7);
    add("three-variable control", e, feedback == Feedback::three_variable ? 0.01 : 4.0, 2.0);
  }
  return cases;
}

/// An arm that a load moment and dry friction resist.
Experiment loaded_arm() {
  Experiment e = arm_rig();
  e.set("joint_damping", 1e4).set("gravity_moment", 4e3).set("gravity_moment_gradient", 1500.0);
  e.set("gravity_moment_curvature", 1500.0).set("joint_friction", 600.0);
  return e.set("joint_friction_smoothing", 0.2).set("reference_angle", 0.1);
}

Experiment electric_arm() {
  Experiment e = loaded_arm().unset("pilot_gain").unset("pilot_dead_band");
  e.rig.pilot = false;
  return e.set("valve_gain", 1e-4);
}

std::vector<TermCase> linkage_cases() {
  std::vector<TermCase> cases;
  const auto add = [&](const char* name, Experiment e, double amplitude, double frequency_hz) {
    e.times_s = grid(0.0, 1.6, 17);
    e.outputs = {Output::angle, Output::angular_velocity, Output::pressure_a, Output::pressure_b,
                 e.rig.pilot ? Output::pilot_pressure : Output::command};
    cases.push_back({std::string("linkage: ") + name, e, amplitude, frequency_hz});
  };
  {
    Experiment e = loaded_arm();
    with_pilot(with_pump(e)).set("lever_gradient", -0.12).set("lever_curvature", -0.09);
    e.set("lower_stop", 0.09).set("upper_stop", 0.16).set("stop_stiffness", 3e6);
    e.set("stop_damping", 1.0).set("dead_volume_a", 2e-3);
    add("pilot-operated valve, pump, stops", e.set("valve_time_constant", 0.02), 2.6e6, 0.8);
  }
  {
    Experiment e = electric_arm().unset("lever");
    e.set("triangle_base", 1.2).set("triangle_arm", 0.35).set("triangle_angle", 1.3);
    with_two_stages(with_oil_and_valve(e)).set("valve_frequency", 150.0);
    e.set("valve_null_leakage", 2e-12);
    e.set("laminar_leakage", 4e-12).set("leakage_coefficient", 0.5).set("leakage_resistance", 5e10);
    e.set("external_leakage_a", 3e-12).set("external_leakage_b", 4e-12);
    e.set("air_fraction", 0.02).set("air_exponent", 1.3);
    add("triangle, oil, leaks, two stages", e, 6.0, 0.5);
  }
  {
    Experiment e = electric_arm().unset("lever").unset("area_a").unset("area_b");
    e.set("displacement_per_radian", 1.1e-3).set("gravity_moment", 8e3);
    with_pump(e).set("valve_exponent", 1.5).set("valve_range", 6.0).set("valve_bypass_range", 4.0);
    add("rotary actuator, valve by a power, pump", e.set("valve_rate_limit", 12.0), 6.0, 0.5);
    cases.back().e.set("valve_time_constant", 0.02);
  }
  {
    Experiment e = electric_arm().unset("lever");
    e.set("travel_table_from", -1.2).set("travel_table_to", 1.3);
    constexpr std::array kKeys{"travel_0",  "travel_20", "travel_40",
                               "travel_60", "travel_80", "travel_100"};
    constexpr std::array kTravel_m{0.02, 0.10, 0.24, 0.40, 0.52, 0.61};
    for (std::size_t i = 0; i < kKeys.size(); ++i) e.set(kKeys[i], kTravel_m[i]);
    add("travel and opening by tables", with_opening_table(e, 8.0), 7.0, 0.5);
    with_bristles_and_film(e, 4e3, 2e6).set("seal_friction", 2e-4).set("stribeck_velocity", 0.2);
    e.set("friction_smoothing", 0.05);
    add("bristles and film of the cylinder", e, 7.0, 0.5);
  }
  const auto loop = [&](const char* name, Feedback feedback, double amplitude, double kp, double ki,
                        double kd, double limit_v) {
    Experiment e = electric_arm();
    with_loop(e, feedback, kp, ki, kd, limit_v).set("derivative_filter", 100.0);
    e.set("gravity_moment_gradient", feedback == Feedback::angle ? 1500.0 : 1e5);
    if (feedback != Feedback::angle) return add(name, e, amplitude, 0.5);
    add(name, e.set("pressure_feedback", 5e-8), amplitude, 0.5);
    e = electric_arm();  // a loop with all gains and both rates would have more states than room
    with_loop(e, feedback, kp, ki, 0.0, limit_v).unset("angle_kd").set("derivative_filter", 100.0);
    e.set("angular_velocity_feedforward", 0.6).set("angular_acceleration_feedforward", 0.05);
    add("feed-forward of the angle", e, amplitude, 0.5);
  };
  loop("loop on angle", Feedback::angle, 0.5, 10.0, 8.0, 0.2, 4.0);
  loop("loop on torque", Feedback::torque, 4e3, 1e-4, 3e-4, 1e-6, 10.0);
  loop("loop on load pressure", Feedback::load_pressure, 3e6, 1e-7, 2e-7, 1e-9, 10.0);
  return cases;
}

std::vector<TermCase> all_term_cases() {
  std::vector<TermCase> cases = load_pressure_cases();
  for (const auto& more : {two_chamber_cases(), linkage_cases()})
    cases.insert(cases.end(), more.begin(), more.end());
  for (TermCase& each : cases) {
    each.e.inputs.drive = Signal::sine(each.amplitude, each.frequency_hz);
    each.e.options.tolerance = 1e-9;
  }
  return cases;
}

Simulation good_run(const Experiment& e) {
  Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return run;
}

/// Relative difference up to which both integrators agree.
constexpr double kAgrees = 2e-5;

/// Rows that no case below compares, with the reason.
struct Uncompared {
  std::string_view key;
  std::string_view reason;
};
constexpr std::array kUncompared{
    Uncompared{"sample_time",
               "a sampled controller jumps at its ticks; the tests of each loop compute these"},
};

bool is_uncompared(std::string_view key) {
  return std::any_of(kUncompared.begin(), kUncompared.end(),
                     [key](const Uncompared& row) { return row.key == key; });
}

/// Whether a row is part of the differential equation of a rig that has it. Readings follow from a
/// run by closed forms (sensors_test.cpp), and initial values are where it begins.
bool is_optional_term(const ParameterSpec& spec) {
  return spec.kind == ParameterKind::term || spec.kind == ParameterKind::controller;
}

}  // namespace

TEST_CASE("every term: rigs with all terms follow an integrator of another kind", "[model]") {
  for (const TermCase& each : all_term_cases()) {
    const Experiment& e = each.e;
    CAPTURE(each.name);
    const Simulation run = good_run(e);
    const OwnRig own(e, each.amplitude, each.frequency_hz);
    // The oil of the load-pressure rigs is stiffer than that of the others.
    const bool one_pressure = e.rig.plant == PlantKind::load_pressure;
    const Whole start =
        own.start(run.outputs(0, 0), run.outputs(0, 2), one_pressure ? 0.0 : run.outputs(0, 3));
    const Eigen::MatrixXd states =
        runge_kutta(start, e.times_s, one_pressure ? 2000 : 1000,
                    [&own](const Whole& x, double t) { return own.rates(x, t); });
    Eigen::MatrixXd other(run.outputs.rows(), run.outputs.cols());
    const Eigen::Index last = other.cols() - 1;
    other.leftCols(last) = states.leftCols(last);
    for (Eigen::Index i = 0; i < states.rows(); ++i) {
      Whole x;
      for (std::size_t k = 0; k < x.size(); ++k) x[k] = states(i, static_cast<Eigen::Index>(k));
      other(i, last) = own.command(x, e.times_s[static_cast<std::size_t>(i)]);
    }
    CHECK(difference(run.outputs, other) < kAgrees);
    Experiment by_other_method = e;
    by_other_method.options.method = Method::dopri5;
    CHECK(difference(good_run(by_other_method).outputs, other) < kAgrees);
  }
}

TEST_CASE("every term: no row of a plant is left out of the comparison", "[model][long]") {
  constexpr double kChange = 1.2;
  std::array<std::set<std::string_view>, 3> compared;  // by plant
  for (const TermCase& each : all_term_cases()) {
    const auto table = parameter_table(each.e.rig.plant);
    auto& of_plant = compared.at(static_cast<std::size_t>(each.e.rig.plant));
    const Simulation run = good_run(each.e);
    for (std::size_t i = 0; i < table.size(); ++i) {
      const std::string_view key = table[i].key;
      if (!is_optional_term(table[i]) || !each.e.values.given[i] || of_plant.contains(key))
        continue;
      // A case compares a term if it notices a change of it.
      Experiment changed = each.e;
      changed.set(key, kChange * each.e.values.value[i]);
      if (difference(run.outputs, good_run(changed).outputs) > 5.0 * kAgrees) of_plant.insert(key);
    }
  }
  for (const PlantKind plant :
       {PlantKind::load_pressure, PlantKind::two_chamber, PlantKind::linkage}) {
    const auto& of_plant = compared.at(static_cast<std::size_t>(plant));
    for (const ParameterSpec& spec : parameter_table(plant)) {
      if (!is_optional_term(spec)) continue;
      CAPTURE(to_string(plant), spec.key);
      CHECK(of_plant.contains(spec.key) != is_uncompared(spec.key));
    }
  }
  for (const Uncompared& row : kUncompared) CHECK_FALSE(row.reason.empty());
}
