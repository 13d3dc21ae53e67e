#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// Computes how parameters that may differ between repeats affect the outputs of every condition.
/// These are supply pressure and bulk modulus, if the plant has them and the campaign does not
/// declare them. Each condition is simulated only once, on the first request. The result is used
/// both to find likely causes and to test whether noise could look like one.
class CauseEffects {
 public:
  /// Borrows both arguments.
  CauseEffects(const Problem& problem, std::span<const double> z);

  const Problem& problem() const { return problem_; }
  /// Keys of the parameters.
  const std::vector<std::string>& causes() const { return causes_; }
  /// Returns the values of the causes in a condition, SI.
  std::vector<double> values(std::size_t condition) const;
  /// Returns the change in the weighted outputs per SI unit, shape (channels * scored samples,
  /// causes). Empty if the condition cannot be simulated.
  const Eigen::MatrixXd& of(std::size_t condition);
  /// Returns the component of the repeats' deviations that recorded inputs explain
  /// (repeat_inputs.hpp).
  Eigen::MatrixXd explained_by_inputs(std::size_t condition) const;

 private:
  const Problem& problem_;
  std::span<const double> z_;
  std::vector<int> indices_;  ///< rows of the plant's parameter table
  std::vector<std::string> causes_;
  /// One for each condition; absent until requested.
  std::vector<std::optional<Eigen::MatrixXd>> effects_;
};

/// Returns the weighted deviations of the single repeats of a condition from their mean, shape
/// (channels * samples in windows, repeats). There are no columns if the record has no single
/// repeats.
///
/// Aligning the repeats in time hides that they started at different times. With a generated drive,
/// the start of the mean is known only as precisely as the offsets of the repeats agree. The shift
/// of each repeat is therefore added back to its deviation.
///
/// @param explained  component that recorded inputs explain (repeat_inputs.hpp), or empty
Eigen::MatrixXd repeat_deviations(const ProblemCondition& condition,
                                  const Eigen::MatrixXd& explained);

/// Returns the component of the repeat deviations that declared parameters explain
/// (datasets::ParameterSetting::between_repeats), given their linear effects and their priors. It
/// has the shape of `deviations`.
Eigen::MatrixXd explained_by_declared(const Problem& problem, std::size_t condition,
                                      std::span<const double> z, const Eigen::MatrixXd& deviations);

/// Returns J^T times the deviations, minus the mean over the repeats. Shape (directions, repeats).
Eigen::MatrixXd repeat_scores(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& deviations);

/// Variance of a linear combination of unknowns, with its degrees of freedom.
struct RepeatVariance {
  double variance = 0.0;
  double freedom = 0.0;
};

/// Returns the variance c^T (covariance of the mean scores + priors) c, estimated from the
/// differences between repeats. These include everything that differs between repeats, even if it
/// is constant during a record, such as supply pressure, oil or drift. For R repeats with
/// deviations s_r the covariance of the mean is sum s_r s_r^T / (R (R - 1)), with R - 1 degrees of
/// freedom. The conditions are combined according to Satterthwaite. This is the cluster-robust
/// covariance with repeats as clusters (Cameron and Miller, Journal of Human Resources 50, 2015). A
/// condition without single repeats contributes its `scatter`.
///
/// The degrees of freedom are zero if no condition has single repeats.
RepeatVariance repeat_variance(const std::vector<Eigen::MatrixXd>& scores,
                               const std::vector<ScoreContribution>& scatter,
                               const ArrowMatrix& priors, const ArrowRoot& combinations,
                               Eigen::Index unknown);

/// Returns true if repeats differ so much more than the residuals predict that the interval must be
/// based on the repeats, that is, if the F ratio of the two variances is in its upper quartile.
/// Pooling or choosing a variance only after a significant difference at 5 % or 1 % would give too
/// little coverage for moderate ratios. At 25 % the coverage is close to its nominal level for any
/// true ratio (Bancroft and Han, International Statistical Review 45, 1977; docs/uncertainty.md has
/// the study).
bool rests_on_repeats(const RepeatVariance& repeats, const RobustVariance& robust);

/// Returns the probability of a variance ratio at least this large if the repeats differ only by
/// noise.
double exceedance(const RepeatVariance& repeats, const RobustVariance& robust);

/// A cause that could explain how the repeats differ.
struct LikelyDifference {
  std::string cause;  ///< key of a parameter, or "start" for the time at which the run began
  double sd = 0.0;    ///< standard deviation between repeats: relative, or in s for the start
  /// Fraction of the repeats' squared scores that the cause explains, 0 to 1.
  double explained = 0.0;
  double p = 1.0;  ///< from difference_by_noise()
};

/// Returns the cause (supply pressure, bulk modulus or start) whose scores best explain those of
/// the repeats over all conditions. Returns std::nullopt if no cause explains four fifths of them.
/// This does not prove the cause, because another one may have the same effect.
///
/// @param rows    as for score_contributions(), for all conditions
/// @param scores  from repeat_scores(), for all conditions
std::optional<LikelyDifference> likely_difference(CauseEffects& effects,
                                                  const std::vector<ScoreRows>& rows,
                                                  const std::vector<Eigen::MatrixXd>& scores);

/// Returns the probability that noise alone makes the repeats differ this much in the direction of
/// a cause. It is based on an F ratio over all conditions: the deviations along that direction are
/// compared with the remaining deviations, divided into twenty intervals. Unlike
/// rests_on_repeats(), which uses the residuals, this does not depend on how well the model fits
/// the mean.
double difference_by_noise(CauseEffects& effects, const std::string& cause);

}  // namespace rigcal::calib
