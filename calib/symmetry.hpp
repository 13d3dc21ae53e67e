#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/fit.hpp"
#include "calib/problem.hpp"

namespace rigcal::calib {

/// What would tell parameters that a scaling symmetry leaves open.
inline constexpr std::string_view kSymmetryRemedy =
    "a prior on mass or supply pressure, or a recorded pressure or force";

/// The scaling that leaves positions as they are: every force, pressure and stiffness times s, the
/// flow gains of valve and leak divided by sqrt(s) (or s, where they are laminar). Exponent of s of
/// a parameter, by its key; 0: it does not take part.
double scaling_exponent(std::string_view key);

/// How far a problem is from that symmetry.
struct ScalingSymmetry {
  std::vector<std::size_t> unknowns;  ///< that take part, two at least
  std::vector<std::string> known;     ///< names of known values that would have to be scaled too
  /// Standard deviation of ln s that the records leave, everything else known.
  double relative_sd = 0.0;

  bool holds() const;  ///< s is told no better than to 10 %
};

/// Empty where a pressure or force is compared, or fewer than two unknowns would be scaled. The
/// smoothing of the orifice roots is scaled along: it is no physics that could tell s.
///
/// @param jacobian  of all conditions and priors in the unit box, residuals weighted
/// @param sigma     what standard errors are scaled by
std::optional<ScalingSymmetry> scaling_symmetry(const Problem& problem, std::span<const double> z,
                                                const Eigen::MatrixXd& jacobian, double sigma,
                                                int threads);

/// The symmetry in words: "positions stay as they are where mass_kg, ... grow by a factor s and
/// valve_gain_m_per_v, ... fall by its square root; ...". Where it does not hold, but supply
/// pressure and another pressure, force or stiffness are both free: on which known values the scale
/// rests. Otherwise empty.
std::string describe(const Problem& problem, const ScalingSymmetry& symmetry);

/// Unknowns that a symmetry leaves open are not identifiable, and have no errors: those of the
/// Jacobian rest on the smoothing of the orifice roots, which is no physics.
void grade_symmetric(const ScalingSymmetry& symmetry, std::vector<FittedParameter>& parameters);

}  // namespace rigcal::calib
