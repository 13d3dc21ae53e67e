#include "model/arithmetic/inverse.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>

using rigcal::model::inverse_of;

namespace {

/// Largest element of A A^-1 - 1.
template <int N>
double residual(const Eigen::Matrix<double, N, N>& matrix) {
  return (matrix.lazyProduct(inverse_of(matrix)) - Eigen::Matrix<double, N, N>::Identity())
      .cwiseAbs()
      .maxCoeff();
}

template <int N>
void check_random() {
  for (int seed = 0; seed < 20; ++seed) {
    CAPTURE(N, seed);
    const Eigen::Matrix<double, N, N> matrix = Eigen::Matrix<double, N, N>::Random();
    CHECK(residual<N>(matrix) < 1e-9);
  }
}

}  // namespace

TEST_CASE("inverse_of: times the matrix it is one", "[model]") {
  std::srand(7);
  check_random<3>();
  check_random<5>();
  check_random<7>();
  check_random<12>();
}

TEST_CASE("inverse_of: pivots where an element of the diagonal is zero", "[model]") {
  Eigen::Matrix<double, 5, 5> matrix = Eigen::Matrix<double, 5, 5>::Zero();
  for (int i = 0; i < 5; ++i) matrix(i, (i + 2) % 5) = i + 1.0;
  CHECK(residual<5>(matrix) == 0.0);
}

TEST_CASE("inverse_of: of a singular matrix it is not finite", "[model]") {
  const Eigen::Matrix<double, 6, 6> matrix = Eigen::Matrix<double, 6, 6>::Ones();
  CHECK_FALSE(inverse_of(matrix).allFinite());
}
