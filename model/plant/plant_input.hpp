#pragma once

#include "model/plant/layout.hpp"
#include "model/plant/parameter_values.hpp"
#include "model/plant/terms.hpp"

namespace rigcal::model {

/// What acts on a plant at one instant; X carries time derivatives where they are wanted.
template <typename X>
struct PlantInput {
  X spool_command_v;     ///< valve signal after its dynamics [V]
  X external_force_n;    ///< load against positive travel [N]; set where that term takes part
  X supply_pressure_pa;  ///< P_s [Pa]
  X tank_pressure_pa;    ///< P_t [Pa]; set where the plant has one
};

/// Dry friction of piston and rod [N]; absent unless given.
template <typename X, typename C>
X friction(const X& v, const CommonParameters<C>& p, const PresentTerms& terms) {
  if (!terms.friction) return X(0.0);
  if (!terms.stribeck) return p.coulomb_friction_n * smooth_sign(v, p.friction_smoothing_m_per_s);
  return dry_friction(v, p.coulomb_friction_n, p.stribeck_friction_n, p.stribeck_velocity_m_per_s,
                      p.friction_smoothing_m_per_s);
}

}  // namespace rigcal::model
