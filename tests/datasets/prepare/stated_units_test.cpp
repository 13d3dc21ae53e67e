#include "datasets/prepare/stated_units.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "tests/datasets/reading.hpp"

using namespace rigcal::datasets;
using Catch::Contains;
using rigcal::test::message_when;

namespace {

StatedUnit stated_unit(const std::string& unit) {
  StatedUnit result;
  result.unit = unit;
  result.where = {"campaign.toml", 9, 3};
  return result;
}

std::string unit_refusal(const StatedUnit& unit, const ColumnLabel& label) {
  return message_when([&] { require_stated_unit(unit, "position", "run.csv", label); });
}

bool is_taken(const StatedUnit& unit, const std::string& name) {
  return unit_refusal(unit, {name, {}, {}, 1}) == "no error";
}

}  // namespace

TEST_CASE("require_stated_unit: a contradiction names both units and both places", "[datasets]") {
  CHECK_THAT(unit_refusal(stated_unit("bar"), {"pl_bar [psi]", {}, {}, 4}),
             Contains("run.csv:4: column 'pl_bar [psi]' is in psi") &&
                 Contains("recording.channels.position says unit = \"bar\" (campaign.toml:9:3)") &&
                 Contains("ignore_unit = \"psi\""));
  CHECK_THAT(unit_refusal(stated_unit("bar"), {"/run/p", "kPa", "attribute of its unit", 0}),
             Contains("run.csv: attribute of its unit: column '/run/p' is in kPa"));
  // A "g" of an acceleration is no gram.
  CHECK(unit_refusal(stated_unit("gravity"), {"acc", "g", "row of units", 2}) == "no error");
  const std::vector<std::pair<std::string, std::string>> contradictions{
      {"mm", "x [m]"},   {"mm", "x_mm (m)"}, {"s", "t_s [ms]"},     {"mm", "x_m"},
      {"K", "T [degC]"}, {"mm", "x [V]"},    {"bar", "p [kgf/cm2]"}};
  for (const auto& [unit, name] : contradictions) {
    CAPTURE(unit, name);
    CHECK_FALSE(is_taken(stated_unit(unit), name));
  }
}

TEST_CASE("require_stated_unit: the same unit written otherwise is the same", "[datasets]") {
  const std::vector<std::pair<std::string, std::string>> same{
      {"kgf/cm2", "p [kg/cm2]"}, {"degC", "T [C]"},     {"degC", "T [\u00b0C]"},
      {"V", "u [Volt]"},         {"bar", "p [BARG]"},   {"hPa", "p [mbar]"},
      {"psi", "p [lbf/in2]"},    {"um", "x [\u00b5m]"}, {"s", "t [sec]"}};
  for (const auto& [unit, name] : same) {
    CAPTURE(unit, name);
    CHECK(is_taken(stated_unit(unit), name));
  }
  CHECK(is_taken(stated_unit("mm"), "Position in mm"));
  CHECK_FALSE(is_taken(stated_unit("mm"), "Position in cm"));
  // No unit, the unit of a pure number, or a word that only looks like a unit of another dimension.
  for (const char* name : {"x", "p (ist)", "p_in", "p_s", "p (A)", "u [%]", "p [-]", "p (in)"}) {
    CAPTURE(name);
    CHECK(is_taken(stated_unit("bar"), name));
  }
}

TEST_CASE("require_stated_unit: a gain that converts, and what the campaign ignores",
          "[datasets]") {
  StatedUnit unit = stated_unit("bar");
  unit.gain = 0.0689;
  CHECK(is_taken(unit, "p [psi]"));
  unit.gain = -0.0689476;
  CHECK(is_taken(unit, "p [psi]"));
  unit.gain = 0.08;  // 16 % too much
  CHECK_FALSE(is_taken(unit, "p [psi]"));
  unit.gain = -1.0;
  CHECK_FALSE(is_taken(unit, "p [psi]"));
  CHECK(is_taken(unit, "p [bar]"));
  unit.gain = 25.0;
  CHECK(is_taken(unit, "p [V]"));
  unit.gain.reset();
  unit.ignored = "psi";
  CHECK(is_taken(unit, "p [psi]"));
  CHECK(is_taken(unit, "p [lbf/in2]"));
  CHECK_FALSE(is_taken(unit, "p [kPa]"));
  StatedUnit kelvin = stated_unit("K");
  kelvin.has_offset = true;
  CHECK(is_taken(kelvin, "T [degC]"));
  CHECK_FALSE(is_taken(kelvin, "T [mK]"));
  CHECK(is_taken({}, "p [psi]"));  // raw counts of a converter
}
