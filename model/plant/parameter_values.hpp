#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "model/plant/parameter.hpp"

namespace rigcal::model {

/// One parameter of a plant: the member with its value and the row that describes it.
template <typename Parameters, typename T>
struct ParameterField {
  T Parameters::*member;
  ParameterSpec spec;
};

/// Parameters that all plants share: piston, valve, friction, leakage, supply, controller, sensors.
/// In SI units; each name ends in its unit.
///
/// @tparam T  double, or a dual number if derivatives are needed
template <typename T>
struct CommonParameters {
  T mass_kg{};
  T damping_n_s_per_m{};
  T stiffness_n_per_m{};
  T supply_pressure_pa{};
  T density_kg_per_m3{};
  T bulk_modulus_pa{};
  T reference_temperature_k{};
  T oil_temperature_k{};
  T viscosity_decay_per_k{};
  T thermal_expansion_per_k{};
  T bulk_modulus_decay_per_k{};
  T discharge_coefficient{};
  T area_gradient_m{};
  T valve_gain_m_per_v{};
  T leakage_coefficient{};
  T leakage_area_m2{};
  T leakage_smoothing_pa{};
  T valve_time_constant_s{};
  T valve_frequency_rad_per_s{};
  T valve_damping_ratio{};
  T valve_offset_v{};
  T valve_dead_band_v{};
  T main_spool_gain_per_s{};
  T valve_rate_limit_v_per_s{};
  T valve_null_leakage_m3_per_s_pa{};
  T coulomb_friction_n{};
  T stribeck_friction_n{};
  T stribeck_velocity_m_per_s{};
  T friction_smoothing_m_per_s{};
  T seal_friction_m2{};
  T bristle_stiffness_n_per_m{};
  T bristle_damping_n_s_per_m{};
  T film_velocity_m_per_s{};
  T film_growth_time_s{};
  T film_decay_time_s{};
  T film_dwell_time_s{};
  T external_force_n{};
  T load_gradient_n_per_m{};
  T load_curvature_n_per_m2{};
  T load_table_from_m{};
  T load_table_to_m{};
  T load_0_n{};
  T load_20_n{};
  T load_40_n{};
  T load_60_n{};
  T load_80_n{};
  T load_100_n{};
  T payload_mass_kg{};
  T payload_frequency_rad_per_s{};
  T payload_damping_ratio{};
  T laminar_leakage_m3_per_s_pa{};
  T leakage_resistance_pa_s_per_m3{};
  T supply_resistance_pa_s_per_m3{};
  T supply_capacity_m3_per_pa{};
  T pump_flow_m3_per_s{};
  T accumulator_volume_m3{};
  T accumulator_precharge_pa{};
  T accumulator_exponent{};
  T relief_pressure_pa{};
  T relief_conductance_m3_per_s_pa{};
  T transport_delay_s{};
  T position_gain{};
  T load_pressure_gain{};
  T pressure_a_gain{};
  T pressure_b_gain{};
  T force_gain{};
  T acceleration_gain{};
  T payload_acceleration_gain{};
  T position_lag_s{};
  T load_pressure_lag_s{};
  T pressure_a_lag_s{};
  T pressure_b_lag_s{};
  T force_lag_s{};
  T acceleration_lag_s{};
  T payload_acceleration_lag_s{};
  T position_maximum_m{};
  T load_pressure_maximum_pa{};
  T pressure_a_maximum_pa{};
  T pressure_b_maximum_pa{};
  T force_maximum_n{};
  T acceleration_maximum_m_per_s2{};
  T payload_acceleration_maximum_m_per_s2{};
  T position_offset_m{};
  T load_pressure_offset_pa{};
  T pressure_a_offset_pa{};
  T pressure_b_offset_pa{};
  T force_offset_n{};
  T acceleration_offset_m_per_s2{};
  T payload_acceleration_offset_m_per_s2{};
  T initial_position_m{};
  T initial_velocity_m_per_s{};
  T initial_integral_v{};
  T kp_v_per_m{};
  T ki_v_per_m_s{};
  T kd_v_s_per_m{};
  T force_kp_v_per_n{};
  T force_ki_v_per_n_s{};
  T force_kd_v_s_per_n{};
  T load_pressure_kp_v_per_pa{};
  T load_pressure_ki_v_per_pa_s{};
  T load_pressure_kd_v_s_per_pa{};
  T acceleration_kp_v_s2_per_m{};
  T acceleration_ki_v_s_per_m{};
  T acceleration_kd_v_s3_per_m{};
  T velocity_kp_v_s_per_m{};
  T reference_frequency_rad_per_s{};
  T reference_damping_ratio{};
  T pressure_feedback_v_per_pa{};
  T velocity_feedforward_v_s_per_m{};
  T acceleration_feedforward_v_s2_per_m{};
  T derivative_filter_rad_per_s{};
  T output_limit_v{};
  T sample_time_s{};
};

/// The paper's plant: a symmetric cylinder described by its load pressure.
template <typename T>
struct LoadPressureParameters : CommonParameters<T> {
  T piston_area_m2{};
  T total_volume_m3{};
  T initial_load_pressure_pa{};
};

/// Concatenates arrays of rows.
template <typename F, std::size_t... N>
constexpr auto joined(const std::array<F, N>&... rows) {
  std::array<F, (N + ...)> all{};
  std::size_t next = 0;
  const auto append = [&](const auto& part) {
    for (const F& row : part) all[next++] = row;
  };
  (append(rows), ...);
  return all;
}

// Rows that all plants share. To add a parameter, add a member above and a row here; the campaign
// file, the results, the fit and the documents follow.

/// Mass, damper and spring.
template <template <typename> class Parameters, typename T>
constexpr auto motion_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::mass_kg, {"mass", "mass_kg", "m", "kg", "mass of piston, rods and load", "eq. 12", K::plant, 1e-3, 1e6}},
      F{&P::damping_n_s_per_m, {"damping", "damping_n_s_per_m", "b", "N s/m", "viscous friction", "eq. 12", K::plant, 0, 1e9}},
      F{&P::stiffness_n_per_m, {"stiffness", "stiffness_n_per_m", "k", "N/m", "spring rate of the load", "eq. 12", K::plant, 0, 1e12}},
      // clang-format on
  };
}

