#include "common/significant.hpp"

#include <catch2/catch.hpp>

namespace rigcal {

TEST_CASE("significant: no exponent where the digits before the point do", "[common]") {
  CHECK(significant(168.2, 2) == "170");
  CHECK(significant(-1110.0, 3) == "-1110");
  CHECK(significant(99.6, 2) == "100");
  CHECK(significant(0.05, 2) == "0.05");
  CHECK(significant(1.24e-5, 2) == "1.2e-05");
  CHECK(significant(3.2e7, 2) == "3.2e+07");
}

TEST_CASE("fixed, to_uncertainty: a rounded zero has no sign", "[common]") {
  CHECK(fixed(-0.0004, 2) == "0.00");
  CHECK(fixed(-0.04, 1) == "0.0");
  CHECK(fixed(-0.06, 1) == "-0.1");
  CHECK(to_uncertainty(-0.0004, 0.1) == "0.00");
  CHECK(to_uncertainty(168.2, 400.0) == "170");
}

TEST_CASE("p_value_text: two digits, and no more than four decimals", "[common]") {
  CHECK(p_value_text(0.0123) == "p = 0.012");
  CHECK(p_value_text(0.9e-4) == "p < 0.0001");
}

}  // namespace rigcal
