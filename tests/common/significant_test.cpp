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

}  // namespace rigcal
