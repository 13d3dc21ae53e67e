#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {

/// Known values with a stated uncertainty, and its effect on the estimates: `prior` and `prior_sd`
/// of a parameter that is not fitted; `gain_sd` and `offset_sd` of a compared channel, for the gain
/// and offset of its sensor.
struct KnownUncertainty {
  std::vector<std::string> names;
  /// Change of the unknowns in the unit box per standard deviation of each, to first order:
  /// -(J^T J)^-1 J^T J_known sd. Shape (unknowns, names).
  Eigen::MatrixXd response;
};

/// Names of these values in messages.
std::vector<std::string> uncertain_names(const Problem& problem);

/// Weighted sensitivities of one condition to parameters that are known in it: shape (channels *
/// samples that count, indices), per SI unit; empty where it cannot be simulated.
///
/// @param indices  rows of the parameter table, none of them free in the condition
Eigen::MatrixXd known_sensitivities(const Problem& problem, std::size_t condition,
                                    std::span<const double> z, const std::vector<int>& indices);

/// Change of the unknowns in the unit box, -(J^T J)^-1 J^T K, by what changes the weighted outputs
/// of each condition by the columns of K. Shape (unknowns, columns).
///
/// @param known  K of a condition, shape (residuals, columns); empty: none
Eigen::MatrixXd response_of_unknowns(const Problem& problem, const std::vector<ConditionRows>& rows,
                                     const ArrowRoot& root, Eigen::Index columns, int threads,
                                     const std::function<Eigen::MatrixXd(std::size_t)>& known);

/// @param rows  of each condition at z
/// @param root  R with R R^T = (J^T J)^-1 on the directions that the data determine
KnownUncertainty known_uncertainty(const Problem& problem, std::span<const double> z,
                                   const std::vector<ConditionRows>& rows, const ArrowRoot& root,
                                   int threads);

/// Standard errors of the unknowns in the unit box by what differs between days: each date of the
/// conditions has deviations of its own. Zero where nothing differs.
///
/// @param rows  of each condition at z
/// @param root  R with R R^T = (J^T J)^-1 on the directions that the data determine
Eigen::VectorXd day_errors(const Problem& problem, std::span<const double> z,
                           const std::vector<ConditionRows>& rows, const ArrowRoot& root,
                           int threads);

}  // namespace rigcal::calib