/// Oil, orifices of the valve, and the leak.
template <template <typename> class Parameters, typename T>
constexpr auto oil_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::supply_pressure_pa, {"supply_pressure", "supply_pressure_pa", "P_s", "Pa", "supply above tank", "eq. 4", K::plant, 1e3, 1e9}},
      F{&P::density_kg_per_m3, {"density", "density_kg_per_m3", "rho", "kg/m3", "density of the oil", "eqs. 4, 11", K::plant, 100, 5000}},
      F{&P::bulk_modulus_pa, {"bulk_modulus", "bulk_modulus_pa", "beta", "Pa", "effective bulk modulus", "eq. 13", K::plant, 1e5, 1e11}},
      F{&P::reference_temperature_k, {"reference_temperature", "reference_temperature_k", "T_0", "K", "temperature at which density, bulk modulus, damping and laminar paths have the given values", "docs/model.md", K::term, 200, 500, 0.0, false}},
      F{&P::oil_temperature_k, {"oil_temperature", "oil_temperature_k", "T", "K", "temperature of the oil where none was recorded", "docs/model.md", K::term, 200, 500, 0.0}},
      F{&P::viscosity_decay_per_k, {"viscosity_decay", "viscosity_decay_per_k", "lambda_T", "1/K", "relative decrease of the viscosity with temperature", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::thermal_expansion_per_k, {"thermal_expansion", "thermal_expansion_per_k", "alpha_T", "1/K", "thermal expansion coefficient of the oil", "docs/model.md", K::term, 0, 0.01, 0.0}},
      F{&P::bulk_modulus_decay_per_k, {"bulk_modulus_decay", "bulk_modulus_decay_per_k", "kappa_T", "1/K", "relative decrease of the bulk modulus with temperature", "docs/model.md", K::term, 0, 0.1, 0.0}},
      F{&P::discharge_coefficient, {"discharge_coefficient", "discharge_coefficient", "C_d", "1", "discharge coefficient of the valve", "eq. 4", K::plant, 1e-3, 10}},
      F{&P::area_gradient_m, {"area_gradient", "area_gradient_m", "w", "m", "orifice area per spool travel (m2/m)", "eq. 4", K::plant, 1e-7, 10}},
      F{&P::valve_gain_m_per_v, {"valve_gain", "valve_gain_m_per_v", "k_sv", "m/V", "spool travel per volt", "eq. 6", K::plant, 1e-12, 1}},
      F{&P::leakage_coefficient, {"leakage_coefficient", "leakage_coefficient", "C_leak", "1", "discharge coefficient of the internal leak; 0: no leak", "eq. 11", K::plant, 0, 1e3}},
      F{&P::leakage_area_m2, {"leakage_area", "leakage_area_m2", "w_leak", "m2", "orifice area of the internal leak", "eq. 11", K::plant, 0, 1}},
      F{&P::leakage_smoothing_pa, {"leakage_smoothing", "leakage_smoothing_pa", "eps", "Pa", "pressure below which the square root of the orifice law is smoothed", "docs/model.md", K::plant, 1e-3, 1e6, 100.0, false}},
      // clang-format on
  };
}

