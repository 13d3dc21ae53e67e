#include "diagnosis/machine/machine_state.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

/// A share within this fraction of a limit counts as being on it.
constexpr double kOnLimit = 0.05;
/// If the disagreement is less probable than this, a variance between the members is added.
constexpr double kDisagree = 0.05;

double square_of(double x) { return x * x; }

struct WeightedMean {
  Eigen::VectorXd weights;  ///< they sum to one
  double value = 0.0;
  double chi_squared = 0.0;
};

/// Returns the mean by generalised least squares.
WeightedMean weighted_mean(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance) {
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(values.size());
  const Eigen::VectorXd weighted = root.solve(ones);
  WeightedMean mean;
  mean.weights = weighted / weighted.sum();
  mean.value = mean.weights.dot(values);
  const Eigen::VectorXd left = values - mean.value * ones;
  mean.chi_squared = left.dot(root.solve(left));
  return mean;
}

/// Returns the variance between members that makes chi-square equal to its degrees of freedom
/// (Mandel and Paule, Anal. Chem. 42, 1970).
double variance_between(const Eigen::VectorXd& values, const Eigen::MatrixXd& covariance) {
  const auto n = values.size();
  const auto freedom = static_cast<double>(n - 1);
  // At the sample variance, chi-square is at most its degrees of freedom, whatever the covariance.
  double low = 0.0;
  double high = (values.array() - values.mean()).square().sum() / freedom;
  constexpr int kHalvings = 60;  // beyond the precision of a double
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    const Eigen::MatrixXd wider = covariance + middle * Eigen::MatrixXd::Identity(n, n);
    (weighted_mean(values, wider).chi_squared > freedom ? low : high) = middle;
  }
  return high;
}

}  // namespace

StateKey state_of(const datasets::Condition& condition) {
  const bool is_named = condition.leak_level || condition.date;
  return {is_named ? condition.leak_level : condition.id, condition.specimen, condition.date};
}

std::string StateKey::name() const {
  std::string text = leak_level.value_or("");
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (specimen) add("specimen " + *specimen);
  if (date) add(*date);
  return text;
}

Eigen::VectorXd StateMember::day_moves() const {
  Eigen::VectorXd moves(day_weights.size() * day_effects.size());
  for (Eigen::Index day = 0; day < day_weights.size(); ++day)
    moves.segment(day * day_effects.size(), day_effects.size()) = day_weights(day) * day_effects;
  return moves;
}

PooledLeak pooled_leak(const std::vector<StateMember>& members,
                       const Eigen::MatrixXd& rig_covariance, const DayVariance& days) {
  if (members.empty()) throw std::invalid_argument("pooled_leak: expected a member");
  const auto n = static_cast<Eigen::Index>(members.size());
  const Eigen::Index rig = rig_covariance.rows();
  Eigen::VectorXd coefficients(n);
  Eigen::VectorXd own(n);
  Eigen::MatrixXd moves(n, rig);
  Eigen::MatrixXd day_moves(n, members.front().day_moves().size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const StateMember& member = members[static_cast<std::size_t>(i)];
    if (!(member.own_se > 0.0)) throw std::invalid_argument("pooled_leak: a member without error");
    coefficients(i) = member.coefficient;
    own(i) = square_of(member.own_se);
    if (rig > 0) moves.row(i) = member.rig_moves.transpose();
    day_moves.row(i) = member.day_moves().transpose();
  }
  Eigen::MatrixXd covariance =
      moves * rig_covariance * moves.transpose() + days.factor * day_moves * day_moves.transpose();
  covariance.diagonal() += own;
  WeightedMean mean = weighted_mean(coefficients, covariance);

  PooledLeak pooled;
  pooled.chi_squared = mean.chi_squared;
  pooled.freedom = static_cast<double>(n - 1);
  if (n > 1) pooled.p = metrics::chi_squared_exceedance(pooled.chi_squared, pooled.freedom);
  pooled.agree = !(pooled.p < kDisagree);
  double between = 0.0;
  if (!pooled.agree) {
    between = variance_between(coefficients, covariance);
    covariance.diagonal().array() += between;
    mean = weighted_mean(coefficients, covariance);
  }
  const Eigen::VectorXd& weights = mean.weights;
  pooled.coefficient = mean.value;
  pooled.rig_moves = moves.transpose() * weights;
  pooled.day_moves = day_moves.transpose() * weights;
  pooled.day_weights = Eigen::VectorXd::Zero(members.front().day_weights.size());
  for (Eigen::Index i = 0; i < n; ++i)
    pooled.day_weights += weights(i) * members[static_cast<std::size_t>(i)].day_weights;

  double variance = 0.0;
  double squares = 0.0;  // sum for the Welch-Satterthwaite formula
  for (Eigen::Index i = 0; i < n; ++i) {
    const double part = square_of(weights(i)) * own(i);
    variance += part;
    squares += square_of(part) / members[static_cast<std::size_t>(i)].freedom;
  }
  const double between_variance = between * weights.squaredNorm();
  if (between > 0.0) squares += square_of(between_variance) / pooled.freedom;
  pooled.widened = std::sqrt((variance + between_variance) / variance);
  variance += between_variance;
  const double rig_variance =
      std::max(0.0, pooled.rig_moves.dot(rig_covariance * pooled.rig_moves));
  pooled.error.own_se = std::sqrt(variance);
  for (Eigen::Index i = 0; i < n; ++i) {
    const StateMember& member = members[static_cast<std::size_t>(i)];
    pooled.error.own.push_back(
        {member.condition, "records", std::abs(weights(i)) * std::sqrt(own(i) + between)});
  }
  pooled.error.rig_se = std::sqrt(rig_variance);
  const double days_variance = days.factor * pooled.day_moves.squaredNorm();
  squares += square_of(days_variance) / days.freedom;
  pooled.error.days_se = std::sqrt(days_variance);
  pooled.error.freedom =
      std::clamp(square_of(variance + rig_variance + days_variance) / squares, 1.0, 1e6);
  return pooled;
}

LimitDistance nearest_limit(const LeakEstimate& estimate,
                            const datasets::DiagnosisSettings& settings) {
  const double share = estimate.share;
  std::size_t best = 0;
  for (std::size_t i = 1; i < settings.limits.size(); ++i) {
    if (std::abs(share - settings.limits[i]) < std::abs(share - settings.limits[best])) best = i;
  }
  const double limit = settings.limits[best];
  const bool within = estimate.share_ci95.low <= limit && limit <= estimate.share_ci95.high;
  return {datasets::kLeakClasses[best + 1], 100.0 * limit, 100.0 * (share - limit),
          within || std::abs(share - limit) <= kOnLimit * limit};
}

}  // namespace rigcal::diagnosis
