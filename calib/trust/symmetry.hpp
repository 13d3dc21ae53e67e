#pragma once

#include <optional>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/fit_result.hpp"

namespace rigcal::calib {

/// Returns the exponent of s for a parameter in the scaling that leaves positions unchanged. In
/// this scaling every force, pressure and stiffness is multiplied by s, the gains of turbulent
/// flows (valve and leak) are divided by sqrt(s), and laminar conductances and capacities are
/// divided by s. The exponent is the power of mass in the unit of the parameter, except for the
/// gains, which contain the constant density. It is 0 if the parameter is not scaled.
double scaling_exponent(const model::ParameterSpec& spec);

/// How closely a problem follows the scaling symmetry.
struct ScalingSymmetry {
  std::vector<std::size_t> unknowns;  ///< parameters that are scaled; at least two
  std::vector<std::string> known;     ///< names of known values that would have to be scaled, too
  /// Standard deviation of ln s after the fit if everything else were known.
  double relative_sd = 0.0;

  bool holds() const;  ///< true if the records determine s to no better than 10 %
};

/// Looks for the scaling symmetry. Returns std::nullopt if a pressure or force is compared, if the
/// supply pressure is known (it fixes s), or if fewer than two unknowns would be scaled. The
/// smoothing of the orifice roots is also scaled, because it has no physical meaning and must not
/// determine s.
///
/// @param sigma  factor for the standard errors
std::optional<ScalingSymmetry> scaling_symmetry(const Problem& problem, std::span<const double> z,
                                                double sigma, int threads);

/// Describes measurements or values that would determine the parameters which the symmetry leaves
/// undetermined.
std::string symmetry_remedy(const Problem& problem, const ScalingSymmetry& symmetry);

/// Describes the symmetry: "multiplying mass_kg, ... by a factor s and dividing valve_gain_m_per_v
/// (by sqrt(s)), ... by it leaves all positions unchanged; ...". If known values would have to be
/// scaled, too, the text states that only these fix s. Empty if there is no symmetry and nothing
/// depends on these values.
std::string describe(const Problem& problem, const ScalingSymmetry& symmetry);

/// Grades the unknowns that a symmetry leaves undetermined as not identifiable, and removes their
/// errors. Errors from the Jacobian would only reflect the smoothing of the orifice roots, which
/// has no physical meaning.
void grade_symmetric(const Problem& problem, const ScalingSymmetry& symmetry,
                     std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
