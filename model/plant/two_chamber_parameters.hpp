#pragma once

#include "model/plant/parameter_values.hpp"

namespace rigcal::model {

/// A cylinder with both chambers: single-rod or double-rod.
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
  T supply_resistance_pa_s_per_m3{};
  T supply_capacity_m3_per_pa{};
  T initial_pressure_a_pa{};
  T initial_pressure_b_pa{};
};

/// Areas, travel and oil of both chambers.
template <template <typename> class Parameters, typename T>
constexpr auto chamber_rows() {
  using P = Parameters<T>;
  using K = ParameterKind;
  using F = ParameterField<P, T>;
  return std::array{
      // clang-format off
      F{&P::area_a_m2, {"area_a", "area_a_m2", "A_A", "m2", "piston area of chamber A, which moves the piston out", "docs/model.md", K::plant, 1e-8, 10}},
      F{&P::area_b_m2, {"area_b", "area_b_m2", "A_B", "m2", "piston area of chamber B: the annulus of a single-rod cylinder", "docs/model.md", K::plant, 1e-8, 10}},
      F{&P::stroke_m, {"stroke", "stroke_m", "H", "m", "travel from stop to stop", "docs/model.md", K::plant, 1e-4, 100}},
      F{&P::dead_volume_a_m3, {"dead_volume_a", "dead_volume_a_m3", "V_A0", "m3", "oil of chamber A and its hose at the retracted stop", "docs/model.md", K::plant, 0, 10}},
      F{&P::dead_volume_b_m3, {"dead_volume_b", "dead_volume_b_m3", "V_B0", "m3", "oil of chamber B and its hose at the extended stop", "docs/model.md", K::plant, 0, 10}},
      F{&P::tank_pressure_pa, {"tank_pressure", "tank_pressure_pa", "P_t", "Pa", "pressure at the valve's tank port", "docs/model.md", K::plant, -1e5, 1e8}},
      // clang-format on
  };
}

/// Optional terms of stops, edges, chambers, hoses and supply.
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
      F{&P::gravity_m_per_s2, {"gravity", "gravity_m_per_s2", "g", "m/s2", "gravity against positive travel", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::gain_supply_to_a, {"gain_supply_to_a", "gain_supply_to_a", "g_PA", "1", "area of the edge from supply to A over the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::gain_a_to_tank, {"gain_a_to_tank", "gain_a_to_tank", "g_AT", "1", "area of the edge from A to tank over the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::gain_supply_to_b, {"gain_supply_to_b", "gain_supply_to_b", "g_PB", "1", "area of the edge from supply to B over the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::gain_b_to_tank, {"gain_b_to_tank", "gain_b_to_tank", "g_BT", "1", "area of the edge from B to tank over the nominal one", "docs/model.md", K::term, 1e-3, 1e3, 1.0}},
      F{&P::overlap_supply_to_a_v, {"overlap_supply_to_a", "overlap_supply_to_a_v", "d_PA", "V", "overlap of the edge from supply to A beyond the dead band; negative: underlap", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::overlap_a_to_tank_v, {"overlap_a_to_tank", "overlap_a_to_tank_v", "d_AT", "V", "overlap of the edge from A to tank beyond the dead band", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::overlap_supply_to_b_v, {"overlap_supply_to_b", "overlap_supply_to_b_v", "d_PB", "V", "overlap of the edge from supply to B beyond the dead band", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::overlap_b_to_tank_v, {"overlap_b_to_tank", "overlap_b_to_tank_v", "d_BT", "V", "overlap of the edge from B to tank beyond the dead band", "docs/model.md", K::term, -100, 100, 0.0}},
      F{&P::valve_null_opening_v, {"valve_null_opening", "valve_null_opening_v", "u_c", "V", "opening of an edge where its land just covers it (orifice leak of the valve)", "docs/model.md", K::term, 1e-6, 100, 0.0}},
      F{&P::valve_line_opening_v, {"valve_line_opening", "valve_line_opening_v", "u_l", "V", "opening at which an edge and the lines in series with it lose alike", "docs/model.md", K::term, 1e-3, 1e6, 0.0}},
      F{&P::external_leakage_a_m3_per_s_pa, {"external_leakage_a", "external_leakage_a_m3_per_s_pa", "G_A", "m3/(s Pa)", "laminar leak of chamber A to the tank", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::external_leakage_b_m3_per_s_pa, {"external_leakage_b", "external_leakage_b_m3_per_s_pa", "G_B", "m3/(s Pa)", "laminar leak of chamber B to the tank", "docs/model.md", K::term, 0, 1, 0.0}},
      F{&P::air_fraction, {"air_fraction", "air_fraction", "alpha", "1", "volume share of undissolved air at atmospheric pressure", "docs/model.md", K::term, 0, 0.5, 0.0}},
      F{&P::air_exponent, {"air_exponent", "air_exponent", "n", "1", "polytropic exponent of that air", "docs/model.md", K::term, 1, 1.67, 1.4}},
      F{&P::hose_capacity_a_m3_per_pa, {"hose_capacity_a", "hose_capacity_a_m3_per_pa", "C_hA", "m3/Pa", "what the hose of chamber A takes up per pressure once it yields", "docs/model.md", K::term, 0, 1e-6, 0.0}},
      F{&P::hose_capacity_b_m3_per_pa, {"hose_capacity_b", "hose_capacity_b_m3_per_pa", "C_hB", "m3/Pa", "what the hose of chamber B takes up per pressure once it yields", "docs/model.md", K::term, 0, 1e-6, 0.0}},
      F{&P::hose_yield_pa, {"hose_yield", "hose_yield_pa", "p_h", "Pa", "pressure after a turn over which hoses begin to yield", "docs/model.md", K::term, 1e3, 1e9, 0.0}},
      F{&P::hose_yield_ratio, {"hose_yield_ratio", "hose_yield_ratio", "kappa_h", "1", "what hose_yield grows by with the absolute pressure, of the pressure", "docs/model.md", K::term, 1e-3, 100, 0.0}},
      F{&P::supply_resistance_pa_s_per_m3, {"supply_resistance", "supply_resistance_pa_s_per_m3", "R_s", "Pa s/m3", "resistance between the source and the valve", "docs/model.md", K::term, 1e-3, 1e15, 0.0}},
      F{&P::supply_capacity_m3_per_pa, {"supply_capacity", "supply_capacity_m3_per_pa", "C_s", "m3/Pa", "oil that hose and accumulator at the valve take up per pressure", "docs/model.md", K::term, 1e-18, 1e-3, 0.0}},
      // clang-format on
  };
}

/// Pressures of both chambers at the first sample.
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

/// The two-chamber plant, in the order of `rigcal params`.
template <typename T>
constexpr auto two_chamber_fields() {
  return joined(
      motion_rows<TwoChamberParameters, T>(), chamber_rows<TwoChamberParameters, T>(),
      shared_rows<TwoChamberParameters, T>(), chamber_term_rows<TwoChamberParameters, T>(),
      chamber_initial_rows<TwoChamberParameters, T>(), controller_rows<TwoChamberParameters, T>());
}

template <typename T>
inline constexpr auto kTwoChamberFields = two_chamber_fields<T>();

static_assert(kTwoChamberFields<double>.size() * sizeof(double) ==
                  sizeof(TwoChamberParameters<double>),
              "a parameter was added to the struct but not to the table");

}  // namespace rigcal::model
