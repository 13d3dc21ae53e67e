#pragma once

#include "datasets/campaign/campaign.hpp"

namespace rigcal::calib {

/// A residual to which the loss has been applied, and its derivative with respect to the original
/// residual.
struct LossValue {
  double residual = 0.0;
  double slope = 1.0;
};

/// Turns a loss rho into an ordinary least-squares residual: sign(r) sqrt(rho(r^2)), so that half
/// its square is exactly the robust cost, and cost, gradient and trust region need no special case.
///
///   squared  rho(s) = s
///   huber    s for s <= a^2, else 2 a sqrt(s) - a^2
///   soft_l1  2 a^2 (sqrt(1 + s / a^2) - 1)
///   cauchy   a^2 ln(1 + s / a^2)
///
/// @param r  weighted residual, in standard deviations
/// @param a  scale of the loss, in standard deviations, > 0
LossValue apply_loss(datasets::Loss loss, double a, double r);

}  // namespace rigcal::calib