/// Dynamics and null of the valve.
template <template <typename> class Parameters, typename T>
constexpr auto valve_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::valve_time_constant_s, {"valve_time_constant", "valve_time_constant_s", "tau_v", "s", "first-order lag of the valve", "docs/model.md", K::term, 0, 10, 0.0}},
      F{&P::valve_frequency_rad_per_s, {"valve_frequency", "valve_frequency_rad_per_s", "omega_v", "rad/s", "natural frequency of a second-order valve", "docs/model.md", K::term, 1, 1e6, 0.0}},
      F{&P::valve_damping_ratio, {"valve_damping_ratio", "valve_damping_ratio", "zeta_v", "1", "damping ratio of a second-order valve", "docs/model.md", K::term, 0.01, 100, 0.0}},
      F{&P::valve_offset_v, {"valve_offset", "valve_offset_v", "u_0", "V", "voltage added at the spool: null shift", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::valve_dead_band_v, {"valve_dead_band", "valve_dead_band_v", "u_db", "V", "half width of the spool overlap, in volts", "docs/model.md", K::term, 0, 100, 0.0}},
      F{&P::main_spool_gain_per_s, {"main_spool_gain", "main_spool_gain_per_s", "K_ms", "1/s", "rate of the main spool of a two-stage valve per volt of its position error; the lag of the valve is then that of the pilot stage", "docs/model.md", K::term, 0.1, 1e6, 0.0}},
      F{&P::valve_rate_limit_v_per_s, {"valve_rate_limit", "valve_rate_limit_v_per_s", "r_v", "V/s", "rate limit of the spool signal, in both directions", "docs/model.md", K::term, 1e-3, 1e9, 0.0}},
      F{&P::valve_null_leakage_m3_per_s_pa, {"valve_null_leakage", "valve_null_leakage_m3_per_s_pa", "G_0", "m3/(s Pa)", "laminar leak of each closed metering edge: servo flow lost per unit of load pressure", "docs/model.md", K::term, 0, 1, 0.0}},
      // clang-format on
  };
}

