#include "model/fmi/exported_rig.hpp"

#include <catch2/catch.hpp>

#include "tests/support/temporary_folder.hpp"

using namespace rigcal::model;
using Catch::Contains;
using rigcal::test::TemporaryFolder;

namespace {

ExportedRig sampled_rig() {
  ExportedRig rig;
  rig.guid = "{1}";
  rig.rig = {PlantKind::two_chamber, ControllerKind::pid, InitialState::given, Feedback::force,
             Before::steady};
  rig.values = ParameterValues::defaults(PlantKind::two_chamber);
  rig.tolerance = 1e-7;
  rig.values.set("mass", 0.1 + 0.2);  // has no short decimal representation
  rig.values.set("external_force", -3.5e-300);
  rig.values.set("sample_time", 1e-3);
  rig.values.set("initial_pressure_a", 2e6);
  rig.values.set("position_gain", 1.01);
  rig.values.set("transport_delay", 0.0);
  return rig;
}

std::vector<std::string> keys(const ExportedRig& rig) {
  std::vector<std::string> keys;
  for (const int index : exported_parameters(rig))
    keys.emplace_back(parameter_table(rig.rig.plant)[static_cast<std::size_t>(index)].key);
  return keys;
}

bool has(const std::vector<std::string>& keys, const char* key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

}  // namespace

TEST_CASE("exported_rig: a rig reads back to the same bits", "[model]") {
  const TemporaryFolder folder;
  const ExportedRig rig = sampled_rig();
  const ExportedRig back = read_exported_rig(folder.write(kRigFile, exported_rig_text(rig)));
  CHECK(back.guid == rig.guid);
  CHECK(back.rig.plant == rig.rig.plant);
  CHECK(back.rig.controller == rig.rig.controller);
  CHECK(back.rig.initial == rig.rig.initial);
  CHECK(back.rig.feedback == rig.rig.feedback);
  CHECK(back.rig.before == rig.rig.before);
  CHECK(back.tolerance == rig.tolerance);
  CHECK(back.values.value == rig.values.value);
  CHECK(back.values.given == rig.values.given);
}

TEST_CASE("exported_rig: parameters are what the rig has and is no input", "[model]") {
  ExportedRig rig = sampled_rig();
  const auto all = keys(rig);
  for (const char* key : {"mass", "leakage_coefficient", "sample_time", "initial_pressure_a"})
    CHECK(has(all, key));
  for (const char* key : {"supply_pressure", "tank_pressure", "external_force", "position_gain",
                          "transport_delay", "kp", "initial_pressure_b", "gravity"})
    CHECK_FALSE(has(all, key));
  rig.rig.initial = InitialState::rest;
  CHECK_FALSE(has(keys(rig), "initial_pressure_a"));
  rig.rig.controller = ControllerKind::none;
  CHECK_FALSE(has(keys(rig), "sample_time"));
}

TEST_CASE("exported_rig: a damaged file is refused by line", "[model]") {
  const TemporaryFolder folder;
  const std::string text = exported_rig_text(sampled_rig());
  const auto complaint = [&](const std::string& content) -> std::string {
    try {
      read_exported_rig(folder.write(kRigFile, content));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  CHECK_THAT(complaint("rigcal.rig/9\n"), Contains("rig.txt:1: found \"rigcal.rig/9\""));
  CHECK_THAT(complaint("rigcal.rig/1\nplant pump\n"), Contains("rig.txt:2: found pump"));
  CHECK_THAT(complaint(text + "parameter mass nan\n"), Contains("found nan, expected a number"));
  CHECK_THAT(complaint(text + "parameter mas 1\n"), Contains("found mas, expected a parameter of"));
  CHECK_THAT(complaint(text + "parameter mass\n"), Contains("found end of line"));
  CHECK_THAT(complaint(text + "colour red\n"), Contains("found colour, expected guid, plant"));
  CHECK_THROWS_WITH(read_exported_rig(folder / "none"), Contains("none: cannot be read"));
}
