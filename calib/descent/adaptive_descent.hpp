#pragma once

#include <vector>

#include "calib/descent/descent.hpp"

namespace rigcal::calib {

/// Least squares in the unit box where residuals may be large: a trust region with two models of
/// the cost, J'J as Gauss and Newton have it and J'J + S, where S is what changes of the gradient
/// say of the second derivatives of the residuals. After each step the next one follows the model
/// that foresaw it better (NL2SOL: Dennis, Gay and Welsch, ACM Trans. Math. Softw. 7, 1981). Bounds
/// are met within a step (box_step()). Each trial point is evaluated once, with derivatives.
Descent descend_adaptively(const DescentOptions& options, std::vector<double>& z);

}  // namespace rigcal::calib
