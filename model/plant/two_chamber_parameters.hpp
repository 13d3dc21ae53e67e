#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string_view>

#include "model/plant/parameter_values.hpp"

namespace rigcal::model {

/// A single-rod or double-rod cylinder with two chambers.
template <typename T>
struct TwoChamberParameters : CommonParameters<T> {
  T area_a_m2{};
  T area_b_m2{};
  T stroke_m{};
  T dead_volume_a_m3{};
  T dead_volume_b_m3{};
  T tank_pressure_pa{};
  T retracted_position_m{};
  T stop_stiffness_n_per_m{};
  T stop_damping_s_per_m{};
  T gravity_m_per_s2{};
  T gain_supply_to_a{};
  T gain_a_to_tank{};
  T gain_supply_to_b{};
  T gain_b_to_tank{};
  T overlap_supply_to_a_v{};
  T overlap_a_to_tank_v{};
  T overlap_supply_to_b_v{};
  T overlap_b_to_tank_v{};
  T valve_null_opening_v{};
  T valve_line_opening_v{};
  T external_leakage_a_m3_per_s_pa{};
  T external_leakage_b_m3_per_s_pa{};
  T air_fraction{};
  T air_exponent{};
  T hose_capacity_a_m3_per_pa{};
  T hose_capacity_b_m3_per_pa{};
  T hose_yield_pa{};
  T hose_yield_ratio{};
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
  T pump_second_flow_m3_per_s{};
  T pump_first_rate_m3_per_s2{};
  T pump_delay_s{};
  T pump_rise_s{};
  T make_up_conductance_m3_per_s_pa{};
  T valve_range_v{};
  T valve_exponent{};
  T opening_20{};
  T opening_40{};
  T opening_60{};
  T opening_80{};
  T compensator_pressure_pa{};
  T valve_bypass_range_v{};
  T load_sensing_margin_pa{};
  T initial_pressure_a_pa{};
  T initial_pressure_b_pa{};
};

/// Areas, travel and oil volumes of both chambers.
template <template <typename> class Parameters, typename T>
constexpr auto chamber_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::area_a_m2, {"area_a", "area_a_m2", "A_A", "m2", "piston area of chamber A, whose pressure extends the rod", "docs/model.md", K::plant, 1e-8, 10}},
      F{&P::area_b_m2, {"area_b", "area_b_m2", "A_B", "m2", "piston area of chamber B: the annulus of a single-rod cylinder", "docs/model.md", K::plant, 1e-8, 10}},
      F{&P::stroke_m, {"stroke", "stroke_m", "H", "m", "travel from stop to stop", "docs/model.md", K::plant, 1e-4, 100}},
      F{&P::dead_volume_a_m3, {"dead_volume_a", "dead_volume_a_m3", "V_A0", "m3", "oil of chamber A and its hose at the retracted stop", "docs/model.md", K::plant, 0, 10}},
      F{&P::dead_volume_b_m3, {"dead_volume_b", "dead_volume_b_m3", "V_B0", "m3", "oil of chamber B and its hose at the extended stop", "docs/model.md", K::plant, 0, 10}},
      F{&P::tank_pressure_pa, {"tank_pressure", "tank_pressure_pa", "P_t", "Pa", "pressure at the valve's tank port", "docs/model.md", K::plant, -1e5, 1e8}},
      // clang-format on
  };
}

