#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "model/plant/two_chamber_parameters.hpp"

namespace rigcal::model {

/// A cylinder that turns an arm. Oil, valve and chambers are those of TwoChamberParameters. The
/// inherited members for a sliding load have no row in the table.
template <typename T>
struct LinkageParameters : TwoChamberParameters<T> {
  T inertia_kg_m2{};
  T joint_damping_n_m_s_per_rad{};
  T lever_m_per_rad{};
  T displacement_m3_per_rad{};
  T lower_stop_rad{};
  T upper_stop_rad{};
  T reference_angle_rad{};
  T lever_gradient_m_per_rad2{};
  T lever_curvature_m_per_rad3{};
  T triangle_base_m{};
  T triangle_arm_m{};
  T triangle_angle_rad{};
  T travel_table_from_rad{};
  T travel_table_to_rad{};
  T travel_0_m{};
  T travel_20_m{};
  T travel_40_m{};
  T travel_60_m{};
  T travel_80_m{};
  T travel_100_m{};
  T gravity_moment_n_m{};
  T gravity_moment_gradient_n_m_per_rad{};
  T gravity_moment_curvature_n_m_per_rad2{};
  T joint_friction_n_m{};
  T joint_friction_smoothing_rad_per_s{};
  T angle_stop_stiffness_n_m_per_rad{};
  T angle_stop_damping_s_per_rad{};
  T angle_gain{};
  T angle_lag_s{};
  T angle_maximum_rad{};
  T angle_offset_rad{};
  T torque_gain{};
  T torque_lag_s{};
  T torque_maximum_n_m{};
  T torque_offset_n_m{};
  T initial_angle_rad{};
  T initial_angular_velocity_rad_per_s{};
  T angle_kp_v_per_rad{};
  T angle_ki_v_per_rad_s{};
  T angle_kd_v_s_per_rad{};
  T torque_kp_v_per_n_m{};
  T torque_ki_v_per_n_m_s{};
  T torque_kd_v_s_per_n_m{};
  T angular_velocity_feedforward_v_s_per_rad{};
  T angular_acceleration_feedforward_v_s2_per_rad{};
};

/// The joint: replaces mass, stroke and position of a sliding load.
template <typename T>
constexpr auto joint_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::inertia_kg_m2, {"inertia", "inertia_kg_m2", "J", "kg m2", "moment of inertia about the joint", "docs/model.md", K::plant, 1e-6, 1e9}},
      F{&P::joint_damping_n_m_s_per_rad, {"joint_damping", "joint_damping_n_m_s_per_rad", "c", "N m s/rad", "viscous friction of joint and cylinder", "docs/model.md", K::plant, 0, 1e12}},
      F{&P::lever_m_per_rad, {"lever", "lever_m_per_rad", "D_0", "m/rad", "lever of the cylinder force at the reference angle: travel of the piston per unit of angle", "docs/model.md", K::term, 1e-4, 100, 0.0}},
      F{&P::displacement_m3_per_rad, {"displacement_per_radian", "displacement_per_radian_m3_per_rad", "V_r", "m3/rad", "displacement of a rotary actuator per unit of angle: a vane or rack motor in place of cylinder and lever", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::lower_stop_rad, {"lower_stop", "lower_stop_rad", "theta_1", "rad", "angle of the stop or support at which the piston is retracted", "docs/model.md", K::plant, -1000, 1000}},
      F{&P::upper_stop_rad, {"upper_stop", "upper_stop_rad", "theta_2", "rad", "angle of the stop at which the piston is extended", "docs/model.md", K::plant, -1000, 1000}},
      // clang-format on
  };
}

