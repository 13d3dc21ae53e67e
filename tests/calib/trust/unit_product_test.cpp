#include "calib/trust/unit_product.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

namespace rigcal::calib {

TEST_CASE("unit_product: quotients and roots in base units", "[calib]") {
  CHECK(unit_product("kg", "N s/m", -1.0) == "s");
  CHECK(unit_product("Pa", "Pa", -1.0) == "1");
  CHECK(unit_product("m/V", "Pa", 0.5) == "kg^0.5 m^0.5/(s V)");
  CHECK(unit_product("m3/(s Pa)", "1", 1.0) == "m4 s/kg");
  CHECK(unit_product("rad/s", "1", 2.0) == "1/s");
  CHECK_THROWS_AS(unit_product("furlong", "1", 1.0), std::invalid_argument);
}

TEST_CASE("mass_exponent: forces, pressures and what divides by them", "[calib]") {
  for (const char* unit : {"kg", "N", "Pa", "N s/m", "N/m", "Pa s/m3"})
    CHECK(mass_exponent(unit) == 1.0);
  for (const char* unit : {"m3/(s Pa)", "m3/Pa"}) CHECK(mass_exponent(unit) == -1.0);
  for (const char* unit : {"1", "m/V", "s", "s/m", "m/s2", "V/(m s)"})
    CHECK(mass_exponent(unit) == 0.0);
  CHECK_THROWS_AS(mass_exponent("furlong"), std::invalid_argument);
}

}  // namespace rigcal::calib
