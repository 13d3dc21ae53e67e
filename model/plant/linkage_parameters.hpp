#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "model/plant/two_chamber_parameters.hpp"

namespace rigcal::model {

/// A cylinder that turns an arm. It has the oil, valve and chambers of TwoChamberParameters; the
/// members of a load that slides have no row in its table.
template <typename T>
struct LinkageParameters : TwoChamberParameters<T> {
  T inertia_kg_m2{};
  T joint_damping_n_m_s_per_rad{};
  T lever_m_per_rad{};
  T lower_stop_rad{};
  T upper_stop_rad{};
  T reference_angle_rad{};
  T lever_gradient_m_per_rad2{};
  T lever_curvature_m_per_rad3{};
  T gravity_moment_n_m{};
  T gravity_moment_gradient_n_m_per_rad{};
  T gravity_moment_curvature_n_m_per_rad2{};
  T joint_friction_n_m{};
  T joint_friction_smoothing_rad_per_s{};
  T angle_stop_stiffness_n_m_per_rad{};
  T angle_stop_damping_s_per_rad{};
  T pilot_gain_m_per_pa{};
  T pilot_dead_band_pa{};
  T pilot_range_pa{};
  T pilot_exponent{};
  T return_dead_band_pa{};
  T return_exponent{};
  T return_line_opening_m{};
  T return_line_resistance_pa_s_per_m3{};
  T bypass_opening_m{};
  T bypass_range_pa{};
  T pump_flow_m3_per_s{};
  T pump_second_flow_m3_per_s{};
  T pump_first_rate_m3_per_s2{};
  T pump_delay_s{};
  T pump_rise_s{};
  T make_up_conductance_m3_per_s_pa{};
  T angle_gain{};
  T angle_lag_s{};
  T angle_maximum_rad{};
  T angle_offset_rad{};
  T initial_angle_rad{};
  T initial_angular_velocity_rad_per_s{};
};

/// Rows but those with certain keys.
template <typename F, std::size_t N, std::size_t M>
constexpr auto rows_without(const std::array<F, N>& rows,
                            const std::array<std::string_view, M>& keys) {
  std::array<F, N - M> kept{};
  std::size_t next = 0;
  for (const F& row : rows) {
    if (std::find(keys.begin(), keys.end(), row.spec.key) != keys.end()) continue;
    if (next == kept.size()) throw std::logic_error("a key without a row");
    kept[next++] = row;
  }
  return kept;
}

/// The joint: what replaces mass, stroke and position of a load that slides.
template <typename T>
constexpr auto joint_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::inertia_kg_m2, {"inertia", "inertia_kg_m2", "J", "kg m2", "moment of inertia about the joint", "docs/model.md", K::plant, 1e-6, 1e9}},
      F{&P::joint_damping_n_m_s_per_rad, {"joint_damping", "joint_damping_n_m_s_per_rad", "c", "N m s/rad", "viscous friction of joint and cylinder", "docs/model.md", K::plant, 0, 1e12}},
      F{&P::lever_m_per_rad, {"lever", "lever_m_per_rad", "D_0", "m/rad", "travel of the piston per angle, at the reference angle: the lever of its force", "docs/model.md", K::plant, 1e-4, 100}},
      F{&P::lower_stop_rad, {"lower_stop", "lower_stop_rad", "theta_1", "rad", "angle of the stop or support at which the piston is retracted", "docs/model.md", K::plant, -1000, 1000}},
      F{&P::upper_stop_rad, {"upper_stop", "upper_stop_rad", "theta_2", "rad", "angle of the stop at which the piston is extended", "docs/model.md", K::plant, -1000, 1000}},
      // clang-format on
  };
}

/// The gain of an electric valve, which a pilot-operated one lacks.
template <typename T>
constexpr auto electric_gain_rows() {
  using P = LinkageParameters<T>;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::valve_gain_m_per_v, {"valve_gain", "valve_gain_m_per_v", "k_sv", "m/V", "spool travel per volt of an electric valve", "eq. 6", ParameterKind::term, 1e-12, 1, 0.0}},
      // clang-format on
  };
}

