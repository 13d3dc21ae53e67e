#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/considered.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// The small effects that the model of a fit omits: their possible sizes, and how they bias the
/// estimates. Prediction bands, scores, leak estimates and comparisons all use this.
struct EffectCovariance {
  std::vector<std::string> keys;
  /// S, where S S^T contains the second moments of the effects' sizes about zero, SI. These are not
  /// central moments, because no estimate is corrected for the effects. Shape (effects, columns).
  Eigen::MatrixXd root;
  /// Change in the estimates per unit of an effect's size, SI. Shape (estimates, effects).
  Eigen::MatrixXd moves;

  bool empty() const { return keys.empty(); }
  /// Root of the second moment of an effect's size, SI; 0 for a key that is not in `keys`.
  double size(std::string_view key) const;
};

/// Returns the effects that a fit considered, with their sizes given prior and records.
///
/// @param budgets  one per estimate, in order; null for an estimate without a budget
EffectCovariance effect_covariance(const Considered& considered,
                                   const std::vector<const Budget95*>& budgets);

/// Returns the variance that each effect contributes to a result; they add up to moves^T C moves.
/// If the records cannot separate some effects, their joint contribution is divided in proportion
/// to their terms.
///
/// @param moves       change in the result per unit of each effect's size
/// @param covariance  C, the second moments of these sizes
Eigen::VectorXd variances_by_effect(const Eigen::VectorXd& moves,
                                    const Eigen::MatrixXd& covariance);

/// Joint covariance of the estimates of a fit, for predictions.
struct EstimateCovariance {
  /// Identifies one estimate, so that a condition can find those that apply to it.
  struct Estimate {
    int index = 0;  ///< row of the plant's parameter table
    datasets::Scope scope = datasets::Scope::rig;
    std::string level;
  };
  /// Estimates that apply to one condition only.
  struct Own {
    std::vector<Estimate> estimates;
    /// S, where S S^T is the joint covariance of these estimates followed by the shared ones, SI.
    /// Shape (own and shared estimates, columns).
    Eigen::MatrixXd root;
  };

  std::vector<Estimate> estimates;
  /// S, where S S^T is the covariance of the estimates, SI. Shape (estimates, columns).
  Eigen::MatrixXd root;
  /// One entry per condition with estimates of its own. They are stored separately because there
  /// may be many, and no simulation needs those of more than one condition.
  std::vector<Own> own = {};
  EffectCovariance effects = {};  ///< whose `moves` refer to `estimates`
  /// Dates of the fitted records; empty if any record has no date.
  std::vector<std::string> dates = {};
};

/// Returns true if a matrix is a correlation matrix: symmetric, with ones on the diagonal, entries
/// from -1 to 1, and positive semidefinite. Ignores rows whose diagonal is NaN. Also returns true
/// if any other entry is not finite, because the matrix then cannot be checked.
bool are_correlations(const Eigen::MatrixXd& matrix);

/// Computes the covariance of estimates. An element is NaN if its correlation is missing.
///
/// @param errors  standard errors
/// @param rows    row of each estimate in `correlations`; absent for an uncorrelated estimate
Eigen::MatrixXd covariance_of(const std::vector<double>& errors,
                              const std::vector<std::optional<Eigen::Index>>& rows,
                              const Eigen::MatrixXd& correlations);

/// Adds estimates that apply to one condition only and are uncorrelated with all others.
///
/// @param errors  standard errors, shape (estimates)
void add_own(std::vector<EstimateCovariance::Estimate> estimates, const std::vector<double>& errors,
             EstimateCovariance& joint);

/// Returns R with R R^T = M for a positive semidefinite M. Eigenvalues that are negative due to
/// rounding count as zero.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& m);

/// What the records say about the sizes e of the considered effects, linear about the optimum. All
/// sizes are multiples of the plausible size, with the prior N(0, 1), truncated at zero for an
/// effect that cannot be negative. The effects change the weighted outputs by E e = B C e + Q F e:
/// B are the rows of the directions that move the estimates, Q those of the directions beside them.
struct EffectLikelihood {
  std::vector<std::string> keys;
  std::vector<bool> one_sided;
  Eigen::MatrixXd taken;                ///< C, shape (directions of the root, effects)
  Eigen::MatrixXd felt;                 ///< F, shape (columns of Q, effects)
  Eigen::MatrixXd covariance;           ///< W, covariance of Q^T r
  std::vector<Eigen::MatrixXf> beside;  ///< Q, rows of each condition
  Eigen::VectorXd mean;                 ///< sizes from prior and records, truncated at zero
};

}  // namespace rigcal::calib
