#include "report/store/validity.hpp"

#include <catch2/catch.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace rigcal::report;
using rigcal::Range;
using rigcal::calib::Validity;

namespace {

Validity amplitude(double low_m, double high_m) {
  Validity validity;
  validity.amplitude_m = Range{low_m, high_m};
  return validity;
}

}  // namespace

TEST_CASE("outside: a tenth beyond the covered range is let pass", "[report]") {
  CHECK(outside(amplitude(0.00201, 0.002063), amplitude(0.002063, 0.002063)).empty());
  CHECK(outside(amplitude(0.0046, 0.0109), amplitude(0.005, 0.01)).empty());
  CHECK(outside(amplitude(0.0044, 0.01), amplitude(0.005, 0.01)).size() == 1);
  CHECK(outside(amplitude(0.005, 0.0111), amplitude(0.005, 0.01)).size() == 1);
}

TEST_CASE("outside: one sentence in the units of the field", "[report]") {
  Validity covered = amplitude(0.005, 0.01);
  covered.frequency_hz = Range{0.1, 10.0};
  covered.supply_pressure_pa = Range{6.2e6, 6.2e6};
  covered.leakage_coefficient = Range{0.3, 0.6};
  Validity asked = amplitude(0.005, 0.0508);
  asked.frequency_hz = Range{20.0, 20.0};
  asked.supply_pressure_pa = Range{6.2e6, 7e6};
  asked.leakage_coefficient = Range{0.1, 0.6};
  CHECK(outside(asked, covered) ==
        std::vector<std::string>{
            "frequency 20 Hz is used, but the fit covers only 0.1 to 10 Hz",
            "amplitude 5 to 50.8 mm is used, but the fit covers only 5 to 10 mm",
            "supply pressure 6.2 to 7 MPa is used, but the fit covers only 6.2 MPa",
            "leakage coefficient 0.1 to 0.6 is used, but the fit covers only 0.3 to 0.6"});
  Validity validated;
  validated.frequency_hz = Range{20.0, 25.0};
  CHECK(outside(asked, covered, &validated).at(0) ==
        "frequency 20 Hz is used, but the fit covers only 0.1 to 10 Hz, validated at 20 to 25 Hz");
  CHECK(outside(asked, covered, &validated).at(1) == outside(asked, covered).at(1));
}

TEST_CASE("outside: what neither side tells is not compared", "[report]") {
  CHECK(outside(amplitude(0.1, 0.1), {}).empty());
  CHECK(outside({}, amplitude(0.1, 0.1)).empty());
}