/// Dry friction, a constant load, and the laminar leak.
template <template <typename> class Parameters, typename T>
constexpr auto load_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::coulomb_friction_n, {"coulomb_friction", "coulomb_friction_n", "F_c", "N", "dry friction of piston and rod", "docs/model.md", K::term, 0, 1e8, 0.0}},
      F{&P::stribeck_friction_n, {"stribeck_friction", "stribeck_friction_n", "F_st", "N", "breakaway friction in excess of Coulomb friction", "docs/model.md", K::term, 0, 1e8, 0.0}},
      F{&P::stribeck_velocity_m_per_s, {"stribeck_velocity", "stribeck_velocity_m_per_s", "v_st", "m/s", "velocity at which the excess of breakaway friction has decayed to 1/e", "docs/model.md", K::term, 1e-6, 100, 0.01}},
      F{&P::friction_smoothing_m_per_s, {"friction_smoothing", "friction_smoothing_m_per_s", "v_0", "m/s", "velocity below which dry friction is smoothed", "docs/model.md", K::term, 1e-6, 10, 1e-3, false}},
      F{&P::seal_friction_m2, {"seal_friction", "seal_friction_m2", "mu_p", "m2", "increase of dry friction per unit of pressure across the piston (N/Pa)", "docs/model.md", K::term, 0, 10, 0.0}},
      F{&P::bristle_stiffness_n_per_m, {"bristle_stiffness", "bristle_stiffness_n_per_m", "sigma_0", "N/m", "stiffness of seals and contacts before they slide: dry friction with pre-sliding", "docs/model.md", K::term, 1e2, 1e12, 0.0}},
      F{&P::bristle_damping_n_s_per_m, {"bristle_damping", "bristle_damping_n_s_per_m", "sigma_1", "N s/m", "damping of the pre-sliding motion", "docs/model.md", K::term, 0, 1e9, 0.0}},
      F{&P::film_velocity_m_per_s, {"film_velocity", "film_velocity_m_per_s", "v_b", "m/s", "velocity above which the lubricant film of the seals reaches its full thickness; breakaway friction then follows the film", "docs/model.md", K::term, 1e-6, 100, 0.0}},
      F{&P::film_growth_time_s, {"film_growth_time", "film_growth_time_s", "tau_hp", "s", "time constant of the film while it builds up", "docs/model.md", K::term, 1e-6, 1e4, 0.0}},
      F{&P::film_decay_time_s, {"film_decay_time", "film_decay_time_s", "tau_hn", "s", "time constant of the film while it thins in motion", "docs/model.md", K::term, 1e-6, 1e4, 0.0}},
      F{&P::film_dwell_time_s, {"film_dwell_time", "film_dwell_time_s", "tau_h0", "s", "time constant of the film at rest (below friction_smoothing)", "docs/model.md", K::term, 1e-6, 1e6, 0.0}},
      F{&P::external_force_n, {"external_force", "external_force_n", "F_ext", "N", "constant load, opposing positive travel", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::load_gradient_n_per_m, {"load_gradient", "load_gradient_n_per_m", "k_F", "N/m", "increase of the load per unit of travel; negative if it decreases", "docs/model.md", K::term, -1e12, 1e12, 0.0}},
      F{&P::load_curvature_n_per_m2, {"load_curvature", "load_curvature_n_per_m2", "c_F", "N/m2", "increase of the load per unit of travel squared", "docs/model.md", K::term, -1e12, 1e12, 0.0}},
      F{&P::load_table_from_m, {"load_table_from", "load_table_from_m", "x_L0", "m", "position at which the table of the load begins", "docs/model.md", K::term, -100, 100, 0.0, false}},
      F{&P::load_table_to_m, {"load_table_to", "load_table_to_m", "x_L1", "m", "position at which the table of the load ends; the table replaces the polynomial", "docs/model.md", K::term, -100, 100, 0.0, false}},
      F{&P::load_0_n, {"load_0", "load_0_n", "L_0", "N", "load at the start of the table, opposing positive travel", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::load_20_n, {"load_20", "load_20_n", "L_20", "N", "load at 20 % of the range of the table", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::load_40_n, {"load_40", "load_40_n", "L_40", "N", "load at 40 % of the range of the table", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::load_60_n, {"load_60", "load_60_n", "L_60", "N", "load at 60 % of the range of the table", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::load_80_n, {"load_80", "load_80_n", "L_80", "N", "load at 80 % of the range of the table", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::load_100_n, {"load_100", "load_100_n", "L_100", "N", "load at the end of the table", "docs/model.md", K::term, -1e8, 1e8, 0.0}},
      F{&P::payload_mass_kg, {"payload_mass", "payload_mass_kg", "m_2", "kg", "second mass, behind a spring and a damper", "docs/model.md", K::term, 1e-3, 1e6, 0.0}},
      F{&P::payload_frequency_rad_per_s, {"payload_frequency", "payload_frequency_rad_per_s", "omega_2", "rad/s", "natural frequency of the second mass with the first one fixed", "docs/model.md", K::term, 1e-2, 1e6, 0.0}},
      F{&P::payload_damping_ratio, {"payload_damping_ratio", "payload_damping_ratio", "zeta_2", "1", "damping ratio of the second mass with the first one fixed", "docs/model.md", K::term, 0, 100, 0.0}},
      F{&P::laminar_leakage_m3_per_s_pa, {"laminar_leakage", "laminar_leakage_m3_per_s_pa", "G_leak", "m3/(s Pa)", "laminar internal leak", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::leakage_resistance_pa_s_per_m3, {"leakage_resistance", "leakage_resistance_pa_s_per_m3", "R_leak", "Pa s/m3", "laminar loss in series with the orifice of the internal leak: one law from laminar to turbulent", "docs/model.md", K::term, 0, 1e18, 0.0}},
      // clang-format on
  };
}

/// Supply whose pressure drops with its flow.
template <template <typename> class Parameters, typename T>
constexpr auto supply_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::supply_resistance_pa_s_per_m3, {"supply_resistance", "supply_resistance_pa_s_per_m3", "R_s", "Pa s/m3", "hydraulic resistance between the source and the valve", "docs/model.md", K::term, 1e-3, 1e15, 0.0}},
      F{&P::supply_capacity_m3_per_pa, {"supply_capacity", "supply_capacity_m3_per_pa", "C_s", "m3/Pa", "volume that hose and accumulator at the valve take up per unit of pressure", "docs/model.md", K::term, 1e-18, 1e-3, 0.0}},
      // clang-format on
  };
}

/// Largest flow of the pump.
template <template <typename> class Parameters, typename T>
constexpr auto pump_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::pump_flow_m3_per_s, {"pump_flow", "pump_flow_m3_per_s", "Q_1", "m3/s", "largest flow of the pump, which is limited to supply_pressure", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      // clang-format on
  };
}

/// Accumulator and relief valves.
template <template <typename> class Parameters, typename T>
constexpr auto relief_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::accumulator_volume_m3, {"accumulator_volume", "accumulator_volume_m3", "V_0", "m3", "gas volume of an accumulator at the valve, at its precharge", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::accumulator_precharge_pa, {"accumulator_precharge", "accumulator_precharge_pa", "p_g", "Pa", "precharge pressure of that gas, without oil in the accumulator", "docs/model.md", K::term, 1e3, 1e8, 0.0}},
      F{&P::accumulator_exponent, {"accumulator_exponent", "accumulator_exponent", "n_g", "1", "polytropic exponent of that gas", "docs/model.md", K::term, 1, 2, 1.4}},
      F{&P::relief_pressure_pa, {"relief_pressure", "relief_pressure_pa", "p_rv", "Pa", "pressure at which the relief valve of each chamber begins to open to the tank", "docs/model.md", K::term, 1e4, 1e9, 0.0}},
      F{&P::relief_conductance_m3_per_s_pa, {"relief_conductance", "relief_conductance_m3_per_s_pa", "G_r", "m3/(s Pa)", "conductance of that valve: flow per pressure above relief_pressure", "docs/model.md", K::term, 0, 1, 0.0}},
      // clang-format on
  };
}

