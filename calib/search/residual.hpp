#pragma once

#include <ceres/cost_function.h>
#include <ceres/sized_cost_function.h>

#include "calib/search/evaluator.hpp"

namespace rigcal::calib {

/// Residuals of one condition for Ceres: the R factor that the evaluator prepared. One parameter
/// block of size 1 per acting unknown, in that order. Borrows the evaluator.
class ConditionCost final : public ceres::CostFunction {
 public:
  ConditionCost(const Evaluator& evaluator, std::size_t condition, std::size_t acting)
      : evaluator_(evaluator), condition_(condition) {
    set_num_residuals(static_cast<int>(acting) + 1);
    mutable_parameter_block_sizes()->assign(acting, 1);
  }

  /// False where the condition could not be simulated: Ceres then shortens its step.
  bool Evaluate(double const* const* /*parameters*/, double* residuals,
                double** jacobians) const override {
    const ConditionEvaluation& prepared = evaluator_.prepared().conditions[condition_];
    if (!prepared.ok()) return false;
    const Eigen::Index rows = prepared.r_factor.rows();
    Eigen::Map<Eigen::VectorXd>(residuals, rows) = prepared.r_factor.col(rows - 1);
    if (jacobians == nullptr) return true;
    for (Eigen::Index j = 0; j + 1 < rows; ++j) {
      if (jacobians[j] != nullptr)
        Eigen::Map<Eigen::VectorXd>(jacobians[j], rows) = prepared.r_factor.col(j);
    }
    return true;
  }

 private:
  const Evaluator& evaluator_;
  std::size_t condition_;
};

/// (value - mean) / sd of one unknown, in physical units. Borrows the map.
class PriorCost final : public ceres::SizedCostFunction<1, 1> {
 public:
  PriorCost(const ParameterMap& map, int unknown, datasets::Prior prior)
      : map_(map), unknown_(unknown), prior_(prior) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const double z = parameters[0][0];
    residuals[0] = (map_.to_physical(unknown_, z) - prior_.mean) / prior_.sd;
    if (jacobians != nullptr && jacobians[0] != nullptr)
      jacobians[0][0] = map_.slope(unknown_, z) / prior_.sd;
    return true;
  }

 private:
  const ParameterMap& map_;
  int unknown_;
  datasets::Prior prior_;
};

}  // namespace rigcal::calib
