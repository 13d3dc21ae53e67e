#pragma once

#include "model/arithmetic/state.hpp"

namespace rigcal::model {

/// The solution within one step: a polynomial of degree four or less in s, which goes from 0 to 1
/// along the step.
template <int N, int P>
struct Interpolant {
  std::array<std::array<Active<P>, 5>, static_cast<std::size_t>(N)> coefficient;

  Active<P> operator()(std::size_t i, double s) const { return at(coefficient[i], s); }

  static Active<P> at(const std::array<Active<P>, 5>& c, double s) {
    return c[0] + (c[1] + (c[2] + (c[3] + c[4] * s) * s) * s) * s;
  }
};

}  // namespace rigcal::model
