#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// The scaling that leaves positions unchanged: every force, pressure and stiffness is multiplied
/// by s, the gains of turbulent flows (valve and leak) are divided by sqrt(s), laminar conductances
/// and capacities by s. The exponent of s for a parameter is the power of mass in its unit, except
/// for the gains, which represent the constant density. 0: it does not take part.
double scaling_exponent(const model::ParameterSpec& spec);

/// How closely a problem has that symmetry.
struct ScalingSymmetry {
  std::vector<std::size_t> unknowns;  ///< parameters that take part, at least two
  std::vector<std::string> known;     ///< names of known values that would have to be scaled too
  /// Standard deviation of ln s that the records leave, everything else known.
  double relative_sd = 0.0;

  bool holds() const;  ///< s is determined to 10 % at best
};

/// Empty if a pressure or force is compared, if the supply pressure is known (it fixes s), or if
/// fewer than two unknowns would be scaled. The smoothing of the orifice roots is scaled, too: it
/// is no physics that could determine s.
///
/// @param sigma  factor on the standard errors
std::optional<ScalingSymmetry> scaling_symmetry(const Problem& problem, std::span<const double> z,
                                                double sigma, int threads);

/// Measures that would determine what the symmetry leaves open.
std::string symmetry_remedy(const Problem& problem, const ScalingSymmetry& symmetry);

/// Describes the symmetry: "multiplying mass_kg, ... by a factor s and dividing valve_gain_m_per_v
/// (by sqrt(s)), ... by it leaves all positions unchanged; ...". If known values would have to be
/// scaled, too, it says that only they fix s. Empty if there is no symmetry and nothing depends on
/// them.
std::string describe(const Problem& problem, const ScalingSymmetry& symmetry);

/// Unknowns that a symmetry leaves open are not identifiable, and have no errors: those of the
/// Jacobian rest on the smoothing of the orifice roots, which is no physics.
void grade_symmetric(const Problem& problem, const ScalingSymmetry& symmetry,
                     std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
