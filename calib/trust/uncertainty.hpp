#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/evaluation.hpp"
#include "calib/trust/between_repeats.hpp"
#include "calib/trust/known_uncertainty.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// How thoroughly the end point of a search is examined.
enum class Detail {
  full,
  /// Skips everything that needs further simulations or another pass over all residuals. Used for a
  /// point that is not a minimum when the user is waiting for the job to end.
  plain,
};

/// Uncertainty of the unknowns at an optimum.
struct Uncertainty {
  Detail detail = Detail::full;
  /// Standard errors in SI units; absent if the unknown contributes to a combination that the data
  /// do not determine.
  std::vector<std::optional<double>> standard_error;
  /// Standard error estimated from the residuals themselves (see below), with its degrees of
  /// freedom and the half-width of the 95 % interval in units of this error.
  std::vector<std::optional<double>> robust_standard_error;
  std::vector<double> robust_freedom, robust_quantile;
  /// Whether the robust error of an unknown comes from the differences between repeats, the ratio
  /// of that error to the error from the residuals (0 if unknown), and the probability of such a
  /// ratio if the repeats differ only by noise.
  std::vector<bool> from_repeats;
  std::vector<double> repeats_ratio, repeats_p;
  /// Present if the repeats differ by more than their noise.
  std::optional<LikelyDifference> difference;
  int noiseless = 0;  ///< number of channels whose residual is not noise, see coherent_error.hpp
  std::vector<std::string> reason;  ///< why there is no standard error, in words
  int rank = 0;
  std::vector<double> singular_values;  ///< in descending order, for columns scaled to length 1
  double reduced_chi_square = 0.0;      ///< 2 cost / (residuals - rank)
  double freedom = 1.0;                 ///< degrees of freedom of standard_error, at least 1
  /// S, where S S^T is the covariance in the unit box. For directions that the data do not
  /// determine, the smallest singular value that still counts is used.
  ArrowRoot covariance_root;
  /// R, where R R^T = (J^T J)^-1 on the directions that the data determine. `scatter` is in its
  /// coordinates.
  ArrowRoot root;
  KnownUncertainty known;  ///< included in all errors
  /// Standard errors due to day-to-day differences (day_errors()), SI; not included in any other
  /// error. Empty with Detail::plain.
  std::vector<double> between_days;
  std::vector<ScoreRows> scores;  ///< rows from which `scatter` was computed
  std::vector<ScoreContribution>
      scatter;                         ///< one per condition; empty if there are no robust errors
  double independent_residuals = 0.0;  ///< sum over all conditions and channels

  /// Returns true if the repeats differ by more than the residuals predict, at 5 % for all unknowns
  /// together (Bonferroni).
  bool repeats_differ() const;
  /// Returns the correlation of two unknowns; meaningful only if both have errors.
  double correlation(Eigen::Index a, Eigen::Index b) const;
};

/// Adds J^T J of the priors in the coordinates of `root`.
void add_prior_information(const Problem& problem, std::span<const double> z, const ArrowRoot& root,
                           ArrowMatrix& sum);

/// Returns the scores of the single repeats of every condition. Only the Jacobian of `rows` is
/// used.
std::vector<Eigen::MatrixXd> scores_of_repeats(const Problem& problem, std::span<const double> z,
                                               const std::vector<ScoreRows>& rows, int threads);

/// Computes standard errors from the Gauss-Newton matrix, sigma^2 (J^T J)^-1, for all unknowns,
/// including those at a bound. sigma^2 is 1, because the noise is known, or the reduced chi-square
/// if that is larger, because the model must then be wrong somewhere.
///
/// The robust errors are the sandwich (J^T J)^-1 (covariance of J^T r) (J^T J)^-1 from
/// score_contributions(): residuals that are correlated in time, such as model errors, contain less
/// information than their number suggests. There are no robust errors without degrees of freedom.
/// If repeats differ by more than the residuals of their mean predict, the covariance of their
/// scores is used instead (between_repeats.hpp). If the residuals contain no noise, both errors are
/// at least as large as the errors due to model and solver (coherent_error.hpp).
///
/// @param optimum  an evaluation with status ok
/// @param rows     all rows for each condition; consumed by the call
/// @param detail   plain: no robust errors, and no differences between repeats
Uncertainty uncertainty(const Problem& problem, const Evaluation& optimum,
                        std::vector<ConditionRows> rows, int threads, Detail detail = Detail::full);

}  // namespace rigcal::calib
