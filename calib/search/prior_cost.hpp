#pragma once

#include <ceres/sized_cost_function.h>

#include "calib/problem/parameter_map.hpp"

namespace rigcal::calib {

/// Residual (value - mean) / sd of the prior on one unknown, in physical units. Borrows the map.
class PriorCost final : public ceres::SizedCostFunction<1, 1> {
 public:
  PriorCost(const ParameterMap& map, int unknown, datasets::Prior prior)
      : map_(map), unknown_(unknown), prior_(prior) {}

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    const double z = parameters[0][0];
    residuals[0] = prior_.residual(map_.to_physical(unknown_, z));
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
