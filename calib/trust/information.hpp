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

/// Returns the Cramer-Rao standard deviation of each unknown, SI, from a Jacobian of weighted
/// residuals (any number of rows, one column per unknown, unit box). Assumes that the noise is
/// white and all unknowns are free. The value is absent if the unknown contributes to a direction
/// that the rows do not determine.
std::vector<std::optional<double>> cramer_rao(const Problem& problem, std::span<const double> z,
                                              const Eigen::MatrixXd& jacobian);

/// Returns the start values of a problem, replaced by the values from an earlier fit where
/// available.
///
/// @param values  may be null
std::vector<double> point_at(const Problem& problem,
                             const std::vector<datasets::FittedValue>* values);

/// One unknown in a planned test.
struct TestedParameter {
  std::string name;  ///< name in result files, such as "mass_kg"
  std::string unit;
  datasets::Scope scope = datasets::Scope::rig;
  std::optional<std::string> level;  ///< leak level or condition; absent for the rig
  double value = 0.0;

  std::string label() const;  ///< for example "leakage_coefficient (33 %)"
};
TestedParameter parameter_at(const Problem& problem, std::span<const double> z,
                             std::size_t unknown);

/// Returns the Jacobian of all priors and conditions, with the information of each condition
/// multiplied by its weight. Conditions that could not be simulated are left out.
///
/// @param weights  shape (conditions), not negative
Eigen::MatrixXd weighted_jacobian(const Problem& problem, const Evaluation& at,
                                  const std::vector<double>& weights);

/// Converts a standard deviation to the half-width of the 95 % interval, as a fraction of the
/// value. Returns std::nullopt if `sd` is absent or the value is 0.
std::optional<double> relative_half_width(const std::optional<double>& sd, double value);

/// Suggests additions that would determine an unknown which the records leave undetermined.
/// Returns, in words, the simplest additions that reduce its interval to less than 20 % of the
/// value, for example "a prior on mass_kg (5 %)", "a recorded load pressure" or "a square wave of
/// 10 Hz". At most two priors are suggested, and only the slowest sufficient signal. Each addition
/// is tried separately, by simulation at z. Empty if none is sufficient.
///
/// @param jacobian  Jacobian for all conditions and priors
std::vector<std::string> remedies(const Problem& problem, std::span<const double> z,
                                  const Eigen::MatrixXd& jacobian, std::size_t target);

}  // namespace rigcal::calib
