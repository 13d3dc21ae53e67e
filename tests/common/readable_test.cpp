#include "common/readable.hpp"

#include <catch2/catch.hpp>
#include <limits>

namespace rigcal {

TEST_CASE("readable: engineering units of few digits", "[common]") {
  CHECK(readable(6.2e6, "Pa") == "6.2 MPa");
  CHECK(readable(689e6, "Pa") == "689 MPa");
  CHECK(readable(-1.5e9, "Pa") == "-1.5 GPa");
  CHECK(readable(20.0, "Pa") == "20 Pa");
  CHECK(readable(0.0508, "m") == "50.8 mm");
  CHECK(readable(1e-9, "m") == "0.001 µm");
  CHECK(readable(633e-6, "m2") == "6.33 cm²");
  CHECK(readable(468e-6, "m3") == "468 cm³");
  CHECK(readable(1e-3 / 60.0, "m3/s") == "1 L/min");
}

TEST_CASE("readable: units without relatives stay SI", "[common]") {
  CHECK(readable(1000.0, "N s/m") == "1000 N s/m");
  CHECK(readable(0.35, "1") == "0.35");
  CHECK(readable(0.0, "Pa") == "0 Pa");
}

TEST_CASE("readable: what is not finite is a dash", "[common]") {
  CHECK(readable(std::numeric_limits<double>::quiet_NaN(), "m") == "-");
  CHECK(readable(std::numeric_limits<double>::infinity(), "V") == "-");
}

TEST_CASE("readable: no exponent where the digits before the point do", "[common]") {
  CHECK(readable(0.168, "s", 2) == "170 ms");
}

}  // namespace rigcal
