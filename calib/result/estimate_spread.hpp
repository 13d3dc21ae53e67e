#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/result/considered.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// What a fit knows of the small effects that its model leaves out: how large they may be, and what
/// it has mistaken for a change of its estimates. Bands, scores, leaks and comparisons all read it.
struct EffectSpread {
  std::vector<std::string> keys;
  /// S with S S^T the second moments of their sizes about zero, SI, since nothing is corrected for
  /// them. Shape (effects, columns).
  Eigen::MatrixXd root;
  /// Change of the estimates per unit of size, SI. Shape (estimates, effects).
  Eigen::MatrixXd moves;

  bool empty() const { return keys.empty(); }
  /// Root of the second moment of one, SI; 0 for an effect that is not among them.
  double size(std::string_view key) const;
};

/// The effects that a fit considered, as prior and records leave them.
///
/// @param budgets  of the estimates, in their order; null where there is none
EffectSpread effect_spread(const Considered& considered,
                           const std::vector<const Budget95*>& budgets);

/// Joint covariance of the estimates of a fit, for predictions.
struct EstimateSpread {
  /// One estimate, by which a condition finds those that act in it.
  struct Estimate {
    int index = 0;  ///< row of the plant's parameter table
    datasets::Scope scope = datasets::Scope::rig;
    std::string level;
  };
  /// Estimates that one condition has for itself.
  struct Own {
    std::vector<Estimate> estimates;
    /// S of their covariance with `estimates`, which come after them; shape (both, columns).
    Eigen::MatrixXd root;
  };

  std::vector<Estimate> estimates;
  /// S with S S^T their covariance, SI. Shape (estimates, columns).
  Eigen::MatrixXd root;
  /// Where there are many of them: no simulation knows those of two conditions.
  std::vector<Own> own = {};
  EffectSpread effects = {};  ///< moves: of `estimates`
  /// Dates of the fitted records; empty if one of them has none.
  std::vector<std::string> dates = {};
};

/// Whether numbers are correlations: from -1 to 1, the same on both sides of a diagonal of ones, by
/// which no combination of estimates has a negative variance. Rows whose diagonal is NaN do not
/// count, and where another number is missing nothing is said.
bool are_correlations(const Eigen::MatrixXd& matrix);

/// Covariance of estimates; NaN where a correlation is missing.
///
/// @param errors  standard errors
/// @param rows    rows of `correlations`; absent: correlated with nothing
Eigen::MatrixXd covariance_of(const std::vector<double>& errors,
                              const std::vector<std::optional<Eigen::Index>>& rows,
                              const Eigen::MatrixXd& correlations);

/// Adds estimates that a condition has for itself, correlated with nothing.
///
/// @param errors  standard errors, shape (estimates)
void add_own(std::vector<EstimateSpread::Estimate> estimates, const std::vector<double>& errors,
             EstimateSpread& spread);

/// R with R R^T = M, of a positive semidefinite matrix that rounding may have left without.
Eigen::MatrixXd square_root(const Eigen::MatrixXd& m);

}  // namespace rigcal::calib
