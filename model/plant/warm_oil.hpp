#pragma once

#include <cmath>
#include <new>
#include <type_traits>

namespace rigcal::model {

/// Space for the parameters at a recorded oil temperature. Every right-hand side provides it, but
/// few rigs use it. std::optional would clear all of it each time, 7 kB with derivatives.
template <typename T>
class WarmParameters {
 public:
  static_assert(std::is_trivially_destructible_v<T>);
  WarmParameters() {}  // NOLINT(modernize-use-equals-default): leaves the space as it is

  template <typename From>
  const T& emplace(const From& from) {
    return *new (&value_) T(from);
  }

 private:
  union {
    T value_;
  };
};

/// Replaces the parameters that depend on the oil by their values at its temperature. The given
/// values hold at the reference temperature.
///
/// @param p              parameters of a plant
/// @param temperature_k  temperature of the oil
/// @source  H. E. Merritt, Hydraulic Control Systems (Wiley 1967), section 2-3: viscosity falls
///          exponentially, and volume grows linearly, with temperature; P. K. B. Hodges, Hydraulic
///          Fluids (Arnold 1996): the logarithm of the bulk modulus falls linearly
template <typename P, typename C>
void warm_oil(P& p, const C& temperature_k) {
  using std::exp;
  const C above_k = temperature_k - p.reference_temperature_k;
  p.density_kg_per_m3 = p.density_kg_per_m3 / (1.0 + p.thermal_expansion_per_k * above_k);
  p.bulk_modulus_pa = p.bulk_modulus_pa * exp(C(0.0 - p.bulk_modulus_decay_per_k * above_k));
  // What is laminar: resistances and the damping of films are proportional to the viscosity.
  const C viscosity = exp(C(0.0 - p.viscosity_decay_per_k * above_k));
  p.damping_n_s_per_m = p.damping_n_s_per_m * viscosity;
  p.leakage_resistance_pa_s_per_m3 = p.leakage_resistance_pa_s_per_m3 * viscosity;
  p.laminar_leakage_m3_per_s_pa = p.laminar_leakage_m3_per_s_pa / viscosity;
  p.valve_null_leakage_m3_per_s_pa = p.valve_null_leakage_m3_per_s_pa / viscosity;
  if constexpr (requires { p.external_leakage_a_m3_per_s_pa; }) {
    p.external_leakage_a_m3_per_s_pa = p.external_leakage_a_m3_per_s_pa / viscosity;
    p.external_leakage_b_m3_per_s_pa = p.external_leakage_b_m3_per_s_pa / viscosity;
    p.return_line_resistance_pa_s_per_m3 = p.return_line_resistance_pa_s_per_m3 * viscosity;
  }
}

}  // namespace rigcal::model
