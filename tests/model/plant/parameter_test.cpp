#include "model/plant/parameter.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cctype>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

using namespace rigcal::model;
using Catch::Contains;

namespace {

const std::set<std::string> kSymbols{"s", "hz", "m", "kg", "n", "pa", "v", "a", "rad", "k"};

/// "m3/(s Pa)" -> "_m3_per_s_pa": factors joined by _, with one "per" before those in the
/// denominator. Empty for "1"; "_?" for a symbol outside the closed set.
std::string unit_suffix(std::string_view unit) {
  if (unit == "1") return "";
  std::string spaced;
  for (const char c : unit) {
    if (c == '/') {
      spaced += " per ";
    } else {
      spaced += (c == '(' || c == ')') ? ' ' : static_cast<char>(std::tolower(c));
    }
  }
  std::istringstream words(spaced);
  std::string suffix;
  for (std::string word; words >> word;) {
    if (word == "1") continue;  // the numerator of "1/s"
    std::string symbol = word;
    while (!symbol.empty() && std::isdigit(static_cast<unsigned char>(symbol.back())) != 0) {
      symbol.pop_back();
    }
    suffix += "_" + (word == "per" || kSymbols.count(symbol) > 0 ? word : "?");
  }
  return suffix;
}

constexpr std::array kPlants{PlantKind::load_pressure, PlantKind::two_chamber, PlantKind::linkage};

}  // namespace

TEST_CASE("parameters: every name is its key with the SI unit at its end", "[model]") {
  CHECK(unit_suffix("m3/(s Pa)") == "_m3_per_s_pa");
  CHECK(unit_suffix("1/s") == "_per_s");
  CHECK(unit_suffix("bar") == "_?");
  for (const PlantKind plant : kPlants) {
    for (const ParameterSpec& spec : parameter_table(plant)) {
      CAPTURE(spec.key, spec.name, spec.unit);
      CHECK(std::string(spec.name) == std::string(spec.key) + unit_suffix(spec.unit));
    }
  }
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
