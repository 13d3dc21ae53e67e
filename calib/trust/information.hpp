#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "common/describe.hpp"

namespace rigcal::calib {

/// Cramer-Rao standard deviation of each unknown, SI, from a Jacobian of weighted residuals (any
/// number of rows, one column per unknown, unit box), for white noise and all unknowns free. Empty
/// if it takes part in a direction that the rows do not determine.
std::vector<std::optional<double>> cramer_rao(const Problem& problem, std::span<const double> z,
                                              const Eigen::MatrixXd& jacobian);

/// The start values of a problem, with those of an earlier fit where it has them.
///
/// @param values  may be null
std::vector<double> point_at(const Problem& problem,
                             const std::vector<datasets::FittedValue>* values);

/// One unknown of a test that is planned.
struct TestedParameter {
  std::string name;  ///< that of results: "mass_kg"
  std::string unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;  ///< leak level or condition; absent: the rig
  double value = 0.0;

  std::string label() const;  ///< "leakage_coefficient (33 %)"
};
TestedParameter parameter_at(const Problem& problem, std::span<const double> z,
                             std::size_t unknown);

/// Jacobian of all priors, and of conditions whose information counts so many times. Those that
/// could not be simulated do not count.
///
/// @param weights  shape (conditions), not negative
Eigen::MatrixXd weighted_jacobian(const Problem& problem, const Evaluation& at,
                                  const std::vector<double>& weights);

/// Half width of the 95 % interval of such a standard deviation, as a share of the value; empty
/// without one, or where the value is 0.
std::optional<double> relative_half_width(const std::optional<double>& sd, double value);

/// Suggests additions that would determine unknowns which the records leave open. For each target
/// it gives the simplest additions that bring its interval below 20 % of the value, in words: "a
/// prior on mass_kg (5 %)", "a recorded load pressure", "a square wave of 10 Hz" (the first two
/// priors, the slowest signal). Each is tried alone, by simulation at z. Empty if none is
/// sufficient.
///
/// @param jacobian  of all conditions and priors
std::vector<std::string> remedies(const Problem& problem, std::span<const double> z,
                                  const Eigen::MatrixXd& jacobian, std::size_t target);

}  // namespace rigcal::calib
