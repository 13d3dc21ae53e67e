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

/// How thoroughly the end of a search is examined.
enum class Detail {
  full,
  /// Skips everything that needs further simulations, or another pass over all residuals: for a
  /// point that is no minimum, while the user waits for the end.
  plain,
};

/// Uncertainty of the unknowns at an optimum.
struct Uncertainty {
  Detail detail = Detail::full;
  /// SI; absent for an unknown that takes part in a combination which the data do not determine.
  std::vector<std::optional<double>> standard_error;
  /// The same from the residuals themselves (see below), with its degrees of freedom and the half
  /// width of its 95 % interval in units of it.
  std::vector<std::optional<double>> robust_standard_error;
  std::vector<double> robust_freedom, robust_quantile;
  /// Whether the robust error of an unknown comes from the differences between the repeats, its
  /// ratio to the error from the residuals (0: unknown), and the probability of such a ratio if
  /// repeats differ only by noise.
  std::vector<bool> from_repeats;
  std::vector<double> repeats_ratio, repeats_p;
  std::optional<LikelyDifference> difference;  ///< if they differ by more than their noise
  int noiseless = 0;  ///< channels of conditions whose residual is no noise, see coherent_error.hpp
  std::vector<std::string> reason;  ///< in words, where there is no standard error
  int rank = 0;
  std::vector<double> singular_values;  ///< Jacobian with columns of length 1, descending
  double reduced_chi_square = 0.0;      ///< 2 cost / (residuals - rank)
  double freedom = 1.0;                 ///< degrees of freedom of standard_error, at least 1
  /// S with S S^T the covariance in the unit box; directions that the data do not determine have
  /// the least singular value that would count.
  ArrowRoot spread;
  /// R with R R^T = (J^T J)^-1 on the directions that the data determine; `scatter` is in its
  /// coordinates.
  ArrowRoot root;
  KnownUncertainty known;  ///< is in all errors
  /// By what differs between days (day_errors()), SI; in no error. Empty with Detail::plain.
  std::vector<double> between_days;
  std::vector<ScoreRows> scores;       ///< that `scatter` is made of
  std::vector<ScoreScatter> scatter;   ///< per condition; empty: no robust errors
  double independent_residuals = 0.0;  ///< sum over all conditions and channels

  /// Whether repeats differ by more than the residuals predict, at 5 % for all unknowns together
  /// (Bonferroni).
  bool repeats_differ() const;
  /// Correlation of two unknowns; meaningful where both have errors.
  double correlation(Eigen::Index a, Eigen::Index b) const;
};

/// Adds J^T J of the priors, in coordinates of `root`.
void add_prior_information(const Problem& problem, std::span<const double> z, const ArrowRoot& root,
                           ArrowMatrix& sum);

/// Scores of the single repeats of every condition, by rows whose residuals are left alone.
std::vector<Eigen::MatrixXd> scores_of_repeats(const Problem& problem, std::span<const double> z,
                                               const std::vector<ScoreRows>& rows, int threads);

/// Standard errors from the Gauss-Newton matrix, sigma^2 (J^T J)^-1, at all unknowns, those at a
/// bound included. sigma^2 is the larger of 1 (the noise is known) and the reduced chi-square (the
/// residuals are larger than the noise, so the model is wrong somewhere).
///
/// The robust ones are the sandwich (J^T J)^-1 (covariance of J^T r) (J^T J)^-1 of score_scatter():
/// residuals that are correlated in time, as model errors are, carry less information than their
/// number suggests. They are absent without degrees of freedom. If repeats differ by more than the
/// residuals of their mean predict, the covariance of their scores is used (between_repeats.hpp).
/// If the residuals have no noise, neither error is below that of errors of model and solver
/// (coherent_error.hpp).
///
/// @param optimum  an evaluation that is ok
/// @param rows     all its rows, per condition; no longer needed by the caller
/// @param detail   plain: no robust errors, and no differences between repeats
Uncertainty uncertainty(const Problem& problem, const Evaluation& optimum,
                        std::vector<ConditionRows> rows, int threads, Detail detail = Detail::full);

}  // namespace rigcal::calib