/// Dead time, sensors and initial motion, which the solver needs for every plant.
template <template <typename> class Parameters, typename T>
constexpr auto sensor_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::transport_delay_s, {"transport_delay", "transport_delay_s", "T_d", "s", "dead time of the reference or command", "docs/model.md", K::term, 0, 10, 0.0}},
      F{&P::position_gain, {"position_gain", "position_gain", "s_x", "1", "gain of the sensor: recorded over true position", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::load_pressure_gain, {"load_pressure_gain", "load_pressure_gain", "s_PL", "1", "gain of the sensor: recorded over true load pressure", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::pressure_a_gain, {"pressure_a_gain", "pressure_a_gain", "s_pA", "1", "gain of the sensor: recorded over true pressure A", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::pressure_b_gain, {"pressure_b_gain", "pressure_b_gain", "s_pB", "1", "gain of the sensor: recorded over true pressure B", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::force_gain, {"force_gain", "force_gain", "s_F", "1", "gain of the sensor: recorded over true force", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::acceleration_gain, {"acceleration_gain", "acceleration_gain", "s_a", "1", "gain of the sensor: recorded over true acceleration", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::payload_acceleration_gain, {"payload_acceleration_gain", "payload_acceleration_gain", "s_a2", "1", "gain of the sensor: recorded over true acceleration of the payload", "docs/model.md", K::sensor, 0.1, 10, 1.0}},
      F{&P::position_lag_s, {"position_lag", "position_lag_s", "tau_x", "s", "first-order lag of the position sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::load_pressure_lag_s, {"load_pressure_lag", "load_pressure_lag_s", "tau_PL", "s", "first-order lag of the load pressure sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::pressure_a_lag_s, {"pressure_a_lag", "pressure_a_lag_s", "tau_pA", "s", "first-order lag of the pressure A sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::pressure_b_lag_s, {"pressure_b_lag", "pressure_b_lag_s", "tau_pB", "s", "first-order lag of the pressure B sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::force_lag_s, {"force_lag", "force_lag_s", "tau_F", "s", "first-order lag of the force sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::acceleration_lag_s, {"acceleration_lag", "acceleration_lag_s", "tau_a", "s", "first-order lag of the acceleration sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::payload_acceleration_lag_s, {"payload_acceleration_lag", "payload_acceleration_lag_s", "tau_a2", "s", "first-order lag of the payload's acceleration sensor", "docs/model.md", K::sensor, 0, 10, 0.0}},
      F{&P::position_maximum_m, {"position_maximum", "position_maximum_m", "max_x", "m", "largest position that the sensor and its converter can indicate", "docs/model.md", K::sensor, -100, kInf, kInf, false}},
      F{&P::load_pressure_maximum_pa, {"load_pressure_maximum", "load_pressure_maximum_pa", "max_PL", "Pa", "largest load pressure that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e9, kInf, kInf, false}},
      F{&P::pressure_a_maximum_pa, {"pressure_a_maximum", "pressure_a_maximum_pa", "max_pA", "Pa", "largest pressure A that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e9, kInf, kInf, false}},
      F{&P::pressure_b_maximum_pa, {"pressure_b_maximum", "pressure_b_maximum_pa", "max_pB", "Pa", "largest pressure B that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e9, kInf, kInf, false}},
      F{&P::force_maximum_n, {"force_maximum", "force_maximum_n", "max_F", "N", "largest force that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e8, kInf, kInf, false}},
      F{&P::acceleration_maximum_m_per_s2, {"acceleration_maximum", "acceleration_maximum_m_per_s2", "max_a", "m/s2", "largest acceleration that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e6, kInf, kInf, false}},
      F{&P::payload_acceleration_maximum_m_per_s2, {"payload_acceleration_maximum", "payload_acceleration_maximum_m_per_s2", "max_a2", "m/s2", "largest acceleration of the payload that the sensor and its converter can indicate", "docs/model.md", K::sensor, -1e6, kInf, kInf, false}},
      F{&P::position_offset_m, {"position_offset", "position_offset_m", "x_0", "m", "offset of the sensor: recorded minus true position", "docs/model.md", K::sensor, -100, 100, 0.0}},
      F{&P::load_pressure_offset_pa, {"load_pressure_offset", "load_pressure_offset_pa", "P_L0", "Pa", "offset of the sensor: recorded minus true load pressure", "docs/model.md", K::sensor, -1e9, 1e9, 0.0}},
      F{&P::pressure_a_offset_pa, {"pressure_a_offset", "pressure_a_offset_pa", "p_A0", "Pa", "offset of the sensor: recorded minus true pressure A", "docs/model.md", K::sensor, -1e9, 1e9, 0.0}},
      F{&P::pressure_b_offset_pa, {"pressure_b_offset", "pressure_b_offset_pa", "p_B0", "Pa", "offset of the sensor: recorded minus true pressure B", "docs/model.md", K::sensor, -1e9, 1e9, 0.0}},
      F{&P::force_offset_n, {"force_offset", "force_offset_n", "F_0", "N", "offset of the sensor: recorded minus true force", "docs/model.md", K::sensor, -1e8, 1e8, 0.0}},
      F{&P::acceleration_offset_m_per_s2, {"acceleration_offset", "acceleration_offset_m_per_s2", "a_0", "m/s2", "offset of the sensor: recorded minus true acceleration", "docs/model.md", K::sensor, -1e6, 1e6, 0.0}},
      F{&P::payload_acceleration_offset_m_per_s2, {"payload_acceleration_offset", "payload_acceleration_offset_m_per_s2", "a_20", "m/s2", "offset of the sensor: recorded minus true acceleration of the payload", "docs/model.md", K::sensor, -1e6, 1e6, 0.0}},
      F{&P::initial_position_m, {"initial_position", "initial_position_m", "x(0)", "m", "recorded position at the first sample", "docs/model.md", K::initial, -100, 100, 0.0}},
      F{&P::initial_velocity_m_per_s, {"initial_velocity", "initial_velocity_m_per_s", "v(0)", "m/s", "velocity at the first sample", "docs/model.md", K::initial, -100, 100, 0.0}},
      F{&P::initial_integral_v, {"initial_integral", "initial_integral_v", "I(0)", "V", "integral action at the first sample", "docs/model.md", K::initial, -1e6, 1e6, 0.0}},
      // clang-format on
  };
}

/// Parameters that all hydraulic plants share, except those for their motion.
template <template <typename> class Parameters, typename T>
constexpr auto shared_rows() {
  return joined(oil_rows<Parameters, T>(), valve_rows<Parameters, T>(), load_rows<Parameters, T>(),
                sensor_rows<Parameters, T>());
}

/// Limits and gains of the controller.
template <template <typename> class Parameters, typename T>
constexpr auto controller_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::kp_v_per_m, {"kp", "kp_v_per_m", "K_p", "V/m", "proportional gain", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::ki_v_per_m_s, {"ki", "ki_v_per_m_s", "K_i", "V/(m s)", "integral gain", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::kd_v_s_per_m, {"kd", "kd_v_s_per_m", "K_d", "V s/m", "derivative gain", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::force_kp_v_per_n, {"force_kp", "force_kp_v_per_n", "K_pF", "V/N", "proportional gain of a loop on force", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::force_ki_v_per_n_s, {"force_ki", "force_ki_v_per_n_s", "K_iF", "V/(N s)", "integral gain of a loop on force", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::force_kd_v_s_per_n, {"force_kd", "force_kd_v_s_per_n", "K_dF", "V s/N", "derivative gain of a loop on force", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::load_pressure_kp_v_per_pa, {"load_pressure_kp", "load_pressure_kp_v_per_pa", "K_pP", "V/Pa", "proportional gain of a loop on load pressure", "docs/model.md", K::controller, 0, 1e6, 0.0}},
      F{&P::load_pressure_ki_v_per_pa_s, {"load_pressure_ki", "load_pressure_ki_v_per_pa_s", "K_iP", "V/(Pa s)", "integral gain of a loop on load pressure", "docs/model.md", K::controller, 0, 1e6, 0.0}},
      F{&P::load_pressure_kd_v_s_per_pa, {"load_pressure_kd", "load_pressure_kd_v_s_per_pa", "K_dP", "V s/Pa", "derivative gain of a loop on load pressure", "docs/model.md", K::controller, 0, 1e6, 0.0}},
      F{&P::acceleration_kp_v_s2_per_m, {"acceleration_kp", "acceleration_kp_v_s2_per_m", "K_pa", "V s2/m", "proportional gain of a loop on acceleration", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::acceleration_ki_v_s_per_m, {"acceleration_ki", "acceleration_ki_v_s_per_m", "K_ia", "V s/m", "integral gain of a loop on acceleration", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::acceleration_kd_v_s3_per_m, {"acceleration_kd", "acceleration_kd_v_s3_per_m", "K_da", "V s3/m", "derivative gain of a loop on acceleration", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::velocity_kp_v_s_per_m, {"velocity_kp", "velocity_kp_v_s_per_m", "K_v", "V s/m", "gain on the velocity error in three-variable control", "docs/model.md", K::controller, 0, 1e9, 0.0}},
      F{&P::reference_frequency_rad_per_s, {"reference_frequency", "reference_frequency_rad_per_s", "omega_r", "rad/s", "corner of the reference generator of three-variable control", "docs/model.md", K::controller, 1e-3, 1e6, 0.0}},
      F{&P::reference_damping_ratio, {"reference_damping_ratio", "reference_damping_ratio", "zeta_r", "1", "damping ratio of that generator", "docs/model.md", K::controller, 0.01, 100, 0.0}},
      F{&P::pressure_feedback_v_per_pa, {"pressure_feedback", "pressure_feedback_v_per_pa", "K_dp", "V/Pa", "gain of the inner feedback of the load pressure", "docs/model.md", K::controller, 0, 1e6, 0.0}},
      F{&P::velocity_feedforward_v_s_per_m, {"velocity_feedforward", "velocity_feedforward_v_s_per_m", "K_vf", "V s/m", "feedforward gain on the rate of the reference, filtered like the derivative or by the generator", "docs/model.md", K::controller, -1e9, 1e9, 0.0}},
      F{&P::acceleration_feedforward_v_s2_per_m, {"acceleration_feedforward", "acceleration_feedforward_v_s2_per_m", "K_af", "V s2/m", "feedforward gain on the rate of that rate, filtered once more", "docs/model.md", K::controller, -1e9, 1e9, 0.0}},
      F{&P::derivative_filter_rad_per_s, {"derivative_filter", "derivative_filter_rad_per_s", "N", "rad/s", "corner of the derivative's filter", "docs/model.md", K::controller, 1e-3, 1e6, 0.0}},
      F{&P::output_limit_v, {"output_limit", "output_limit_v", "u_max", "V", "limit of the controller's output, in both directions", "docs/model.md", K::controller, 1e-6, kInf, kInf}},
      F{&P::sample_time_s, {"sample_time", "sample_time_s", "T_s", "s", "period of a sampled controller; continuous if not given", "docs/model.md", K::controller, 1e-6, 100, 0.0, false}},
      // clang-format on
  };
}

/// Rows of the load-pressure plant, in the order of `rigcal params`.
template <typename T>
constexpr auto load_pressure_fields() {
  using P = LoadPressureParameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  const auto cylinder = std::array{
      // clang-format off
      F{&P::piston_area_m2, {"piston_area", "piston_area_m2", "A", "m2", "annulus area of the piston", "eqs. 12, 13", K::plant, 1e-8, 10}},
      F{&P::total_volume_m3, {"total_volume", "total_volume_m3", "V_t", "m3", "volume of oil in both chambers and hoses", "eq. 13", K::plant, 1e-9, 10}},
      // clang-format on
  };
  const auto initial = std::array{
      // clang-format off
      F{&P::initial_load_pressure_pa, {"initial_load_pressure", "initial_load_pressure_pa", "P_L(0)", "Pa", "load pressure at the first sample", "docs/model.md", K::initial, -1e9, 1e9, 0.0}},
      // clang-format on
  };
  return joined(motion_rows<LoadPressureParameters, T>(), cylinder,
                shared_rows<LoadPressureParameters, T>(), supply_rows<LoadPressureParameters, T>(),
                pump_rows<LoadPressureParameters, T>(), relief_rows<LoadPressureParameters, T>(),
                initial, controller_rows<LoadPressureParameters, T>());
}

template <typename T>
inline constexpr auto kLoadPressureFields = load_pressure_fields<T>();

static_assert(kLoadPressureFields<double>.size() * sizeof(double) ==
                  sizeof(LoadPressureParameters<double>),
              "a parameter was added to the struct but not to the table");

}  // namespace rigcal::model
