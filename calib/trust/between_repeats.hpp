#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/trust/cause_effects.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// Weighted deviations of the single repeats of a condition from their mean, shape (channels *
/// samples in windows, repeats); no columns if the record has no single repeats.
///
/// Shifting repeats onto one another hides that they began at different times. With a generated
/// drive the start of their mean is known only as well as the offsets scatter, so the shift of each
/// repeat is added to its deviation again.
///
/// @param explained  part that recorded inputs explain (repeat_inputs.hpp), or empty
Eigen::MatrixXd repeat_deviations(const ProblemCondition& condition,
                                  const Eigen::MatrixXd& explained);

/// Part of these deviations that declared parameters explain
/// (datasets::ParameterSetting::between_repeats), by their linear effect with their prior; shape of
/// `deviations`.
Eigen::MatrixXd explained_by_declared(const Problem& problem, std::size_t condition,
                                      std::span<const double> z, const Eigen::MatrixXd& deviations);

/// J^T of these deviations: shape (directions, repeats).
Eigen::MatrixXd repeat_scores(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& deviations);

/// Variance of a combination, with its degrees of freedom.
struct RepeatVariance {
  double variance = 0.0;
  double freedom = 0.0;
};

/// Variance c^T (covariance of the mean scores + priors) c from the differences between the
/// repeats. These include everything that differs between them, also if it is constant over a
/// record: supply pressure, oil, a drift. For R repeats with the deviations s_r the covariance of
/// the mean is sum s_r s_r^T / (R (R - 1)), with R - 1 degrees of freedom. Over the conditions
/// these add up by Satterthwaite (the cluster-robust covariance with repeats as clusters; Cameron
/// and Miller, Journal of Human Resources 50, 2015). A condition without single repeats adds its
/// `scatter`.
///
/// Zero degrees of freedom: no condition has single repeats.
RepeatVariance repeat_variance(const std::vector<Eigen::MatrixXd>& scores,
                               const std::vector<ScoreScatter>& scatter, const ArrowMatrix& priors,
                               const ArrowRoot& combinations, Eigen::Index unknown);

/// Whether repeats differ by so much more than the residuals predict that the interval must be
/// based on them: F of the two variances is beyond its upper quartile. A variance that is pooled or
/// chosen only after a significant difference at 5 % or 1 % covers too little in between. At 25 %
/// the coverage stays near its level for any true ratio (Bancroft and Han, International
/// Statistical Review 45, 1977; docs/uncertainty.md has the study).
bool rests_on_repeats(const RepeatVariance& repeats, const RobustVariance& robust);

/// Probability of such a ratio of variances, or a larger one, where repeats differ by their noise
/// alone.
double exceedance(const RepeatVariance& repeats, const RobustVariance& robust);

/// A cause that would make repeats differ as they do.
struct LikelyDifference {
  std::string cause;       ///< key of a parameter, or "start": when the run began
  double sd = 0.0;         ///< standard deviation between repeats: relative; in s for the start
  double explained = 0.0;  ///< share of the squared scores of the repeats, 0 to 1
  double p = 1.0;          ///< probability that noise alone causes it, see difference_by_noise()
};

/// The cause, of supply pressure, bulk modulus and start, whose scores explain most of those of the
/// repeats over all conditions; empty if none explains four fifths. A cause is not proven by that:
/// another one may act in the same way.
///
/// @param rows    as for score_scatter(), of all conditions
/// @param scores  of repeat_scores(), of all conditions
std::optional<LikelyDifference> likely_difference(CauseEffects& effects,
                                                  const std::vector<ScoreRows>& rows,
                                                  const std::vector<Eigen::MatrixXd>& scores);

/// Probability that noise alone makes repeats differ as much in the direction of a cause: F of the
/// deviations along it against those of twenty parts of the remaining deviations, over all
/// conditions. The fit of the model to the mean does not matter here; it does for the residuals
/// that rests_on_repeats() uses.
double difference_by_noise(CauseEffects& effects, const std::string& cause);

}  // namespace rigcal::calib
