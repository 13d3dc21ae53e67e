#include "common/significant.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rigcal {

TEST_CASE("significant: no exponent where the digits before the point do", "[common]") {
  CHECK(significant(168.2, 2) == "170");
  CHECK(significant(-1110.0, 3) == "-1110");
  CHECK(significant(99.6, 2) == "100");
  CHECK(significant(0.05, 2) == "0.05");
  CHECK(significant(1.24e-5, 2) == "1.2×10⁻⁵");
  CHECK(significant(3.2e7, 2) == "3.2×10⁷");
}

TEST_CASE("measured: zeros after the point count", "[common]") {
  CHECK(measured(2.9, 3) == "2.90");
  CHECK(measured(25.0, 3) == "25.0");
  CHECK(measured(100.0, 3) == "100");
  CHECK(measured(170.0, 2) == "170");
  CHECK(measured(1.0, 2) == "1.0");
  CHECK(measured(-0.04, 3) == "-0.0400");
  CHECK(measured(0.102, 2) == "0.10");
  CHECK(measured(3e-5, 2) == "3.0×10⁻⁵");
  CHECK(measured(0.0, 3) == "0");
  CHECK(measured(HUGE_VAL, 3) == "inf");
}

TEST_CASE("with_power_of_ten: only an exponent changes", "[common]") {
  CHECK(with_power_of_ten("-3.80e-13") == "-3.80×10⁻¹³");
  CHECK(with_power_of_ten("1e+06") == "1×10⁶");
  CHECK(with_power_of_ten("0.5") == "0.5");
  CHECK(with_power_of_ten("nan") == "nan");
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
