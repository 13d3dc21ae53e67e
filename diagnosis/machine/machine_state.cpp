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
/// If the disagreement is less probable than this, the error is widened.
constexpr double kDisagree = 0.05;

double square_of(double x) { return x * x; }

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
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n);
  const Eigen::VectorXd weighted = root.solve(ones);
  const Eigen::VectorXd weights = weighted / weighted.sum();

  PooledLeak pooled;
  pooled.coefficient = weights.dot(coefficients);
  pooled.rig_moves = moves.transpose() * weights;
  pooled.day_moves = day_moves.transpose() * weights;
  pooled.day_weights = Eigen::VectorXd::Zero(members.front().day_weights.size());
  for (Eigen::Index i = 0; i < n; ++i)
    pooled.day_weights += weights(i) * members[static_cast<std::size_t>(i)].day_weights;
  const Eigen::VectorXd left = coefficients - pooled.coefficient * ones;
  pooled.chi_squared = left.dot(root.solve(left));
  pooled.freedom = static_cast<double>(n - 1);
  if (n > 1) pooled.p = metrics::chi_squared_exceedance(pooled.chi_squared, pooled.freedom);
  pooled.agree = !(pooled.p < kDisagree);
  if (!pooled.agree) pooled.widened = std::max(1.0, std::sqrt(pooled.chi_squared / pooled.freedom));

  double variance = 0.0;
  double squares = 0.0;  // sum for the Welch-Satterthwaite formula
  for (Eigen::Index i = 0; i < n; ++i) {
    const double part = square_of(weights(i)) * own(i);
    variance += part;
    squares += square_of(part) / members[static_cast<std::size_t>(i)].freedom;
  }
  const double rig_variance =
      std::max(0.0, pooled.rig_moves.dot(rig_covariance * pooled.rig_moves));
  pooled.error.own_se = pooled.widened * std::sqrt(variance);
  for (Eigen::Index i = 0; i < n; ++i) {
    const StateMember& member = members[static_cast<std::size_t>(i)];
    pooled.error.own.push_back(
        {member.condition, "records", pooled.widened * std::abs(weights(i)) * member.own_se});
  }
  pooled.error.rig_se = pooled.widened * std::sqrt(rig_variance);
  const double days_variance = days.factor * pooled.day_moves.squaredNorm();
  squares += square_of(days_variance) / days.freedom;
  pooled.error.days_se = pooled.widened * std::sqrt(days_variance);
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
