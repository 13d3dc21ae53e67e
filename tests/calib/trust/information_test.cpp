#include "calib/trust/information.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calib/twin.hpp"

namespace rigcal::calib {

using Catch::WithinRel;

TEST_CASE("information: bounds of a matrix of two columns", "[calib]") {
  Twin twin;
  twin.free("kp", 300.0, 200.0, 500.0);             // 300 per unit
  twin.free("position_offset", 1e-3, -5e-3, 5e-3);  // 0.01 per unit
  twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
  const auto records = twin.records(50, 500.0, 1);
  const Problem problem = problem_of(twin, records);
  REQUIRE(problem.spec(0).key == "position_offset");
  Eigen::MatrixXd jacobian(3, 2);
  jacobian << 3.0, 1.0, 1.0, 2.0, 0.0, 1.0;  // J^T J = [10 5; 5 6], determinant 35
  const auto found = cramer_rao(problem, problem.start(), jacobian);
  CHECK_THAT(found[0].value(), WithinRel(0.01 * std::sqrt(6.0 / 35.0), 1e-12));
  CHECK_THAT(found[1].value(), WithinRel(300.0 * std::sqrt(10.0 / 35.0), 1e-12));
  // The result does not depend on the scale of the columns. If the columns are parallel, nothing is
  // known.
  jacobian.col(0) *= 1e5;
  const auto stiff = cramer_rao(problem, problem.start(), jacobian);
  CHECK_THAT(stiff[0].value(), WithinRel(0.01e-5 * std::sqrt(6.0 / 35.0), 1e-9));
  CHECK_THAT(stiff[1].value(), WithinRel(300.0 * std::sqrt(10.0 / 35.0), 1e-9));
  jacobian.col(0) = 2.0 * jacobian.col(1);
  for (const auto& none : cramer_rao(problem, problem.start(), jacobian)) CHECK_FALSE(none);
}

TEST_CASE("information: the half width is that of 95 %", "[calib]") {
  CHECK_THAT(relative_half_width(0.05, -2.0).value(), WithinRel(0.049, 1e-3));
  CHECK_FALSE(relative_half_width(0.05, 0.0));
  CHECK_FALSE(relative_half_width(std::nullopt, 2.0));
}

}  // namespace rigcal::calib
