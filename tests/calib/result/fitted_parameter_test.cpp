#include "calib/result/fitted_parameter.hpp"

#include <catch2/catch.hpp>

namespace rigcal::calib {
namespace {

using datasets::Scope;

constexpr auto kPlant = model::PlantKind::load_pressure;

int row_of(const char* key) { return model::parameter_index(kPlant, key); }

}  // namespace

TEST_CASE("fitted parameter: knows its name, key, symbol and unit", "[calib]") {
  const FittedParameter mass = parameter_in_row(kPlant, row_of("mass"), Scope::rig, "");
  CHECK(mass.name == "mass_kg");
  CHECK(mass.key == "mass");
  CHECK(mass.symbol == "m");
  CHECK(mass.unit == "kg");
  CHECK_FALSE(mass.level.has_value());
  CHECK(parameter_label(mass.key, mass.scope, mass.level) == "mass");
}

TEST_CASE("fitted parameter: belongs to the rig, a leak level or a condition", "[calib]") {
  const int leak = row_of("leakage_coefficient");
  const FittedParameter level = parameter_in_row(kPlant, leak, Scope::leak_level, "33 %");
  CHECK(parameter_label(level.key, level.scope, level.level) ==
        "leakage_coefficient (leak level 33 %)");
  CHECK(level.matches(leak, Scope::leak_level, "33 %"));
  CHECK_FALSE(level.matches(leak, Scope::leak_level, "66 %"));
  CHECK_FALSE(level.matches(leak, Scope::condition, "33 %"));
  CHECK_FALSE(level.matches(row_of("mass"), Scope::leak_level, "33 %"));
  const FittedParameter condition = parameter_in_row(kPlant, leak, Scope::condition, "sine");
  CHECK(parameter_label(condition.key, condition.scope, condition.level) ==
        "leakage_coefficient (condition sine)");
  CHECK(parameter_in_row(kPlant, leak, Scope::rig, "").matches(leak, Scope::rig, ""));
}

}  // namespace rigcal::calib
