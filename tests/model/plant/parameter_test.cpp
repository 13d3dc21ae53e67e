#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/plant/kinds.hpp"
#include "model/plant/linkage.hpp"

using namespace rigcal::model;
using Catch::Contains;

namespace {

constexpr std::array kPlants{PlantKind::load_pressure, PlantKind::two_chamber, PlantKind::linkage};

}  // namespace

TEST_CASE("kinds: the dimension of a unit is that of its factors", "[model]") {
  STATIC_REQUIRE(dimension("N m s/rad") == Dimension{.m = 2, .kg = 1, .s = -1, .rad = -1});
  STATIC_REQUIRE(dimension("m3/(s Pa)") == Dimension{.m = 4, .kg = -1, .s = 1});
  STATIC_REQUIRE(dimension("1/s") == Dimension{.s = -1});
  STATIC_REQUIRE(dimension("1") == Dimension{});
  STATIC_REQUIRE(dimension("rad") != dimension("m"));
  STATIC_REQUIRE(dimension("N") != dimension("N m"));
  CHECK_THROWS_AS(dimension("bar"), std::invalid_argument);
}

TEST_CASE("kinds: a row of another kind is found", "[model]") {
  // The compiler has found none in the tables (parameter.cpp).
  const auto with_unit = [](std::string_view key, std::string_view unit, std::string_view name) {
    const auto table = parameter_table(PlantKind::linkage);
    std::vector<ParameterSpec> rows(table.begin(), table.end());
    const int index = parameter_index(PlantKind::linkage, key);
    rows.at(static_cast<std::size_t>(index)).unit = unit;
    rows.at(static_cast<std::size_t>(index)).name = name;
    return rows;
  };
  const std::span<const StateRow> states = LinkagePlant::kStateRows;
  CHECK_FALSE(are_named_by_units(with_unit("angle_offset", "m", "angle_offset_rad")));
  CHECK_FALSE(sensors_agree(with_unit("angle_offset", "m", "angle_offset_m"), states));
  CHECK_FALSE(sensors_agree(with_unit("torque_maximum", "N", "torque_maximum_n"), states));
  CHECK_FALSE(sensors_agree(with_unit("angle_lag", "rad", "angle_lag_rad"), states));
  CHECK_FALSE(initial_values_agree(with_unit("initial_angle", "m", "initial_angle_m"), states));
  CHECK_FALSE(gains_agree(with_unit("angle_ki", "V/(m s)", "angle_ki_v_per_m_s"), states));
  CHECK_FALSE(gains_agree(with_unit("torque_kp", "V/N", "torque_kp_v_per_n"), states));
  CHECK_FALSE(motion_agrees(std::array{states[0], kPistonVelocity}));
  const auto same = with_unit("angle_offset", "rad", "angle_offset_rad");
  CHECK(are_named_by_units(same));
  CHECK(sensors_agree(same, states));
  CHECK(initial_values_agree(same, states));
  CHECK(gains_agree(same, states));
}

TEST_CASE("parameters: keys, names and symbols are unique, words are there", "[model]") {
  const PlantKind plant = GENERATE(from_range(kPlants));
  std::set<std::string_view> keys;
  std::set<std::string_view> names;
  std::set<std::string_view> symbols;
  for (const ParameterSpec& spec : parameter_table(plant)) {
    CAPTURE(spec.key);
    CHECK(keys.insert(spec.key).second);
    CHECK(names.insert(spec.name).second);
    CHECK(symbols.insert(spec.symbol).second);
    CHECK_FALSE(spec.meaning.empty());
    CHECK_FALSE(spec.source.empty());
    CHECK_FALSE(to_string(spec.kind).empty());
  }
}

TEST_CASE("parameters: bounds are in order and hold the default", "[model]") {
  for (const ParameterSpec& spec : parameter_table(GENERATE(from_range(kPlants)))) {
    CAPTURE(spec.key);
    CHECK(spec.lower < spec.upper);
    CHECK(std::isfinite(spec.lower));
    if (!spec.default_value) {
      CHECK(spec.kind == ParameterKind::plant);
      continue;
    }
    // A zero below the bounds represents an absent term. If the term is given, its value must be
    // given.
    const bool absent =
        *spec.default_value == 0.0 && spec.lower > 0.0 &&
        (spec.kind == ParameterKind::term || spec.kind == ParameterKind::controller ||
         spec.kind == ParameterKind::sensor);
    CHECK((absent || (*spec.default_value >= spec.lower && *spec.default_value <= spec.upper)));
  }
}

TEST_CASE("parameter_index: finds each key of the table and no other", "[model]") {
  const auto table = parameter_table(PlantKind::load_pressure);
  for (std::size_t i = 0; i < table.size(); ++i) {
    CHECK(parameter_index(PlantKind::load_pressure, table[i].key) == static_cast<int>(i));
  }
  CHECK(parameter_index(PlantKind::load_pressure, "Mass") == -1);
  CHECK(parameter_index(PlantKind::load_pressure, "") == -1);
}

TEST_CASE("plant_from_name: reads every name of plant_names", "[model]") {
  for (const std::string& name : plant_names()) {
    REQUIRE(plant_from_name(name));
    CHECK(to_string(*plant_from_name(name)) == name);
  }
  CHECK_FALSE(plant_from_name("tank"));
}

TEST_CASE("ParameterValues: set marks as given, missing names what has no value", "[model]") {
  auto values = ParameterValues::defaults(PlantKind::load_pressure);
  const auto missing = values.missing();
  CHECK(missing.size() ==
        13);  // all plant parameters except leakage_smoothing, which has a default
  CHECK(missing.front() == "mass");
  CHECK(values["leakage_smoothing"] == 100.0);
  CHECK_FALSE(values.is_given("mass"));
  values.set("mass", 85.0);
  CHECK(values.is_given("mass"));
  CHECK(values["mass"] == 85.0);
  CHECK(values.missing().size() == 12);
  CHECK_FALSE(values.is_given("lever"));  // a parameter of linkages only
  CHECK_THROWS_WITH(values.is_given("mas"), Contains("'mas'"));
  CHECK_THROWS_WITH(values.set("mas", 1.0), Contains("'mas'"));
  CHECK_THROWS_AS(values["mas"], std::invalid_argument);
  CHECK_THROWS_AS(values.set(-1, 1.0), std::out_of_range);
}

TEST_CASE("parameter_spec: an index outside the table is an error", "[model]") {
  const PlantKind plant = GENERATE(from_range(kPlants));
  const auto table = parameter_table(plant);
  const int past = static_cast<int>(table.size());
  CHECK(&parameter_spec(plant, 0) == &table.front());
  CHECK(&parameter_spec(plant, past - 1) == &table.back());
  CHECK_THROWS_AS(parameter_spec(plant, past), std::out_of_range);
  CHECK_THROWS_AS(parameter_spec(plant, parameter_index(plant, "no_such_key")), std::out_of_range);
}
