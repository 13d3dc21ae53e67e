#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/describe.hpp"
#include "diagnosis/record/leak_estimate.hpp"
#include "diagnosis/record/leak_fit.hpp"
#include "diagnosis/record/stated_leak.hpp"
#include "metrics/significance.hpp"

namespace rigcal::diagnosis {

/// One machine in one state, identified by leak level, specimen and date.
struct StateKey {
  std::optional<std::string> leak_level;  ///< id of a condition with neither leak level nor date
  std::optional<std::string> specimen, date;
  RIGCAL_DESCRIBE(leak_level, specimen, date)

  bool operator==(const StateKey&) const = default;
  std::string name() const;  ///< "66.66 %, specimen B, 2026-03-01"
};
StateKey state_of(const datasets::Condition& condition);

/// Contribution of the average of one condition to the state.
struct StateMember {
  std::string condition;
  std::string signal;
  double coefficient = 0.0;
  double own_se = 0.0;  ///< standard error without the contribution of the rig's parameters
  double freedom = 1.0;
  Eigen::VectorXd rig_moves;    ///< see LeakFit::rig_moves
  Eigen::VectorXd day_effects;  ///< see LeakFit::day_effects
  Eigen::VectorXd day_weights;  ///< one per day, see DayWeights::difference()

  /// Returns the change in the coefficient with each quantity on each day, shape (days *
  /// quantities).
  Eigen::VectorXd day_moves() const;
};

/// Variance between days, relative to the squares of the sizes of the quantities.
struct DayVariance {
  double factor = 0.0;
  double freedom = metrics::kManyDegrees;
};

/// Test of whether the signals recorded in one state give the same leak.
struct SignalsAgreement {
  double p = 1.0;            ///< probability that errors alone cause such a disagreement
  double chi_squared = 0.0;  ///< measure of the disagreement between members
  double freedom = 0.0;      ///< number of members - 1
  double widened = 1.0;      ///< factor on the error of the records, above 1 if members disagree
  bool agree = true;         ///< false if the disagreement is significant at 5 %
  RIGCAL_DESCRIBE(p, chi_squared, freedom, widened, agree)
};

/// The leak that all members have in common.
struct PooledLeak : SignalsAgreement {
  double coefficient = 0.0;
  CoefficientError error;       ///< includes a disagreement of the members
  Eigen::VectorXd rig_moves;    ///< change in the pooled coefficient
  Eigen::VectorXd day_moves;    ///< change in the pooled coefficient with each quantity on each day
  Eigen::VectorXd day_weights;  ///< one per day
};

/// Pools members by generalised least squares. Each member has its own error. In addition, a common
/// error due to the rig's parameters and day-to-day differences shifts all of them together. If the
/// members disagree by more than their errors, each has a further error, which makes chi-square
/// equal to its degrees of freedom (Mandel and Paule), because it is not known which of them is
/// wrong. The pooled coefficient is then close to their plain mean. Without that error, common
/// errors that act on the members to different degrees could put it beyond all of them.
///
/// @param members         at least one; each with own_se > 0
/// @param rig_covariance  covariance of the rig's parameters, shape (rig_moves)^2
PooledLeak pooled_leak(const std::vector<StateMember>& members,
                       const Eigen::MatrixXd& rig_covariance, const DayVariance& days = {});

/// Position of a share relative to the limits of the classes.
struct LimitDistance {
  LeakClass class_ = LeakClass::normal;  ///< the class that begins at the limit
  double percent = 0.0;
  double distance_percentage_points = 0.0;  ///< share minus the limit
  /// True if the interval includes the limit, or the share is within 5 % of it.
  bool on_limit = false;
  RIGCAL_DESCRIBE(class_, percent, distance_percentage_points, on_limit)
};
LimitDistance nearest_limit(const LeakEstimate& estimate,
                            const datasets::DiagnosisSettings& settings);

/// Verdict on one state, based on the averages of its conditions.
struct MachineState {
  std::string state;  ///< name of the key
  Inlined<StateKey> key;
  std::string sentence;                ///< for an operator
  std::optional<std::string> failure;  ///< why there is no verdict
  /// True if every signal is its own healthy reference, so that the leak is zero by construction.
  bool is_reference = false;
  std::vector<std::string> conditions;
  std::vector<std::string> left_out;  ///< conditions that were left out, with reasons in words
  Inlined<StatedLeak> leak;           ///< at the duty
  /// Coefficient times leakage area; absent if the leak is laminar.
  std::optional<double> leak_area_m2;
  std::optional<Range> leak_area_ci95_m2;
  std::optional<std::string> duty;  ///< signal to which the leak share refers
  std::optional<LimitDistance> nearest_limit;
  std::optional<SignalsAgreement> agreement;  ///< absent for a single signal
  RIGCAL_DESCRIBE(state, key, sentence, failure, is_reference, conditions, left_out, leak,
                  leak_area_m2, leak_area_ci95_m2, duty, nearest_limit, agreement)

  // From what the verdict follows; not stored. Meaningless if there is a failure.
  std::vector<StateMember> members;
  PooledLeak pooled;
  LeakEstimate estimate;     ///< leak at the duty
  double share_slope = 0.0;  ///< d share / d coefficient at the duty
  bool ok() const { return !failure && !is_reference && !members.empty(); }
};

}  // namespace rigcal::diagnosis