/// Optional terms of lever, load, pilot, pump and make-up valve.
template <typename T>
constexpr auto linkage_term_rows() {
  using P = LinkageParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::reference_angle_rad, {"reference_angle", "reference_angle_rad", "theta_0", "rad", "angle from which lever and gravity moment count their change", "docs/model.md", K::term, -1000, 1000, 0.0, false}},
      F{&P::lever_gradient_m_per_rad2, {"lever_gradient", "lever_gradient_m_per_rad2", "D_1", "m/rad2", "what the lever grows by per angle", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::lever_curvature_m_per_rad3, {"lever_curvature", "lever_curvature_m_per_rad3", "D_2", "m/rad3", "what the lever grows by per square of the angle", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::gravity_moment_n_m, {"gravity_moment", "gravity_moment_n_m", "M_0", "N m", "moment of the load against positive angle, at the reference angle", "docs/model.md", K::term, -1e9, 1e9, 0.0}},
      F{&P::gravity_moment_gradient_n_m_per_rad, {"gravity_moment_gradient", "gravity_moment_gradient_n_m_per_rad", "M_1", "N m/rad", "what this moment grows by per angle; negative where it falls", "docs/model.md", K::term, -1e9, 1e9, 0.0}},
      F{&P::gravity_moment_curvature_n_m_per_rad2, {"gravity_moment_curvature", "gravity_moment_curvature_n_m_per_rad2", "M_2", "N m/rad2", "what this moment grows by per square of the angle", "docs/model.md", K::term, -1e9, 1e9, 0.0}},
      F{&P::joint_friction_n_m, {"joint_friction", "joint_friction_n_m", "M_c", "N m", "dry friction of joint and cylinder", "docs/model.md", K::term, 0, 1e9, 0.0}},
      F{&P::joint_friction_smoothing_rad_per_s, {"joint_friction_smoothing", "joint_friction_smoothing_rad_per_s", "omega_0", "rad/s", "angular velocity below which this friction is straightened", "docs/model.md", K::term, 1e-6, 10, 1e-3, false}},
      F{&P::angle_stop_stiffness_n_m_per_rad, {"stop_stiffness", "stop_stiffness_n_m_per_rad", "k_s", "N m/rad", "stiffness of stops and support", "docs/model.md", K::term, 1e3, 1e13, 1e8}},
      F{&P::angle_stop_damping_s_per_rad, {"stop_damping", "stop_damping_s_per_rad", "lambda_s", "s/rad", "damping of the stops over their stiffness", "docs/model.md", K::term, 0, 1e6, 10.0}},
      F{&P::pilot_gain_m_per_pa, {"pilot_gain", "pilot_gain_m_per_pa", "k_p", "m/Pa", "spool travel per pilot pressure beyond the dead band; the drive is the channel pilot_pressure", "docs/model.md", K::term, 1e-15, 1e-3, 0.0}},
      F{&P::pilot_dead_band_pa, {"pilot_dead_band", "pilot_dead_band_pa", "p_db", "Pa", "pilot pressure at which the spool begins to open: preload of its spring, and overlap", "docs/model.md", K::term, 0, 1e8, 0.0}},
      F{&P::pilot_range_pa, {"pilot_range", "pilot_range_pa", "p_r", "Pa", "pressure beyond the dead band at which the power law passes what pilot_gain says", "docs/model.md", K::term, 1e3, 1e8, 1e6, false}},
      F{&P::pilot_exponent, {"pilot_exponent", "pilot_exponent", "n_p", "1", "power of the opening beyond the dead band, as of notches in the spool", "docs/model.md", K::term, 1, 6, 1.0}},
      F{&P::return_dead_band_pa, {"return_dead_band", "return_dead_band_pa", "p_dt", "Pa", "pilot pressure at which the edges to the tank begin to open; that of the others unless given", "docs/model.md", K::term, 0, 1e8, 0.0}},
      F{&P::return_exponent, {"return_exponent", "return_exponent", "n_t", "1", "power of the opening of the edges to the tank; that of the others unless given", "docs/model.md", K::term, 1, 6, 1.0}},
      F{&P::return_line_opening_m, {"return_line_opening", "return_line_opening_m", "l_t", "m", "spool travel at which an edge to the tank and the line after it lose alike", "docs/model.md", K::term, 1e-7, 10, 0.0}},
      F{&P::return_line_resistance_pa_s_per_m3, {"return_line_resistance", "return_line_resistance_pa_s_per_m3", "R_t", "Pa s/m3", "laminar loss of the line to the tank, as of filter and cooler", "docs/model.md", K::term, 0, 1e13, 0.0}},
      F{&P::bypass_opening_m, {"bypass_opening", "bypass_opening_m", "l_0", "m", "spool travel that opens an edge as far as the closed valve opens the way from pump to tank (open centre)", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::bypass_range_pa, {"bypass_range", "bypass_range_pa", "p_0", "Pa", "pilot pressure beyond the dead band at which this way is closed", "docs/model.md", K::term, 1e3, 1e8, 1e6, false}},
      F{&P::pump_flow_m3_per_s, {"pump_flow", "pump_flow_m3_per_s", "Q_1", "m3/s", "largest flow of the pump, whose pressure supply_pressure limits", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::pump_second_flow_m3_per_s, {"pump_second_flow", "pump_second_flow_m3_per_s", "Q_2", "m3/s", "largest flow of the pump after the valve has been open for pump_delay", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::pump_first_rate_m3_per_s2, {"pump_first_rate", "pump_first_rate_m3_per_s2", "Q_1'", "m3/s2", "what the first flow grows by per time of demand", "docs/model.md", K::term, 0, 10, 0.0}},
      F{&P::pump_delay_s, {"pump_delay", "pump_delay_s", "T_2", "s", "time from the opening of the valve to the middle between both flows", "docs/model.md", K::term, 1e-3, 100, 0.0}},
      F{&P::pump_rise_s, {"pump_rise", "pump_rise_s", "tau_2", "s", "half of the time that this change takes", "docs/model.md", K::term, 1e-3, 100, 0.1}},
      F{&P::make_up_conductance_m3_per_s_pa, {"make_up_conductance", "make_up_conductance_m3_per_s_pa", "G_m", "m3/(s Pa)", "flow per pressure of the check valve through which the tank fills each chamber", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::angle_gain, {"angle_gain", "angle_gain", "s_theta", "1", "recorded angle per angle", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::angle_lag_s, {"angle_lag", "angle_lag_s", "tau_theta", "s", "first-order lag of the angle sensor", "docs/model.md", K::sensor, 1e-6, 10, 0.0}},
      F{&P::angle_maximum_rad, {"angle_maximum", "angle_maximum_rad", "max_theta", "rad", "largest angle that its sensor and converter can show", "docs/model.md", K::sensor, -1000, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), false}},
      F{&P::angle_offset_rad, {"angle_offset", "angle_offset_rad", "theta_off", "rad", "recorded angle minus angle", "docs/model.md", K::sensor, -1000, 1000, 0.0}},
      F{&P::initial_angle_rad, {"initial_angle", "initial_angle_rad", "theta(0)", "rad", "recorded angle at the first sample", "docs/model.md", K::initial, -1000, 1000, 0.0}},
      F{&P::initial_angular_velocity_rad_per_s, {"initial_angular_velocity", "initial_angular_velocity_rad_per_s", "omega(0)", "rad/s", "angular velocity at the first sample", "docs/model.md", K::initial, -1000, 1000, 0.0}},
      // clang-format on
  };
}

/// The linkage, in the order of `rigcal params`: its own rows, and those of oil, valve, chambers
/// and sensors that do not speak of a load that slides.
template <typename T>
constexpr auto linkage_fields() {
  using Keys = std::string_view;
  constexpr std::array kSlides{Keys("stroke")};
  constexpr std::array kOwnGain{Keys("valve_gain")};
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
                                     Keys("initial_velocity"),
                                     Keys("initial_integral")};
  constexpr std::array kOtherLoads{Keys("coulomb_friction"),  Keys("stribeck_friction"),
                                   Keys("stribeck_velocity"), Keys("friction_smoothing"),
                                   Keys("external_force"),    Keys("load_gradient"),
                                   Keys("load_curvature"),    Keys("payload_mass"),
                                   Keys("payload_frequency"), Keys("payload_damping_ratio")};
  return joined(joint_rows<T>(), rows_without(chamber_rows<LinkageParameters, T>(), kSlides),
                rows_without(oil_rows<LinkageParameters, T>(), kOwnGain), electric_gain_rows<T>(),
                valve_rows<LinkageParameters, T>(),
                rows_without(load_rows<LinkageParameters, T>(), kOtherLoads),
                rows_without(chamber_term_rows<LinkageParameters, T>(), kOtherTerms),
                linkage_term_rows<T>(),
                rows_without(sensor_rows<LinkageParameters, T>(), kOtherSensors),
                chamber_initial_rows<LinkageParameters, T>());
}

template <typename T>
inline constexpr auto kLinkageFields = linkage_fields<T>();

static_assert((joint_rows<double>().size() + linkage_term_rows<double>().size()) * sizeof(double) ==
                  sizeof(LinkageParameters<double>) - sizeof(TwoChamberParameters<double>),
              "a parameter was added to the struct but not to the table");

}  // namespace rigcal::model
