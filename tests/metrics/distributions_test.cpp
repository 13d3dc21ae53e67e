#include "metrics/distributions.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

using Catch::WithinAbs;
using Catch::WithinRel;
using namespace rigcal::metrics;

// Values as printed in statistical tables.
TEST_CASE("distributions: normal", "[metrics]") {
  CHECK_THAT(normal_quantile(0.975), WithinRel(1.959963985, 1e-9));
  CHECK_THAT(normal_cdf(-1.959963985), WithinRel(0.025, 1e-8));
  CHECK_THAT(normal_cdf(-10.0), WithinRel(7.619853024160526e-24, 1e-13));
  CHECK(normal_cdf(40.0) == 1.0);
  CHECK_THROWS_AS(normal_quantile(1.5), std::domain_error);
}

TEST_CASE("distributions: Student's t", "[metrics]") {
  CHECK_THAT(student_t_quantile(0.975, 10.0), WithinRel(2.228138852, 1e-9));
  CHECK_THAT(student_t_cdf(-2.228138852, 10.0), WithinRel(0.025, 1e-8));
  // With one degree of freedom, it is the Cauchy distribution: tan(pi (p - 1/2)).
  CHECK_THAT(student_t_quantile(0.75, 1.0), WithinRel(1.0, 1e-12));
  CHECK(std::isinf(student_t_quantile(0.975, 1e-6)));
  CHECK_THROWS_AS(student_t_cdf(1.0, 0.0), std::domain_error);
}

TEST_CASE("distributions: chi-square, F and binomial", "[metrics]") {
  CHECK_THAT(chi_squared_exceedance(3.841458821, 1.0), WithinRel(0.05, 1e-8));
  CHECK_THAT(chi_squared_exceedance(18.307038053, 10.0), WithinRel(0.05, 1e-8));
  CHECK_THAT(fisher_f_exceedance(3.325834530, 5.0, 10.0), WithinRel(0.05, 1e-8));
  CHECK_THAT(binomial_cdf(2, 10, 0.5), WithinAbs(56.0 / 1024.0, 1e-15));
  CHECK_THROWS_AS(chi_squared_exceedance(-1.0, 3.0), std::domain_error);
  CHECK(chi_squared_exceedance(0.0, 1e4) == 1.0);
}
