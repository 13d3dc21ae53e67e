#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// The scaling that leaves positions unchanged: every force, pressure and stiffness times s, the
/// gains of turbulent flows (valve and leak) divided by sqrt(s), laminar conductances and
/// capacities by s. Exponent of s of a parameter: the power of mass in its unit, but for the gains,
/// which stand for the density that stays. 0: it does not take part.
double scaling_exponent(const model::ParameterSpec& spec);

/// How far a problem is from that symmetry.
struct ScalingSymmetry {
  std::vector<std::size_t> unknowns;  ///< that take part, two at least
  std::vector<std::string> known;     ///< names of known values that would have to be scaled too
  /// Standard deviation of ln s that the records leave, everything else known.
  double relative_sd = 0.0;

  bool holds() const;  ///< s is told no better than to 10 %
};

/// Empty where a pressure or force is compared, the supply pressure is known (it fixes s), or fewer
/// than two unknowns would be scaled. The smoothing of the orifice roots is scaled along: it is no
/// physics that could tell s.
///
/// @param sigma  what standard errors are scaled by
std::optional<ScalingSymmetry> scaling_symmetry(const Problem& problem, std::span<const double> z,
                                                double sigma, int threads);

/// What would make identifiable what the symmetry leaves open.
std::string symmetry_remedy(const Problem& problem, const ScalingSymmetry& symmetry);

/// The symmetry in words: "multiplying mass_kg, ... by a factor s and dividing valve_gain_m_per_v
/// (by sqrt(s)), ... by it leaves all positions unchanged; ...". Where known values would have to
/// be scaled too: that only they fix s. Empty where it does not hold and nothing rests on them.
std::string describe(const Problem& problem, const ScalingSymmetry& symmetry);

/// Unknowns that a symmetry leaves open are not identifiable, and have no errors: those of the
/// Jacobian rest on the smoothing of the orifice roots, which is no physics.
void grade_symmetric(const Problem& problem, const ScalingSymmetry& symmetry,
                     std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
