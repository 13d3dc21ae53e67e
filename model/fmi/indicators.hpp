#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "model/plant/controller.hpp"
#include "model/plant/linkage.hpp"
#include "model/plant/load_pressure.hpp"
#include "model/plant/two_chamber.hpp"

namespace rigcal::model {

// Quantities that change sign where the right-hand side of a rig has a kink.

/// @param spool_v  valve signal after its dynamics
/// @param dx       time derivative at x
template <std::size_t N>
void plant_indicators(const LoadPressurePlant::Coefficients<double>& p, const PresentTerms& terms,
                      const std::array<double, N>& x, const std::array<double, N>& /*dx*/,
                      double spool_v, std::vector<double>& indicators) {
  if (terms.spool_shape) {
    indicators.push_back(spool_v + p.valve_offset_v - p.valve_dead_band_v);
    indicators.push_back(spool_v + p.valve_offset_v + p.valve_dead_band_v);
  } else {
    indicators.push_back(spool_v);
  }
  const double supply_pa =
      terms.supply >= 0 ? x[static_cast<std::size_t>(terms.supply)] : p.supply_pressure_pa;
  const PlantInput<double> in{spool_v, 0.0, supply_pa, 0.0};
  if (terms.relief) {
    for (const Output output : {Output::pressure_a, Output::pressure_b})
      indicators.push_back(p.relief_pressure_pa -
                           LoadPressurePlant::output(output, x, in, p, terms));
  }
  if (terms.pump_flow)
    indicators.push_back(p.pump_flow_m3_per_s - asked_flow(p.supply_pressure_pa, in, p));
}

/// Appends the indicators of chambers, valve and pump. Pressures are relative to the tank pressure,
/// which hardly changes.
template <typename P, std::size_t N>
void chamber_indicators(const P& p, const PresentTerms& terms, const std::array<double, N>& x,
                        double spool, std::vector<double>& indicators) {
  const auto pressures = {x[Chambers::pressure_a], x[Chambers::pressure_b]};
  const double out = spool + p.valve_offset_v;
  for (const double way : {out, -out}) {
    if (terms.return_band) indicators.push_back(way - p.return_dead_band_pa);
    if (terms.bypass)
      indicators.push_back(p.dead_band +
                           (terms.pilot ? p.bypass_range_pa : p.valve_bypass_range_v) - way);
    if (terms.table_opening) {
      const double range = terms.pilot ? p.pilot_range_pa : p.valve_range_v;
      for (const double share : {0.2, 0.4, 0.6, 0.8})
        indicators.push_back(way - p.dead_band - share * range);
    }
  }
  if (terms.compensator) {
    const double supply_pa =
        terms.supply >= 0 ? x[static_cast<std::size_t>(terms.supply)] : p.supply_pressure_pa;
    for (const double pressure : pressures)
      indicators.push_back(supply_pa - pressure - p.compensator_pressure_pa);
  }
  for (const double pressure : pressures) {
    if (terms.make_up) indicators.push_back(pressure - p.tank_pressure_pa);
    if (terms.relief) indicators.push_back(p.relief_pressure_pa - pressure);
  }
  if (terms.supply < 0) return;
  const double supply_pa = x[static_cast<std::size_t>(terms.supply)];
  const PlantInput<double> in{spool, 0.0, supply_pa, p.tank_pressure_pa};
  if (terms.load_sensing) {
    indicators.push_back(Chambers::sensed_pressure(1e300, x, in, p, terms) - p.supply_pressure_pa);
  }
  if (terms.pump_flow) {
    PresentTerms without = terms;
    without.pump_flow = false;
    indicators.push_back(Chambers::largest_flow(x, p, terms) -
                         Chambers::pump_flow(p.supply_pressure_pa, x, in, p, without));
  }
}

template <std::size_t N>
void plant_indicators(const TwoChamberPlant::Coefficients<double>& p, const PresentTerms& terms,
                      const std::array<double, N>& x, const std::array<double, N>& dx,
                      double spool_v, std::vector<double>& indicators) {
  using Plant = TwoChamberPlant;
  const double out = spool_v + p.valve_offset_v;
  if (!terms.null_opening) {  // with a null opening the edges open smoothly
    indicators.push_back(out - p.dead_band - p.overlap_supply_to_a_v);
    indicators.push_back(-out - p.dead_band - p.overlap_a_to_tank_v);
    indicators.push_back(-out - p.dead_band - p.overlap_supply_to_b_v);
    indicators.push_back(out - p.dead_band - p.overlap_b_to_tank_v);
  }
  const double extended_m = x[Plant::position] - Plant::retracted_stop(p, terms);
  indicators.push_back(extended_m);
  indicators.push_back(p.stroke_m - extended_m);
  chamber_indicators(p, terms, x, spool_v, indicators);
  if (terms.hoses < 0) return;  // a hose behaves differently while its pressure rises or falls
  indicators.push_back(dx[Plant::pressure_a]);
  indicators.push_back(dx[Plant::pressure_b]);
}

template <std::size_t N>
void plant_indicators(const LinkagePlant::Coefficients<double>& p, const PresentTerms& terms,
                      const std::array<double, N>& x, const std::array<double, N>& /*dx*/,
                      double spool, std::vector<double>& indicators) {
  using Plant = LinkagePlant;
  const double out = spool + p.valve_offset_v;
  indicators.push_back(out - p.dead_band);
  indicators.push_back(-out - p.dead_band);
  indicators.push_back(x[Plant::angle] - p.lower_stop_rad);
  indicators.push_back(p.upper_stop_rad - x[Plant::angle]);
  if (p.law == TravelLaw::table) {  // the lever bends in the middle of each piece
    const double range_rad = p.travel_table_to_rad - p.travel_table_from_rad;
    for (const double place : {0.1, 0.3, 0.5, 0.7, 0.9})
      indicators.push_back(x[Plant::angle] - p.travel_table_from_rad - place * range_rad);
  }
  chamber_indicators(p, terms, x, spool, indicators);
}

/// Appends the pressure across the piston, whose magnitude presses the seals, the velocity, because
/// the bristle force has a kink where the velocity changes sign, and the deviation of the
/// lubricant film from its steady thickness, because it grows at another rate than it decays.
template <typename Plant, typename P, std::size_t N>
void friction_indicators(const P& p, const PresentTerms& terms, const std::array<double, N>& x,
                         std::vector<double>& indicators) {
  if (terms.seal_friction) indicators.push_back(Plant::pressure_across(x));
  const double v = Plant::piston_velocity(x, p);
  if (terms.bristles >= 0) indicators.push_back(v);
  if (terms.film >= 0)
    indicators.push_back(steady_film(v, p.film_velocity_m_per_s, p.friction_smoothing_m_per_s) -
                         x[static_cast<std::size_t>(terms.film)]);
}

/// Appends the indicators for the limits of controller output and spool rate.
///
/// @param wanted_v   controller output before its limit
/// @param command_v  command to the valve
template <typename P, std::size_t N>
void loop_indicators(const P& p, const Layout& layout, const std::array<double, N>& x,
                     double wanted_v, double command_v, std::vector<double>& indicators) {
  if (layout.pid && !layout.sampled() && std::isfinite(p.output_limit_v)) {
    indicators.push_back(p.output_limit_v - wanted_v);
    indicators.push_back(p.output_limit_v + wanted_v);
  }
  if (!layout.terms.valve_rate_limit || layout.valve_order == 0) return;
  const auto spool = static_cast<std::size_t>(layout.valve);
  const double rate = layout.main_spool         ? (command_v - x[spool]) * p.main_spool_gain_per_s
                      : layout.valve_order == 1 ? (command_v - x[spool]) / p.valve_time_constant_s
                                                : x[spool + 1];
  indicators.push_back(p.valve_rate_limit_v_per_s - rate);
  indicators.push_back(p.valve_rate_limit_v_per_s + rate);
}

}  // namespace rigcal::model
