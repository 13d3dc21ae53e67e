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
/// @param dx       derivative at x
template <std::size_t N>
void plant_indicators(const LoadPressurePlant::Coefficients<double>& p, const PresentTerms& terms,
                      const std::array<double, N>& /*x*/, const std::array<double, N>& /*dx*/,
                      double spool_v, std::vector<double>& indicators) {
  if (!terms.spool_shape) {
    indicators.push_back(spool_v);
    return;
  }
  indicators.push_back(spool_v + p.valve_offset_v - p.valve_dead_band_v);
  indicators.push_back(spool_v + p.valve_offset_v + p.valve_dead_band_v);
}

template <std::size_t N>
void plant_indicators(const TwoChamberPlant::Coefficients<double>& p, const PresentTerms& terms,
                      const std::array<double, N>& x, const std::array<double, N>& dx,
                      double spool_v, std::vector<double>& indicators) {
  using Plant = TwoChamberPlant;
  const double out_v = spool_v + p.valve_offset_v;
  if (!terms.null_opening) {  // else edges open smoothly
    indicators.push_back(out_v - p.valve_dead_band_v - p.overlap_supply_to_a_v);
    indicators.push_back(-out_v - p.valve_dead_band_v - p.overlap_a_to_tank_v);
    indicators.push_back(-out_v - p.valve_dead_band_v - p.overlap_supply_to_b_v);
    indicators.push_back(out_v - p.valve_dead_band_v - p.overlap_b_to_tank_v);
  }
  const double extended_m = x[Plant::position] - Plant::retracted_stop(p, terms);
  indicators.push_back(extended_m);
  indicators.push_back(p.stroke_m - extended_m);
  if (terms.hoses < 0) return;  // else each hose yields in the direction of its pressure change
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
  if (terms.return_band) {
    indicators.push_back(out - p.return_dead_band_pa);
    indicators.push_back(-out - p.return_dead_band_pa);
  }
  if (terms.bypass) {
    indicators.push_back(p.dead_band + p.bypass_range_pa - out);
    indicators.push_back(p.dead_band + p.bypass_range_pa + out);
  }
  indicators.push_back(x[Plant::angle] - p.lower_stop_rad);
  indicators.push_back(p.upper_stop_rad - x[Plant::angle]);
  if (terms.make_up) {  // pressures count from the tank's, whose changes are small
    indicators.push_back(x[Plant::pressure_a] - p.tank_pressure_pa);
    indicators.push_back(x[Plant::pressure_b] - p.tank_pressure_pa);
  }
  if (terms.pump_flow && terms.supply >= 0) {
    const double asked = (p.supply_pressure_pa - x[static_cast<std::size_t>(terms.supply)]) /
                         p.supply_resistance_pa_s_per_m3;
    indicators.push_back(Plant::largest_flow(x, p, terms) - asked);
  }
}

/// Limits of the controller's output and of the spool's rate.
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
  const double rate =
      layout.valve_order == 1 ? (command_v - x[spool]) / p.valve_time_constant_s : x[spool + 1];
  indicators.push_back(p.valve_rate_limit_v_per_s - rate);
  indicators.push_back(p.valve_rate_limit_v_per_s + rate);
}

}  // namespace rigcal::model
