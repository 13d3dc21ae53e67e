#include "datasets/campaign/campaign_parameters.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <utility>

using namespace rigcal;
using namespace rigcal::datasets;
using Catch::Contains;

namespace {

/// Sets every value that the plant needs to an arbitrary number.
model::ParameterValues complete_values(model::PlantKind plant) {
  auto values = model::ParameterValues::defaults(plant);
  for (const std::string& key : values.missing()) values.set(key, 1.0);
  values.set("valve_gain", 1.0);  // the valve is electric
  return values;
}

}  // namespace

TEST_CASE("find_conflict: a supply that gives way needs resistance and capacity", "[datasets]") {
  const model::Rig rig{model::PlantKind::two_chamber, model::ControllerKind::none, {}};
  auto values = complete_values(rig.plant);
  CHECK_FALSE(find_conflict(rig, values));
  auto resistance = values;
  resistance.set("supply_resistance", 1e10);
  REQUIRE(find_conflict(rig, resistance));
  CHECK(find_conflict(rig, resistance)->key == "supply_resistance");
  CHECK_THAT(find_conflict(rig, resistance)->message, Contains("expected supply_capacity"));
  auto capacity = values;
  capacity.set("supply_capacity", 1e-12);
  REQUIRE(find_conflict(rig, capacity));
  CHECK(find_conflict(rig, capacity)->key == "supply_capacity");
  capacity.set("supply_resistance", 1e10);
  CHECK_FALSE(find_conflict(rig, capacity));
}

TEST_CASE("find_conflict: a derivative needs its filter", "[datasets]") {
  const model::Rig rig{model::PlantKind::load_pressure, model::ControllerKind::pid, {}};
  auto values = complete_values(rig.plant);
  values.set("kp", 1.0);
  CHECK_FALSE(find_conflict(rig, values));
  values.set("kd", 1.0);
  REQUIRE(find_conflict(rig, values));
  CHECK(find_conflict(rig, values)->key == "kd");
  values.set("derivative_filter", 100.0);
  CHECK_FALSE(find_conflict(rig, values));
}

TEST_CASE("complete_bounds: a tenth and ten times the start, within the limits", "[datasets]") {
  const auto index = model::parameter_index(model::PlantKind::load_pressure, "density");
  const model::ParameterSpec& spec = model::parameter_spec(model::PlantKind::load_pressure, index);
  REQUIRE(spec.lower == 100.0);
  REQUIRE(spec.upper == 5000.0);
  const auto bounds_of = [&](double start) {
    ParameterSetting setting;
    setting.index = index;
    setting.value = start;
    setting.lower = setting.upper = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(complete_bounds(spec, setting));
    return std::pair(setting.lower, setting.upper);
  };
  CHECK(bounds_of(850.0) == std::pair(100.0, 5000.0));
  CHECK(bounds_of(2000.0) == std::pair(200.0, 5000.0));
  CHECK(bounds_of(300.0) == std::pair(100.0, 3000.0));
}

TEST_CASE("outside_limits: a limit may be absent, but no number is beyond what results may hold",
          "[datasets]") {
  const int maximum = model::parameter_index(model::PlantKind::two_chamber, "pressure_a_maximum");
  const auto& spec = model::parameter_spec(model::PlantKind::two_chamber, maximum);
  CHECK_FALSE(outside_limits(spec, 40e6));
  CHECK_FALSE(outside_limits(spec, std::numeric_limits<double>::infinity()));
  REQUIRE(outside_limits(spec, 1e300));
  CHECK_THAT(*outside_limits(spec, 1e300), Contains("pressure_a_maximum"));
  CHECK(outside_limits(spec, -1e300));
}
