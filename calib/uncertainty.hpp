#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib/evaluation.hpp"

namespace rigcal::calib {

/// How far the unknowns are determined at an optimum.
struct Uncertainty {
  /// SI; absent for an unknown that takes part in a combination which the data do not determine.
  std::vector<std::optional<double>> standard_error;
  /// The same from the scatter of the residuals themselves (see below).
  std::vector<std::optional<double>> robust_standard_error;
  std::vector<std::string> reason;  ///< in words, where there is no standard error
  Eigen::MatrixXd correlation;      ///< shape (unknowns)^2; meaningful where there are errors
  int rank = 0;
  std::vector<double> singular_values;  ///< of the Jacobian with columns of length 1, descending
  double reduced_chi_square = 0.0;      ///< 2 cost / (residuals - rank)
  double student_t = 0.0;               ///< 97.5 % quantile for that many degrees of freedom
};

/// Standard errors from the Gauss-Newton matrix, sigma^2 (J^T J)^-1, at all unknowns, those at a
/// bound included. sigma^2 is the larger of 1 (the noise is known) and the reduced chi-square (the
/// residuals are larger than the noise, so the model is wrong somewhere).
///
/// The robust ones are a sandwich, (J^T J)^-1 (sum over blocks of g g^T) (J^T J)^-1 with g = J^T r
/// of one twentieth of a condition: residuals that are correlated in time, as model errors are,
/// carry less information than their number says. Absent with no more blocks than unknowns.
///
/// @param optimum  an evaluation that is ok
Uncertainty uncertainty(const Problem& problem, const Evaluation& optimum, int threads);

}  // namespace rigcal::calib