/// Optional terms for stops, edges, chambers and hoses.
template <template <typename> class Parameters, typename T>
constexpr auto chamber_term_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::retracted_position_m, {"retracted_position", "retracted_position_m", "x_R", "m", "position of the piston at its retracted stop; half a stroke below 0 unless given", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::stop_stiffness_n_per_m, {"stop_stiffness", "stop_stiffness_n_per_m", "k_s", "N/m", "stiffness of the end stops", "docs/model.md", K::term, 1e3, 1e12, 1e8}},
      F{&P::stop_damping_s_per_m, {"stop_damping", "stop_damping_s_per_m", "lambda_s", "s/m", "damping of the end stops over their stiffness", "docs/model.md", K::term, 0, 1e6, 100.0}},
      F{&P::gravity_m_per_s2, {"gravity", "gravity_m_per_s2", "g", "m/s2", "gravity, opposing positive travel", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::gain_supply_to_a, {"gain_supply_to_a", "gain_supply_to_a", "g_PA", "1", "area of the metering edge from supply to A, relative to the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::gain_a_to_tank, {"gain_a_to_tank", "gain_a_to_tank", "g_AT", "1", "area of the metering edge from A to tank, relative to the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::gain_supply_to_b, {"gain_supply_to_b", "gain_supply_to_b", "g_PB", "1", "area of the metering edge from supply to B, relative to the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::gain_b_to_tank, {"gain_b_to_tank", "gain_b_to_tank", "g_BT", "1", "area of the metering edge from B to tank, relative to the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::overlap_supply_to_a_v, {"overlap_supply_to_a", "overlap_supply_to_a_v", "d_PA", "V", "overlap of the edge from supply to A beyond the dead band; negative: underlap", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::overlap_a_to_tank_v, {"overlap_a_to_tank", "overlap_a_to_tank_v", "d_AT", "V", "overlap of the edge from A to tank beyond the dead band", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::overlap_supply_to_b_v, {"overlap_supply_to_b", "overlap_supply_to_b_v", "d_PB", "V", "overlap of the edge from supply to B beyond the dead band", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::overlap_b_to_tank_v, {"overlap_b_to_tank", "overlap_b_to_tank_v", "d_BT", "V", "overlap of the edge from B to tank beyond the dead band", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::valve_null_opening_v, {"valve_null_opening", "valve_null_opening_v", "u_c", "V", "residual opening of an edge that its land just covers (orifice leak of the valve)", "docs/model.md", K::term, 1e-6, 100, 0.0}},
      F{&P::valve_line_opening_v, {"valve_line_opening", "valve_line_opening_v", "u_l", "V", "opening at which an edge loses as much pressure as the lines in series with it", "docs/model.md", K::term, 1e-3, 1e6, 0.0}},
      F{&P::external_leakage_a_m3_per_s_pa, {"external_leakage_a", "external_leakage_a_m3_per_s_pa", "G_A", "m3/(s Pa)", "laminar leak of chamber A to the tank", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::external_leakage_b_m3_per_s_pa, {"external_leakage_b", "external_leakage_b_m3_per_s_pa", "G_B", "m3/(s Pa)", "laminar leak of chamber B to the tank", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::air_fraction, {"air_fraction", "air_fraction", "alpha", "1", "volume fraction of undissolved air at atmospheric pressure", "docs/model.md", K::term, 0, 0.5, 0.0}},
      F{&P::air_exponent, {"air_exponent", "air_exponent", "n", "1", "polytropic exponent of that air", "docs/model.md", K::term, 1, 1.67, 1.4}},
      F{&P::hose_capacity_a_m3_per_pa, {"hose_capacity_a", "hose_capacity_a_m3_per_pa", "C_hA", "m3/Pa", "volume that the hose of chamber A takes up per unit of pressure once it yields", "docs/model.md", K::term, 0, 1e-6, 0.0}},
      F{&P::hose_capacity_b_m3_per_pa, {"hose_capacity_b", "hose_capacity_b_m3_per_pa", "C_hB", "m3/Pa", "volume that the hose of chamber B takes up per unit of pressure once it yields", "docs/model.md", K::term, 0, 1e-6, 0.0}},
      F{&P::hose_yield_pa, {"hose_yield", "hose_yield_pa", "p_h", "Pa", "change of pressure after a reversal over which the hoses begin to yield", "docs/model.md", K::term, 1e3, 1e9, 0.0}},
      F{&P::hose_yield_ratio, {"hose_yield_ratio", "hose_yield_ratio", "kappa_h", "1", "increase of hose_yield as a fraction of the absolute pressure", "docs/model.md", K::term, 1e-3, 100, 0.0}},
      // clang-format on
  };
}

/// The gain of an electric valve. A pilot-operated valve does not have it.
template <template <typename> class Parameters, typename T>
constexpr auto electric_gain_rows() {
  using P = Parameters<T>;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::valve_gain_m_per_v, {"valve_gain", "valve_gain_m_per_v", "k_sv", "m/V", "spool travel per volt of an electric valve", "eq. 6", ParameterKind::term, 1e-12, 1, 0.0}},
      // clang-format on
  };
}

/// Optional terms for a valve that is driven by a pilot pressure or meters in and out differently,
/// and for an open centre.
template <template <typename> class Parameters, typename T>
constexpr auto pilot_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::pilot_gain_m_per_pa, {"pilot_gain", "pilot_gain_m_per_pa", "k_p", "m/Pa", "spool travel per pilot pressure beyond the dead band; the drive is the channel pilot_pressure", "docs/model.md", K::term, 1e-15, 1e-3, 0.0}},
      F{&P::pilot_dead_band_pa, {"pilot_dead_band", "pilot_dead_band_pa", "p_db", "Pa", "pilot pressure at which the spool begins to open: preload of its spring, and overlap", "docs/model.md", K::term, 0, 1e8, 0.0}},
      F{&P::pilot_range_pa, {"pilot_range", "pilot_range_pa", "p_r", "Pa", "pressure beyond the dead band at which the power law agrees with pilot_gain", "docs/model.md", K::term, 1e3, 1e8, 1e6, false}},
      F{&P::pilot_exponent, {"pilot_exponent", "pilot_exponent", "n_p", "1", "exponent of the opening beyond the dead band, as with notches in the spool", "docs/model.md", K::term, 1, 6, 1.0}},
      F{&P::return_dead_band_pa, {"return_dead_band", "return_dead_band_pa", "p_dt", "Pa", "pilot pressure at which the edges to the tank begin to open; the same as for the others unless given", "docs/model.md", K::term, 0, 1e8, 0.0}},
      F{&P::return_exponent, {"return_exponent", "return_exponent", "n_t", "1", "exponent of the opening of the edges to the tank; the same as for the others unless given", "docs/model.md", K::term, 1, 6, 1.0}},
      F{&P::return_line_opening_m, {"return_line_opening", "return_line_opening_m", "l_t", "m", "spool travel at which an edge to the tank loses as much pressure as the line behind it", "docs/model.md", K::term, 1e-7, 10, 0.0}},
      F{&P::return_line_resistance_pa_s_per_m3, {"return_line_resistance", "return_line_resistance_pa_s_per_m3", "R_t", "Pa s/m3", "laminar resistance of the line to the tank, including filter and cooler", "docs/model.md", K::term, 0, 1e13, 0.0}},
      F{&P::bypass_opening_m, {"bypass_opening", "bypass_opening_m", "l_0", "m", "spool travel at which an edge is as wide open as the path from pump to tank in neutral (open centre)", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::bypass_range_pa, {"bypass_range", "bypass_range_pa", "p_0", "Pa", "pilot pressure beyond the dead band at which the path from pump to tank is closed", "docs/model.md", K::term, 1e3, 1e8, 1e6, false}},
      // clang-format on
  };
}

/// Optional terms for a pump of two stages, the shape of an electric valve, and load sensing.
template <template <typename> class Parameters, typename T>
constexpr auto opening_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::pump_second_flow_m3_per_s, {"pump_second_flow", "pump_second_flow_m3_per_s", "Q_2", "m3/s", "largest flow of the pump after the valve has been open for pump_delay", "docs/model.md", K::term, 1e-9, 10, 0.0}},
      F{&P::pump_first_rate_m3_per_s2, {"pump_first_rate", "pump_first_rate_m3_per_s2", "Q_1'", "m3/s2", "increase of the first flow per time of demand", "docs/model.md", K::term, 0, 10, 0.0}},
      F{&P::pump_delay_s, {"pump_delay", "pump_delay_s", "T_2", "s", "time from the opening of the valve until the flow is halfway between both", "docs/model.md", K::term, 1e-3, 100, 0.0}},
      F{&P::pump_rise_s, {"pump_rise", "pump_rise_s", "tau_2", "s", "half the duration of this change", "docs/model.md", K::term, 1e-3, 100, 0.1}},
      F{&P::make_up_conductance_m3_per_s_pa, {"make_up_conductance", "make_up_conductance_m3_per_s_pa", "G_m", "m3/(s Pa)", "conductance of the anti-cavitation check valve from the tank to each chamber", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::valve_range_v, {"valve_range", "valve_range_v", "u_r", "V", "voltage beyond the dead band at which the power law or the table agrees with valve_gain", "docs/model.md", K::term, 1e-3, 1e3, 10.0, false}},
      F{&P::valve_exponent, {"valve_exponent", "valve_exponent", "n_v", "1", "exponent of the opening of an electric valve beyond the dead band, as with notches in the spool", "docs/model.md", K::term, 1, 6, 1.0}},
      F{&P::opening_20, {"opening_20", "opening_20", "o_20", "1", "opening at 20 % of the range beyond the dead band, relative to that at 100 %: a table instead of a power law", "docs/model.md", K::term, 0, 1, 0.2}},
      F{&P::opening_40, {"opening_40", "opening_40", "o_40", "1", "relative opening at 40 % of that range", "docs/model.md", K::term, 0, 1, 0.4}},
      F{&P::opening_60, {"opening_60", "opening_60", "o_60", "1", "relative opening at 60 % of that range", "docs/model.md", K::term, 0, 1, 0.6}},
      F{&P::opening_80, {"opening_80", "opening_80", "o_80", "1", "relative opening at 80 % of that range", "docs/model.md", K::term, 0, 1, 0.8}},
      F{&P::compensator_pressure_pa, {"compensator_pressure", "compensator_pressure_pa", "p_c", "Pa", "pressure drop that a compensator maintains across the edges from the supply, so that their flow does not depend on the load", "docs/model.md", K::term, 1e4, 1e8, 0.0}},
      F{&P::valve_bypass_range_v, {"valve_bypass_range", "valve_bypass_range_v", "u_b", "V", "voltage beyond the dead band at which the path from pump to tank is closed", "docs/model.md", K::term, 1e-3, 1e3, 10.0, false}},
      F{&P::load_sensing_margin_pa, {"load_sensing_margin", "load_sensing_margin_pa", "p_LS", "Pa", "margin of the pump pressure over that of the driven chamber (load sensing), up to supply_pressure", "docs/model.md", K::term, 0, 1e8, 0.0}},
      // clang-format on
  };
}

/// Optional terms for valve, pump, accumulator and check valves.
template <template <typename> class Parameters, typename T>
constexpr auto metering_rows() {
  return joined(pilot_rows<Parameters, T>(), pump_rows<Parameters, T>(),
                opening_rows<Parameters, T>(), relief_rows<Parameters, T>());
}

/// Initial pressures of both chambers.
template <template <typename> class Parameters, typename T>
constexpr auto chamber_initial_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::initial_pressure_a_pa, {"initial_pressure_a", "initial_pressure_a_pa", "p_A(0)", "Pa", "recorded pressure A at the first sample", "docs/model.md", K::initial, -1e9, 1e9, 0.0}},
      F{&P::initial_pressure_b_pa, {"initial_pressure_b", "initial_pressure_b_pa", "p_B(0)", "Pa", "recorded pressure B at the first sample", "docs/model.md", K::initial, -1e9, 1e9, 0.0}},
      // clang-format on
  };
}

/// Returns the rows except those with the given keys.
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

inline constexpr std::array kElectricGain{std::string_view("valve_gain")};

/// Rows of the two-chamber plant, in the order of `rigcal params`.
template <typename T>
constexpr auto two_chamber_fields() {
  return joined(
      motion_rows<TwoChamberParameters, T>(), chamber_rows<TwoChamberParameters, T>(),
      rows_without(oil_rows<TwoChamberParameters, T>(), kElectricGain),
      electric_gain_rows<TwoChamberParameters, T>(), valve_rows<TwoChamberParameters, T>(),
      load_rows<TwoChamberParameters, T>(), sensor_rows<TwoChamberParameters, T>(),
      chamber_term_rows<TwoChamberParameters, T>(), supply_rows<TwoChamberParameters, T>(),
      metering_rows<TwoChamberParameters, T>(), chamber_initial_rows<TwoChamberParameters, T>(),
      controller_rows<TwoChamberParameters, T>());
}

template <typename T>
inline constexpr auto kTwoChamberFields = two_chamber_fields<T>();

static_assert(kTwoChamberFields<double>.size() * sizeof(double) ==
                  sizeof(TwoChamberParameters<double>),
              "a parameter was added to the struct but not to the table");

}  // namespace rigcal::model
