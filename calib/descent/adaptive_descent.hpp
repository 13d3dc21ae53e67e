#pragma once

#include <vector>

#include "calib/descent/descent.hpp"

namespace rigcal::calib {

/// Solves a least-squares problem with large residuals in the unit box. The trust region has two
/// models of the cost: J'J (Gauss-Newton), and J'J + S, where S estimates the second derivatives of
/// the residuals from changes in the gradient. Each step uses the model that predicted the previous
/// step better (NL2SOL: Dennis, Gay and Welsch, ACM Trans. Math. Softw. 7, 1981). box_step() keeps
/// each step within the bounds. Each trial point is evaluated once, with derivatives.
Descent descend_adaptively(const DescentOptions& options, std::vector<double>& z);

}  // namespace rigcal::calib
