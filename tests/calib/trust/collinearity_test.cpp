#include "calib/trust/collinearity.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rigcal::calib {
namespace {

using Catch::Contains;
using Catch::WithinRel;

Eigen::MatrixXd pair(double r) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(2, 2);
  matrix(0, 1) = matrix(1, 0) = r;
  return matrix;
}

}  // namespace

TEST_CASE("collinearity: variance inflation is the diagonal of the inverse", "[calib]") {
  const Eigen::VectorXd two = variance_inflation(pair(0.6));
  CHECK_THAT(two(0), WithinRel(1.0 / (1.0 - 0.36), 1e-12));
  CHECK_THAT(two(1), WithinRel(two(0), 1e-12));
  CHECK(std::isinf(variance_inflation(pair(1.0))(0)));
}

TEST_CASE("collinearity: estimates that others make up together are named", "[calib]") {
  CHECK_THAT(collinearity_words({"a", "b"}, pair(-0.5)),
             Contains("-0.500 between a and b") && Contains("all can be separated"));
  CHECK_THAT(collinearity_words({"a", "b"}, pair(0.95)), !Contains("all can be separated"));
  CHECK_THAT(collinearity_words({"a", "b"}, pair(0.999)),
             Contains("combination of the two") && Contains("a 500 times"));
  // c is the sum of a and b except for a hundredth of its variance. No pairwise correlation exceeds
  // 0.71, but c is hardly determined.
  Eigen::MatrixXd sum = Eigen::MatrixXd::Identity(3, 3);
  sum(0, 2) = sum(2, 0) = sum(1, 2) = sum(2, 1) = std::sqrt(0.99 / 2.0);
  CHECK_THAT(variance_inflation(sum)(2), WithinRel(100.0, 1e-9));
  CHECK_THAT(collinearity_words({"a", "b", "c"}, sum),
             Contains("c 100 times") && !Contains("all can be separated"));
  CHECK(collinearity_words({"a"}, Eigen::MatrixXd::Identity(1, 1)).empty());
}

}  // namespace rigcal::calib
