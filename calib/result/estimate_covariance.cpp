#include "calib/result/estimate_covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rigcal::calib {

Eigen::MatrixXd square_root(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

bool are_correlations(const Eigen::MatrixXd& matrix) {
  constexpr double kRounding = 1e-6;
  std::vector<Eigen::Index> known;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    if (std::isfinite(matrix(i, i))) known.push_back(i);
  if (known.empty()) return true;
  const Eigen::MatrixXd part = matrix(known, known);
  if (!part.allFinite()) return true;
  const bool valid = (part - part.transpose()).cwiseAbs().maxCoeff() <= kRounding &&
                     (part.diagonal().array() - 1.0).abs().maxCoeff() <= kRounding &&
                     part.cwiseAbs().maxCoeff() <= 1.0 + kRounding;
  // Cholesky succeeds if no eigenvalue is below minus the shift. Computing all eigenvalues would
  // take minutes for the parameters of thousands of conditions.
  Eigen::MatrixXd shifted = part;
  shifted.diagonal().array() += kRounding * static_cast<double>(part.rows());
  return valid && Eigen::LLT<Eigen::MatrixXd>(shifted).info() == Eigen::Success;
}

Eigen::MatrixXd covariance_of(const std::vector<double>& errors,
                              const std::vector<std::optional<Eigen::Index>>& rows,
                              const Eigen::MatrixXd& correlations) {
  const auto n = static_cast<Eigen::Index>(errors.size());
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    covariance(at, at) = errors[i] * errors[i];
    for (std::size_t j = 0; rows[i] && j < errors.size(); ++j) {
      if (rows[j])
        covariance(at, static_cast<Eigen::Index>(j)) =
            correlations(*rows[i], *rows[j]) * errors[i] * errors[j];
    }
  }
  return covariance;
}

void add_own(std::vector<EstimateCovariance::Estimate> estimates, const std::vector<double>& errors,
             EstimateCovariance& joint) {
  const Eigen::MatrixXd& shared = joint.root;
  EstimateCovariance::Own& own = joint.own.emplace_back();
  own.estimates = std::move(estimates);
  const auto count = static_cast<Eigen::Index>(errors.size());
  own.root = Eigen::MatrixXd::Zero(count + shared.rows(), count + shared.cols());
  own.root.bottomRightCorner(shared.rows(), shared.cols()) = shared;
  for (Eigen::Index k = 0; k < count; ++k) own.root(k, k) = errors[static_cast<std::size_t>(k)];
}

Eigen::VectorXd variances_by_effect(const Eigen::VectorXd& moves,
                                    const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd along = covariance * moves;
  const double all = std::max(0.0, moves.dot(along));
  const Eigen::VectorXd parts = (moves.array() * along.array()).max(0.0);
  const double sum = parts.sum();
  return sum > 0.0 ? Eigen::VectorXd(parts * (all / sum)) : Eigen::VectorXd::Zero(moves.size());
}

double EffectCovariance::size(std::string_view key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? 0.0 : root.row(found - keys.begin()).norm();
}

EffectCovariance effect_covariance(const Considered& considered,
                                   const std::vector<const Budget95*>& budgets) {
  EffectCovariance result;
  const Eigen::MatrixXd& correlation = considered.correlation;
  const Eigen::Index count = std::min({correlation.rows(), correlation.cols(),
                                       static_cast<Eigen::Index>(considered.effects.size())});
  if (count == 0) return result;
  Eigen::VectorXd mean(count);
  Eigen::VectorXd error(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const ConsideredEffect& effect = considered.effects[static_cast<std::size_t>(k)];
    result.keys.push_back(effect.key);
    mean(k) = effect.estimate.value_or(0.0);
    error(k) = effect.standard_error.value_or(0.0);
  }
  // Sizes are scaled by their standard errors, because in SI units they span twelve decades.
  const Eigen::VectorXd scale =
      error.unaryExpr([](double sd) { return sd > 0.0 ? 1.0 / sd : 1.0; });
  const Eigen::VectorXd scaled = scale.cwiseProduct(mean);
  Eigen::MatrixXd moments = scaled * scaled.transpose();
  for (Eigen::Index k = 0; k < count; ++k) {
    for (Eigen::Index l = 0; l < count; ++l)
      if (error(k) > 0.0 && error(l) > 0.0)
        moments(k, l) += std::isfinite(correlation(k, l)) ? correlation(k, l) : k == l ? 1.0 : 0.0;
  }
  result.root = scale.cwiseInverse().asDiagonal() * square_root(moments);
  result.moves = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(budgets.size()), count);
  for (std::size_t j = 0; j < budgets.size(); ++j) {
    if (budgets[j] == nullptr) continue;
    for (const BudgetLine& line : budgets[j]->lines) {
      const auto found = std::find(result.keys.begin(), result.keys.end(), line.source);
      if (line.kind == "effect" && found != result.keys.end())
        result.moves(static_cast<Eigen::Index>(j), found - result.keys.begin()) =
            line.sensitivity.value_or(0.0);
    }
  }
  return result;
}

}  // namespace rigcal::calib
