#include "calib/result/estimate_spread.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rigcal::calib {

Eigen::MatrixXd square_root(const Eigen::MatrixXd& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

double EffectSpread::size(std::string_view key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  return found == keys.end() ? 0.0 : root.row(found - keys.begin()).norm();
}

EffectSpread effect_spread(const Considered& considered,
                           const std::vector<const Budget95*>& budgets) {
  EffectSpread result;
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
  // In standard errors: sizes in SI span twelve decades.
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
