#include "report/fmu/units.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/quantity.hpp"
#include "model/plant/parameter.hpp"

using namespace rigcal;

TEST_CASE("units: each unit of a parameter is the product of its base units", "[report]") {
  for (const auto plant : {model::PlantKind::load_pressure, model::PlantKind::two_chamber,
                           model::PlantKind::linkage}) {
    for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
      const report::BaseUnits& base = report::base_units(spec.unit);
      std::string product = "1";
      const auto times = [&](const char* unit, int power) {
        if (power != 0)
          product += std::string(" ") + unit + (power == 1 ? "" : std::to_string(power));
      };
      times("kg", base.kg);
      times("m", base.m);
      times("s", base.s);
      times("A", base.A);
      times("rad", base.rad);
      times("K", base.K);
      INFO(spec.key << ": " << spec.unit << " is " << product);
      CHECK(parse_quantity(product, spec.unit) == Approx(1.0));
    }
  }
  CHECK_THROWS_AS(report::base_units("bar"), std::invalid_argument);
}
