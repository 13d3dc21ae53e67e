#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/problem/evaluation.hpp"

namespace rigcal::calib {

/// Known values with a stated uncertainty, and the effect of that uncertainty on the estimates. For
/// a parameter that is not fitted, the uncertainty comes from `prior` and `prior_sd`. For the gain
/// and offset of a compared channel's sensor, it comes from `gain_sd` and `offset_sd`.
struct KnownUncertainty {
  std::vector<std::string> names;
  /// First-order change in the unknowns (unit box) per standard deviation of each known value:
  /// -(J^T J)^-1 J^T J_known sd. Shape (unknowns, names).
  Eigen::MatrixXd response;
};

/// Returns the name, for messages and budgets, of the uncertainty stated in a sensor's certificate.
///
/// @param what  "gain" or "offset"
std::string certificate_name(std::string_view what, std::string_view channel);

/// Returns the names, for messages, of known values with a stated uncertainty.
std::vector<std::string> uncertain_names(const Problem& problem);

/// Returns the weighted sensitivities of one condition to parameters that are known in it, per SI
/// unit: shape (channels * scored samples, indices). Empty if the condition cannot be simulated.
///
/// @param indices  rows of the parameter table, none of them free in the condition
Eigen::MatrixXd known_sensitivities(const Problem& problem, std::size_t condition,
                                    std::span<const double> z, const std::vector<int>& indices);

/// Returns the change in the unknowns (unit box), -(J^T J)^-1 J^T K, when the weighted outputs of
/// each condition change by the columns of K. Shape (unknowns, columns).
///
/// @param known  returns K for a condition, shape (residuals, columns), or an empty matrix
Eigen::MatrixXd response_of_unknowns(const Problem& problem, const std::vector<ConditionRows>& rows,
                                     const ArrowRoot& root, Eigen::Index columns, int threads,
                                     const std::function<Eigen::MatrixXd(std::size_t)>& known);

/// @param rows  rows of each condition at z
/// @param root  R with R R^T = (J^T J)^-1 on the directions that the data determine
KnownUncertainty known_uncertainty(const Problem& problem, std::span<const double> z,
                                   const std::vector<ConditionRows>& rows, const ArrowRoot& root,
                                   int threads);

/// Returns the standard errors of the unknowns (unit box) due to day-to-day differences. All
/// conditions recorded on the same date share the same deviations. The errors are zero if no
/// quantity differs between days.
///
/// @param rows  rows of each condition at z
/// @param root  R with R R^T = (J^T J)^-1 on the directions that the data determine
Eigen::VectorXd day_errors(const Problem& problem, std::span<const double> z,
                           const std::vector<ConditionRows>& rows, const ArrowRoot& root,
                           int threads);

}  // namespace rigcal::calib
