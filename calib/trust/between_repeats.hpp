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
/// samples that count, repeats); no columns where the record holds no single repeats.
///
/// Repeats that were shifted onto one another hide that they began at different times. Where the
/// drive is generated, how late their mean began is not known any better than the scatter of the
/// offsets tells, so what each was shifted by is part of its deviation again.
///
/// @param explained  what recorded inputs explain of it (repeat_inputs.hpp), or empty
Eigen::MatrixXd repeat_deviations(const ProblemCondition& condition,
                                  const Eigen::MatrixXd& explained);

/// What parameters that the campaign declares to differ between repeats
/// (datasets::ParameterSetting::between_repeats) explain of these deviations, by their linear
/// effect with their prior; shape of `deviations`.
Eigen::MatrixXd explained_by_declared(const Problem& problem, std::size_t condition,
                                      std::span<const double> z, const Eigen::MatrixXd& deviations);

/// J^T of these deviations: shape (directions, repeats).
Eigen::MatrixXd repeat_scores(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& deviations);

/// Variance of a combination, and the degrees of freedom with which it is known.
struct RepeatVariance {
  double variance = 0.0;
  double freedom = 0.0;
};

/// Variance c^T (covariance of the mean scores + priors) c by the spread of the repeats, which
/// holds whatever differs between them, also what is the same over a whole record: the supply
/// pressure, the oil, a drift. Of R repeats with the deviations s_r the covariance of the mean is
/// sum s_r s_r^T / (R (R - 1)), with R - 1 degrees of freedom; these add up by Satterthwaite over
/// the conditions (the cluster-robust covariance with repeats as clusters; Cameron and Miller,
/// Journal of Human Resources 50, 2015). A condition without single repeats adds its `scatter`.
///
/// Freedom 0: no condition has single repeats.
RepeatVariance repeat_variance(const std::vector<Eigen::MatrixXd>& scores,
                               const std::vector<ScoreScatter>& scatter, const ArrowMatrix& priors,
                               const ArrowRoot& combinations, Eigen::Index unknown);

/// Whether repeats differ by so much more than the residuals tell that the interval has to rest on
/// them: F of the two variances beyond its upper quartile. A variance that is pooled, or chosen,
/// only where they differ significantly at 5 % or 1 % covers too little between the two; at 25 %
/// the coverage stays near its level whatever the true ratio is (Bancroft and Han, International
/// Statistical Review 45, 1977; docs/uncertainty.md has the study).
bool rests_on_repeats(const RepeatVariance& repeats, const RobustVariance& robust);

/// Probability of such a ratio of variances, or a larger one, where repeats differ by their noise
/// alone.
double exceedance(const RepeatVariance& repeats, const RobustVariance& robust);

/// A cause that would make repeats differ as they do.
struct LikelyDifference {
  std::string cause;       ///< key of a parameter, or "start": when the run began
  double sd = 0.0;         ///< of it between repeats: relative, of the start in s
  double explained = 0.0;  ///< share of the squared scores of the repeats, 0 to 1
  double p = 1.0;          ///< of such a difference by noise alone, see difference_by_noise()
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

/// Probability that repeats differ in the direction of a cause as much as they do by their own
/// noise: F of the deviations along it against those of twenty stretches of what is left of them,
/// over all conditions. Whether the mean fits the model does not matter here, as it does for the
/// residuals against which rests_on_repeats() holds the repeats.
double difference_by_noise(CauseEffects& effects, const std::string& cause);

}  // namespace rigcal::calib