/// Travel of the piston over the angle by a triangle or a table, instead of the polynomial.
template <typename T>
constexpr auto travel_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::triangle_base_m, {"triangle_base", "triangle_base_m", "a", "m", "distance from the joint to the pivot of the cylinder's body: the lever by a triangle", "docs/model.md", K::term, 1e-3, 1000, 0.0}},
      F{&P::triangle_arm_m, {"triangle_arm", "triangle_arm_m", "b", "m", "distance from the joint to the pivot of the rod, on the arm", "docs/model.md", K::term, 1e-3, 1000, 0.0}},
      F{&P::triangle_angle_rad, {"triangle_angle", "triangle_angle_rad", "psi_0", "rad", "angle between these two distances at the reference angle; negative if the cylinder shortens as the angle grows", "docs/model.md", K::term, -3.1416, 3.1416, 0.0}},
      F{&P::travel_table_from_rad, {"travel_table_from", "travel_table_from_rad", "theta_T0", "rad", "angle at which the table of the travel begins", "docs/model.md", K::term, -1000, 1000, 0.0, false}},
      F{&P::travel_table_to_rad, {"travel_table_to", "travel_table_to_rad", "theta_T1", "rad", "angle at which the table of the travel ends", "docs/model.md", K::term, -1000, 1000, 0.0, false}},
      F{&P::travel_0_m, {"travel_0", "travel_0_m", "S_0", "m", "travel of the piston at the start of the table", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::travel_20_m, {"travel_20", "travel_20_m", "S_20", "m", "travel of the piston at 20 % of the range of the table", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::travel_40_m, {"travel_40", "travel_40_m", "S_40", "m", "travel of the piston at 40 % of the range of the table", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::travel_60_m, {"travel_60", "travel_60_m", "S_60", "m", "travel of the piston at 60 % of the range of the table", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::travel_80_m, {"travel_80", "travel_80_m", "S_80", "m", "travel of the piston at 80 % of the range of the table", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::travel_100_m, {"travel_100", "travel_100_m", "S_100", "m", "travel of the piston at the end of the table", "docs/model.md", K::term, -100, 100, 0.0}},
      // clang-format on
  };
}

/// Optional terms for lever, load and stops.
template <typename T>
constexpr auto linkage_term_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::reference_angle_rad, {"reference_angle", "reference_angle_rad", "theta_0", "rad", "angle at which lever, load moment and triangle_angle have the given values", "docs/model.md", K::term, -1000, 1000, 0.0, false}},
      F{&P::lever_gradient_m_per_rad2, {"lever_gradient", "lever_gradient_m_per_rad2", "D_1", "m/rad2", "increase of the lever per unit of angle", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::lever_curvature_m_per_rad3, {"lever_curvature", "lever_curvature_m_per_rad3", "D_2", "m/rad3", "increase of the lever per unit of angle squared", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::gravity_moment_n_m, {"gravity_moment", "gravity_moment_n_m", "M_0", "N m", "moment of the load at the reference angle, opposing positive angles", "docs/model.md", K::term, -1e9, 1e9, 0.0}},
      F{&P::gravity_moment_gradient_n_m_per_rad, {"gravity_moment_gradient", "gravity_moment_gradient_n_m_per_rad", "M_1", "N m/rad", "increase of this moment per unit of angle; negative if it decreases", "docs/model.md", K::term, -1e9, 1e9, 0.0}},
      F{&P::gravity_moment_curvature_n_m_per_rad2, {"gravity_moment_curvature", "gravity_moment_curvature_n_m_per_rad2", "M_2", "N m/rad2", "increase of this moment per unit of angle squared", "docs/model.md", K::term, -1e9, 1e9, 0.0}},
      F{&P::joint_friction_n_m, {"joint_friction", "joint_friction_n_m", "M_c", "N m", "dry friction of joint and cylinder", "docs/model.md", K::term, 0, 1e9, 0.0}},
      F{&P::joint_friction_smoothing_rad_per_s, {"joint_friction_smoothing", "joint_friction_smoothing_rad_per_s", "omega_0", "rad/s", "angular velocity below which this friction is smoothed", "docs/model.md", K::term, 1e-6, 10, 1e-3, false}},
      F{&P::angle_stop_stiffness_n_m_per_rad, {"stop_stiffness", "stop_stiffness_n_m_per_rad", "k_s", "N m/rad", "stiffness of stops and support", "docs/model.md", K::term, 1e3, 1e13, 1e8}},
      F{&P::angle_stop_damping_s_per_rad, {"stop_damping", "stop_damping_s_per_rad", "lambda_s", "s/rad", "damping of the stops over their stiffness", "docs/model.md", K::term, 0, 1e6, 10.0}},
      // clang-format on
  };
}

/// Sensors and initial state of the joint.
template <typename T>
constexpr auto angle_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::angle_gain, {"angle_gain", "angle_gain", "s_theta", "1", "gain of the sensor: recorded over true angle", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::angle_lag_s, {"angle_lag", "angle_lag_s", "tau_theta", "s", "first-order lag of the angle sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::angle_maximum_rad, {"angle_maximum", "angle_maximum_rad", "max_theta", "rad", "largest angle that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1000, kInf, kInf, false}},
      F{&P::angle_offset_rad, {"angle_offset", "angle_offset_rad", "theta_off", "rad", "offset of the sensor: recorded minus true angle", "docs/model.md", K::sensor, -1000, 1000, 0.0}},
      F{&P::torque_gain, {"torque_gain", "torque_gain", "s_M", "1", "gain of the sensor: recorded over true torque", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::torque_lag_s, {"torque_lag", "torque_lag_s", "tau_M", "s", "first-order lag of the torque sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::torque_maximum_n_m, {"torque_maximum", "torque_maximum_n_m", "max_M", "N m", "largest torque that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e9, kInf, kInf, false}},
      F{&P::torque_offset_n_m, {"torque_offset", "torque_offset_n_m", "M_off", "N m", "offset of the sensor: recorded minus true torque", "docs/model.md", K::sensor, -1e9, 1e9, 0.0}},
      F{&P::initial_angle_rad, {"initial_angle", "initial_angle_rad", "theta(0)", "rad", "recorded angle at the first sample", "docs/model.md", K::initial, -1000, 1000, 0.0}},
      F{&P::initial_angular_velocity_rad_per_s, {"initial_angular_velocity", "initial_angular_velocity_rad_per_s", "omega(0)", "rad/s", "angular velocity at the first sample", "docs/model.md", K::initial, -1000, 1000, 0.0}},
      // clang-format on
  };
}

/// Gains of loops on the angle and on the torque.
template <typename T>
constexpr auto joint_loop_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::angle_kp_v_per_rad, {"angle_kp", "angle_kp_v_per_rad", "K_ptheta", "V/rad", "proportional gain of a loop on the angle", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::angle_ki_v_per_rad_s, {"angle_ki", "angle_ki_v_per_rad_s", "K_itheta", "V/(rad s)", "integral gain of a loop on the angle", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::angle_kd_v_s_per_rad, {"angle_kd", "angle_kd_v_s_per_rad", "K_dtheta", "V s/rad", "derivative gain of a loop on the angle", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::torque_kp_v_per_n_m, {"torque_kp", "torque_kp_v_per_n_m", "K_pM", "V/(N m)", "proportional gain of a loop on the torque", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::torque_ki_v_per_n_m_s, {"torque_ki", "torque_ki_v_per_n_m_s", "K_iM", "V/(N m s)", "integral gain of a loop on the torque", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::torque_kd_v_s_per_n_m, {"torque_kd", "torque_kd_v_s_per_n_m", "K_dM", "V s/(N m)", "derivative gain of a loop on the torque", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::angular_velocity_feedforward_v_s_per_rad, {"angular_velocity_feedforward", "angular_velocity_feedforward_v_s_per_rad", "K_vf", "V s/rad", "feedforward gain on the rate of the angle's reference, filtered like the derivative", "docs/model.md", K::controller, -1e9, 1e9, 0.0}},
      F{&P::angular_acceleration_feedforward_v_s2_per_rad, {"angular_acceleration_feedforward", "angular_acceleration_feedforward_v_s2_per_rad", "K_af", "V s2/rad", "feedforward gain on the rate of that rate, filtered once more", "docs/model.md", K::controller, -1e9, 1e9, 0.0}},
      // clang-format on
  };
}

/// Returns the rows, those with the given keys as optional terms.
template <typename F, std::size_t N, std::size_t M>
constexpr auto with_terms(std::array<F, N> rows, const std::array<std::string_view, M>& keys) {
  for (F& row : rows) {
    if (std::find(keys.begin(), keys.end(), row.spec.key) == keys.end()) continue;
    row.spec.kind = ParameterKind::term;
    row.spec.default_value = 0.0;
  }
  return rows;
}

/// Rows of the linkage, in the order of `rigcal params`: its own rows, and those of oil, valve,
/// chambers, sensors and controller that do not concern a sliding load.
template <typename T>
constexpr auto linkage_fields() {
  using Keys = std::string_view;
  constexpr std::array kSlides{Keys("stroke")};
  constexpr std::array kAreas{Keys("area_a"), Keys("area_b")};
  constexpr std::array kOtherTerms{Keys("retracted_position"),  Keys("stop_stiffness"),
                                   Keys("stop_damping"),        Keys("gravity"),
                                   Keys("overlap_supply_to_a"), Keys("overlap_a_to_tank"),
                                   Keys("overlap_supply_to_b"), Keys("overlap_b_to_tank"),
                                   Keys("valve_null_opening"),  Keys("valve_line_opening"),
                                   Keys("hose_capacity_a"),     Keys("hose_capacity_b"),
                                   Keys("hose_yield"),          Keys("hose_yield_ratio")};
  constexpr std::array kOtherSensors{Keys("position_gain"),
                                     Keys("position_lag"),
                                     Keys("position_maximum"),
                                     Keys("position_offset"),
                                     Keys("force_gain"),
                                     Keys("force_lag"),
                                     Keys("force_maximum"),
                                     Keys("force_offset"),
                                     Keys("acceleration_gain"),
                                     Keys("acceleration_lag"),
                                     Keys("acceleration_maximum"),
                                     Keys("acceleration_offset"),
                                     Keys("payload_acceleration_gain"),
                                     Keys("payload_acceleration_lag"),
                                     Keys("payload_acceleration_maximum"),
                                     Keys("payload_acceleration_offset"),
                                     Keys("initial_position"),
                                     Keys("initial_velocity")};
  constexpr std::array kOtherLoads{Keys("external_force"),    Keys("load_gradient"),
                                   Keys("load_curvature"),    Keys("load_table_from"),
                                   Keys("load_table_to"),     Keys("load_0"),
                                   Keys("load_20"),           Keys("load_40"),
                                   Keys("load_60"),           Keys("load_80"),
                                   Keys("load_100"),          Keys("payload_mass"),
                                   Keys("payload_frequency"), Keys("payload_damping_ratio")};
  constexpr std::array kOtherLoops{Keys("kp"),
                                   Keys("ki"),
                                   Keys("kd"),
                                   Keys("force_kp"),
                                   Keys("force_ki"),
                                   Keys("force_kd"),
                                   Keys("acceleration_kp"),
                                   Keys("acceleration_ki"),
                                   Keys("acceleration_kd"),
                                   Keys("velocity_kp"),
                                   Keys("reference_frequency"),
                                   Keys("reference_damping_ratio"),
                                   Keys("velocity_feedforward"),
                                   Keys("acceleration_feedforward")};
  return joined(joint_rows<T>(),
                with_terms(rows_without(chamber_rows<LinkageParameters, T>(), kSlides), kAreas),
                rows_without(oil_rows<LinkageParameters, T>(), kElectricGain),
                electric_gain_rows<LinkageParameters, T>(), valve_rows<LinkageParameters, T>(),
                rows_without(load_rows<LinkageParameters, T>(), kOtherLoads),
                rows_without(chamber_term_rows<LinkageParameters, T>(), kOtherTerms),
                supply_rows<LinkageParameters, T>(), linkage_term_rows<T>(), travel_rows<T>(),
                metering_rows<LinkageParameters, T>(), angle_rows<T>(),
                rows_without(sensor_rows<LinkageParameters, T>(), kOtherSensors),
                chamber_initial_rows<LinkageParameters, T>(), joint_loop_rows<T>(),
                rows_without(controller_rows<LinkageParameters, T>(), kOtherLoops));
}

template <typename T>
inline constexpr auto kLinkageFields = linkage_fields<T>();

static_assert((joint_rows<double>().size() + linkage_term_rows<double>().size() +
               travel_rows<double>().size() + angle_rows<double>().size() +
               joint_loop_rows<double>().size()) *
                      sizeof(double) ==
                  sizeof(LinkageParameters<double>) - sizeof(TwoChamberParameters<double>),
              "a parameter was added to the struct but not to the table");

}  // namespace rigcal::model
