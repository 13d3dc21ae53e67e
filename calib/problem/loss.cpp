#include "calib/problem/loss.hpp"

#include <cmath>

namespace rigcal::calib {
namespace {

/// rho(s) / s and rho'(s) at s = r^2. Both are set to 1 at the origin, to avoid a division by zero.
struct Rho {
  double over_s = 1.0;
  double slope = 1.0;
};

Rho rho_of(datasets::Loss loss, double a, double s) {
  const double x = s / (a * a);
  switch (loss) {
    case datasets::Loss::squared:
      return {};
    case datasets::Loss::huber: {
      if (x <= 1.0) return {};
      const double root = std::sqrt(x);
      return {(2.0 * root - 1.0) / x, 1.0 / root};
    }
    case datasets::Loss::soft_l1: {
      const double root = std::sqrt(1.0 + x);
      return {2.0 / (root + 1.0), 1.0 / root};
    }
    case datasets::Loss::cauchy:
      return {x > 0.0 ? std::log1p(x) / x : 1.0, 1.0 / (1.0 + x)};
  }
  return {};
}

}  // namespace

LossValue apply_loss(datasets::Loss loss, double a, double r) {
  const Rho rho = rho_of(loss, a, r * r);
  const double root = std::sqrt(rho.over_s);
  // d/dr [sign(r) sqrt(rho(r^2))] = rho'(s) |r| / sqrt(rho(s))
  return {r * root, rho.slope / root};
}

}  // namespace rigcal::calib
