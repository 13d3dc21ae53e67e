#include "report/fmu/variables.hpp"

#include <zip.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/fmi/references.hpp"
#include "report/fmu/documentation.hpp"
#include "report/fmu/fmu.hpp"
#include "report/fmu/model_description.hpp"
#include "report/fmu/units.hpp"
#include "report/fmu/zip.hpp"
#include "tests/model/linkage_rig.hpp"

// The description of a rig as an importer reads it.

using namespace rigcal;
using Catch::Contains;
using report::Causality;
using report::FmuVariable;

namespace {

model::ExportedRig load_rig(bool pid = true) {
  model::ExportedRig rig;
  rig.values = model::paper_rig();
  if (!pid) rig.rig.controller = model::ControllerKind::none;
  rig.values.set("external_force", -20.0);
  return rig;
}

model::ExportedRig two_chamber_rig() {
  model::ExportedRig rig;
  rig.rig = {model::PlantKind::two_chamber, model::ControllerKind::none, model::InitialState::rest};
  rig.values = model::ParameterValues::defaults(model::PlantKind::two_chamber);
  rig.values.set("supply_pressure", 7e6);
  rig.values.set("tank_pressure", 2e5);
  return rig;
}

std::vector<FmuVariable> variables_of(const model::ExportedRig& rig) {
  return report::fmu_variables(rig, model::make_equations(rig)->layout());
}

const FmuVariable& named(const std::vector<FmuVariable>& variables, const std::string& name) {
  for (const FmuVariable& each : variables)
    if (each.name == name) return each;
  throw std::runtime_error("no variable " + name);
}
bool has(const std::vector<FmuVariable>& variables, const std::string& name) {
  return std::any_of(variables.begin(), variables.end(),
                     [&](const FmuVariable& each) { return each.name == name; });
}

/// Returns the XML element of a variable.
std::string element(const std::string& xml, const std::string& name) {
  const std::size_t at = xml.find("<ScalarVariable name=\"" + name + "\"");
  REQUIRE(at != std::string::npos);
  return xml.substr(at, xml.find("</ScalarVariable>", at) - at);
}

std::string description_of(const model::ExportedRig& rig) {
  report::FmuRequest request;
  request.rig = rig;
  request.name = "bench";
  request.identifier = "bench_4";
  request.start_s = 0.5;
  request.stop_s = 2.5;
  request.step_s = 0.125;
  request.rig.tolerance = 1e-5;
  request.rig.guid = "{guid}";
  return report::model_description(request, variables_of(rig), 7, {"a.cpp", "b/c.cpp"});
}

}  // namespace

TEST_CASE("fmu variables: inputs by the loop and the plant, each with its start", "[report]") {
  const auto closed = variables_of(load_rig());
  CHECK(closed[0].name == "reference");
  CHECK(closed[0].unit == "m");
  CHECK(closed[0].start == 0.0);
  CHECK(closed[1].name == "external_force");
  CHECK(closed[1].start == -20.0);
  CHECK(closed[1].unit == "N");
  CHECK(closed[2].name == "supply_pressure");
  CHECK(closed[2].unit == "Pa");
  CHECK(closed[2].start == load_rig().values["supply_pressure"]);
  for (unsigned i = 0; i < 3; ++i) {
    CHECK(closed[i].reference == i);
    CHECK(closed[i].causality == Causality::input);
  }
  CHECK_FALSE(has(closed, "tank_pressure"));
  const auto open = variables_of(load_rig(false));
  CHECK(open[0].name == "command");
  CHECK(open[0].unit == "V");
  CHECK_FALSE(has(open, "reference"));
  const auto two = variables_of(two_chamber_rig());
  CHECK(named(two, "tank_pressure").reference == 3);
  CHECK(named(two, "tank_pressure").start == 2e5);
  CHECK(named(two, "supply_pressure").start == 7e6);
}

TEST_CASE("fmu variables: an arm is told in radians, and its pilot pressure drives it",
          "[report]") {
  model::Experiment arm = model::arm_rig();
  arm.set("supply_resistance", 1e9).set("supply_capacity", 1e-11).set("pump_flow", 6e-4);
  arm.set("pump_second_flow", 9e-4).set("pump_delay", 0.3).set("pump_first_rate", 1e-4);
  arm.set("valve_frequency", 60.0).set("valve_damping_ratio", 0.8).set("lever_curvature", -0.1);
  model::ExportedRig rig;
  rig.rig = arm.rig;
  rig.values = arm.values;
  const auto variables = variables_of(rig);
  CHECK(variables.front().name == "pilot_pressure");
  CHECK(variables.front().unit == "Pa");
  CHECK(named(variables, "angle").unit == "rad");
  CHECK(named(variables, "angle").is_state);
  CHECK(named(variables, "position").causality == Causality::output);  // the position of the piston
  CHECK(named(variables, "torque").unit == "N m");
  CHECK(named(variables, "torque").causality == Causality::output);
  CHECK(named(variables, "der(pump_demand)").unit == "1");
  CHECK(named(variables, "lever_curvature").unit == "m/rad3");
  CHECK(named(variables, "external_moment").unit == "N m");
  CHECK(named(variables, "external_moment").causality == Causality::input);
  CHECK(named(variables, "external_moment").start == 0.0);
  for (const char* absent : {"external_force", "command", "payload_acceleration", "stroke"})
    CHECK_FALSE(has(variables, absent));
  for (const FmuVariable& each : variables) {
    CAPTURE(each.name, each.unit);
    CHECK_NOTHROW(report::base_units(each.unit));
  }
  for (const char* of_joint : {"angle", "torque", "external_moment"})
    CHECK_FALSE(has(variables_of(two_chamber_rig()), of_joint));
}

TEST_CASE("fmu variables: a loop of an arm has reference and gains in the units of its quantity",
          "[report]") {
  struct Row {
    model::Feedback feedback;
    std::vector<const char*> terms;
    const char* unit;
    std::vector<std::pair<const char*, const char*>> units;
  };
  for (const Row& row : {Row{model::Feedback::angle,
                             {"angle_kp", "angle_ki", "angle_kd"},
                             "rad",
                             {{"angle_kd", "V s/rad"}, {"controller_filtered_error", "rad"}}},
                         Row{model::Feedback::angle,
                             {"angle_kp", "angular_acceleration_feedforward"},
                             "rad",
                             {{"angular_acceleration_feedforward", "V s2/rad"},
                              {"controller_filtered_reference", "rad"},
                              {"controller_filtered_rate", "rad/s"},
                              {"der(controller_filtered_rate)", "rad/s2"}}},
                         Row{model::Feedback::torque,
                             {"torque_kp", "torque_ki", "torque_kd"},
                             "N m",
                             {{"torque_ki", "V/(N m s)"},
                              {"controller_filtered_error", "N m"},
                              {"der(controller_filtered_error)", "N m/s"}}},
                         Row{model::Feedback::load_pressure,
                             {"load_pressure_kp", "load_pressure_kd"},
                             "Pa",
                             {{"load_pressure_kd", "V s/Pa"}}}}) {
    model::Experiment arm = model::arm_rig().unset("pilot_gain").unset("pilot_dead_band");
    arm.set("valve_gain", 2e-4).set("derivative_filter", 100.0);
    for (const char* key : row.terms) arm.set(key, 1.0);
    model::ExportedRig rig;
    rig.rig = arm.rig;
    rig.rig.pilot = false;
    rig.rig.controller = model::ControllerKind::pid;
    rig.rig.feedback = row.feedback;
    rig.values = arm.values;
    const auto variables = variables_of(rig);
    CHECK(variables.front().name == "reference");
    CHECK(variables.front().unit == row.unit);
    for (const auto& [name, unit] : row.units) CHECK(named(variables, name).unit == unit);
    CHECK(named(variables, "command").causality == Causality::output);
    for (const FmuVariable& each : variables) {
      CAPTURE(each.name, each.unit);
      CHECK_NOTHROW(report::base_units(each.unit));
    }
  }
}

TEST_CASE("fmu variables: states, outputs and rates by their references", "[report]") {
  const auto variables = variables_of(load_rig());
  const FmuVariable& velocity = named(variables, "velocity");
  CHECK(velocity.reference == 101);
  CHECK(velocity.is_state);
  CHECK(velocity.is_output());
  CHECK(velocity.unit == "m/s");
  CHECK(velocity.nominal == 0.1);
  CHECK_FALSE(velocity.start.has_value());
  CHECK(named(variables, "position").reference == 100);
  CHECK(named(variables, "load_pressure").reference == 102);
  const FmuVariable& force = named(variables, "force");
  CHECK(force.reference == 300 + static_cast<unsigned>(model::Output::force));
  CHECK_FALSE(force.is_state);
  CHECK(force.is_output());
  CHECK(force.unit == "N");
  CHECK(has(variables, "command"));
  CHECK_FALSE(named(variables, "command").causality == Causality::input);
  // In an open loop the command is an input and therefore not an output.
  CHECK(named(variables_of(load_rig(false)), "command").causality == Causality::input);
  std::size_t rates = 0;
  for (const FmuVariable& each : variables) {
    if (each.derivative_of == 0) continue;
    const FmuVariable& of = variables.at(each.derivative_of - 1);
    CHECK(each.name == "der(" + of.name + ")");
    CHECK(of.is_state);
    CHECK(each.reference == of.reference + 100);
    CHECK(each.causality == Causality::local);
    ++rates;
  }
  CHECK(rates == 3);
  CHECK(named(variables, "der(position)").unit == "m/s");
  CHECK(named(variables, "der(velocity)").unit == "m/s2");
  CHECK(named(variables, "der(load_pressure)").unit == "Pa/s");
  std::set<unsigned> references;
  for (const FmuVariable& each : variables) CHECK(references.insert(each.reference).second);
}

TEST_CASE("fmu variables: the rate of every state has a unit that the description knows",
          "[report]") {
  struct Row {
    model::Feedback feedback;
    std::vector<const char*> terms;
    const char* rate;
    const char* unit;
  };
  for (const Row& row : {Row{model::Feedback::position,
                             {"coulomb_friction", "bristle_stiffness"},
                             "der(bristle_force)",
                             "N/s"},
                         Row{model::Feedback::force,
                             {"force_kp", "force_kd", "derivative_filter"},
                             "der(controller_filtered_error)",
                             "N/s"},
                         Row{model::Feedback::load_pressure,
                             {"load_pressure_kp", "load_pressure_kd", "derivative_filter"},
                             "der(controller_filtered_error)",
                             "Pa/s"},
                         Row{model::Feedback::acceleration,
                             {"acceleration_kp", "acceleration_kd", "derivative_filter"},
                             "der(controller_filtered_error)",
                             "m/s3"}}) {
    model::ExportedRig rig = load_rig();
    rig.rig.feedback = row.feedback;
    for (const char* key : row.terms) rig.values.set(key, 1.0);
    const auto variables = variables_of(rig);
    CAPTURE(row.rate, row.unit);
    CHECK(named(variables, row.rate).unit == row.unit);
    for (const FmuVariable& each : variables) {
      CAPTURE(each.name, each.unit);
      CHECK_NOTHROW(report::base_units(each.unit));
    }
  }
}

TEST_CASE("fmu variables: what the sampled controller sets at its ticks", "[report]") {
  model::ExportedRig rig = load_rig();
  for (const char* key :
       {"ki", "kd", "derivative_filter", "valve_frequency", "valve_damping_ratio"})
    rig.values.set(key, 1.0);
  const auto reinit = [](const std::vector<FmuVariable>& variables) {
    std::set<std::string> names;
    for (const FmuVariable& each : variables)
      if (each.changes_at_ticks) names.insert(each.name);
    return names;
  };
  CHECK(reinit(variables_of(rig)).empty());
  rig.values.set("sample_time", 1e-3);
  const auto sampled = variables_of(rig);
  CHECK(reinit(sampled) == std::set<std::string>{"controller_integral", "controller_filtered_error",
                                                 "controller_held_output"});
  CHECK_FALSE(named(sampled, "valve_signal").is_output());
  CHECK(named(sampled, "der(valve_signal_rate)").unit == "V/s2");
  CHECK(named(sampled, "der(valve_signal)").unit == "V/s");
  CHECK_FALSE(named(sampled, "sample_time").tunable);
  CHECK(named(sampled, "ki").tunable);
}

TEST_CASE("fmu variables: parameters with their value and their limits", "[report]") {
  const auto rig = load_rig();
  const auto variables = variables_of(rig);
  const FmuVariable& mass = named(variables, "mass");
  const auto row = static_cast<std::size_t>(model::parameter_index(rig.rig.plant, "mass"));
  const auto& spec = model::parameter_table(rig.rig.plant)[row];
  CHECK(mass.reference == 1000 + row);
  CHECK(mass.causality == Causality::parameter);
  CHECK(mass.tunable);
  CHECK(mass.start == rig.values["mass"]);
  CHECK(mass.lower == spec.lower);
  CHECK(mass.upper == spec.upper);
  CHECK(mass.unit == "kg");
  CHECK_FALSE(mass.nominal.has_value());
  for (const FmuVariable& each : variables) {
    if (each.lower) CHECK(std::isfinite(*each.lower));
    if (each.upper) CHECK(std::isfinite(*each.upper));
  }
  CHECK(has(variables, "output_limit"));
  CHECK_FALSE(has(variables_of(load_rig(false)), "output_limit"));
}

TEST_CASE("fmu description: what an importer is told of the whole", "[report]") {
  const std::string xml = description_of(load_rig());
  CHECK_THAT(xml, Contains("fmiVersion=\"2.0\" modelName=\"bench\" guid=\"{guid}\""));
  CHECK_THAT(xml, Contains("numberOfEventIndicators=\"7\""));
  CHECK_THAT(xml, Contains("<DefaultExperiment startTime=\"0.5\" stopTime=\"2.5\" "
                           "tolerance=\"1e-05\" stepSize=\"0.125\"/>"));
  const std::string common =
      " modelIdentifier=\"bench_4\" canNotUseMemoryManagementFunctions=\"true\" "
      "canGetAndSetFMUstate=\"true\"";
  CHECK_THAT(xml, Contains("<ModelExchange" + common + " completedIntegratorStepNotNeeded"));
  CHECK_THAT(xml, Contains("<CoSimulation" + common +
                           " canHandleVariableCommunicationStepSize=\"true\" "
                           "canInterpolateInputs=\"true\">"));
  std::size_t files = 0;
  for (std::size_t at = xml.find("<File name=\"b/c.cpp\"/>"); at != std::string::npos;
       at = xml.find("<File name=\"b/c.cpp\"/>", at + 1))
    ++files;
  CHECK(files == 2);
  CHECK_THAT(xml, Contains("<Unit name=\"Pa\"><BaseUnit kg=\"1\" m=\"-1\" s=\"-2\"/></Unit>"));
  CHECK_THAT(xml,
             Contains("<Unit name=\"V\"><BaseUnit kg=\"1\" m=\"2\" s=\"-3\" A=\"-1\"/></Unit>"));
  CHECK_THAT(xml, Contains("<Unit name=\"1\"><BaseUnit/></Unit>"));
}

TEST_CASE("fmu description: each kind of variable", "[report]") {
  model::ExportedRig rig = load_rig();
  rig.values.set("ki", 1.0);
  rig.values.set("sample_time", 1e-3);
  const std::string xml = description_of(rig);
  CHECK_THAT(element(xml, "reference"),
             Contains("valueReference=\"0\"") &&
                 Contains("causality=\"input\" variability=\"continuous\"") &&
                 Contains("unit=\"m\" start=\"0\""));
  CHECK_THAT(element(xml, "position"),
             Contains("causality=\"output\" variability=\"continuous\"") &&
                 Contains("nominal=\"0.01\"") && !Contains("start=") && !Contains("derivative=") &&
                 !Contains("reinit"));
  CHECK_THAT(
      element(xml, "der(position)"),
      Contains("causality=\"local\" variability=\"continuous\"") && Contains("derivative=\""));
  CHECK_THAT(element(xml, "mass"), Contains("causality=\"parameter\" variability=\"tunable\"") &&
                                       Contains("min=\"0.001\" max=\"1000000\""));
  CHECK_THAT(element(xml, "sample_time"), Contains("variability=\"fixed\""));
  CHECK_THAT(element(xml, "controller_integral"), Contains("reinit=\"true\""));
  // Indices start at 1, and the states follow the three inputs.
  const std::string structure = xml.substr(xml.find("<ModelStructure>"));
  CHECK_THAT(structure, Contains("<Outputs>\n      <Unknown index=\"4\" dependencies=\"4\" "
                                 "dependenciesKind=\"constant\"/>\n      <Unknown index=\"5\""));
  CHECK_THAT(element(xml, "der(position)"), Contains("derivative=\"4\""));
  CHECK_THAT(element(xml, "der(velocity)"), Contains("derivative=\"5\""));
  // The initial unknowns are all outputs, states and rates, each listed once.
  const std::string initial = structure.substr(structure.find("<InitialUnknowns>"));
  const auto variables = variables_of(rig);
  for (std::size_t i = 0; i < variables.size(); ++i) {
    CAPTURE(variables[i].name);
    const bool computed =
        variables[i].is_output() || variables[i].is_state || variables[i].derivative_of > 0;
    CHECK((initial.find("<Unknown index=\"" + std::to_string(i + 1) + "\"") != std::string::npos) ==
          computed);
  }
  CHECK_THAT(xml, Contains("<!-- 1 -->\n    <ScalarVariable name=\"reference\""));
}

TEST_CASE("fmu documentation: role and start of each variable, rates left out", "[report]") {
  model::ExportedRig rig = load_rig();
  rig.values.set("sample_time", 1e-3);
  report::FmuRequest request;
  request.name = "bench";
  request.rig = rig;
  request.origin = {{"rig", "bench"}, {"warning", "a <b>"}};
  const std::string page = report::fmu_documentation(request, variables_of(rig), "c++ -o x");
  const auto row = [](const std::string& name, const std::string& role) {
    return "<tr><td>" + name + "</td><td>" + role + "</td>";
  };
  CHECK_THAT(page,
             Contains(row("reference", "input")) && Contains(row("position", "state, output")) &&
                 Contains(row("force", "output")) && Contains(row("mass", "parameter")) &&
                 Contains(row("sample_time", "parameter, fixed")) &&
                 Contains(row("controller_held_output", "state")) && !Contains("der(position)"));
  CHECK_THAT(page, Contains("<td>warning</td><td>a &lt;b&gt;</td>"));
  CHECK_THAT(page, Contains("<pre>c++ -o x</pre>"));
}

TEST_CASE("fmu: an identifier of letters, digits and single underscores", "[report]") {
  using report::fmu_identifier;
  CHECK(fmu_identifier("azAZ09") == "azAZ09");
  CHECK(fmu_identifier("a - b") == "a_b");
  CHECK(fmu_identifier("--a--") == "a");
  CHECK(fmu_identifier("a_b") == "a_b");
  CHECK(fmu_identifier("a__b") == "a_b");
  CHECK(fmu_identifier("9") == "rig9");
  CHECK(fmu_identifier("0a") == "rig0a");
  CHECK(fmu_identifier("a9") == "a9");
  CHECK(fmu_identifier("").starts_with("rig"));
  CHECK(fmu_identifier("@[`{/:").starts_with("rig"));
}

TEST_CASE("fmu: the files of an archive, and a GUID of their content", "[report]") {
  report::FmuRequest request;
  request.rig = load_rig();
  request.name = "bench";
  request.identifier = "bench_4";
  const auto guid = [](const report::FmuRequest& of) {
    std::set<std::string> paths;
    std::string found;
    std::string rig;
    for (const report::FmuFile& file : report::fmu_files(of)) {
      CHECK(paths.insert(file.path).second);
      if (file.path == "modelDescription.xml") {
        const std::size_t at = file.content.find("guid=\"") + 6;
        found = file.content.substr(at, file.content.find('"', at) - at);
      }
      if (file.path == "resources/rig.txt") rig = file.content;
    }
    CHECK(paths.contains("documentation/index.html"));
    CHECK(paths.contains("binaries/linux64/" + of.identifier + ".so"));
    CHECK_THAT(rig, Contains("guid " + found + "\n"));
    return found;
  };
  const std::string one = guid(request);
  REQUIRE(one.size() == 38);
  for (const std::size_t at : {9U, 14U, 19U, 24U}) CHECK(one[at] == '-');
  CHECK(one.front() == '{');
  CHECK(one.back() == '}');
  request.rig.guid = "{left over}";
  CHECK(guid(request) == one);
  request.stop_s = 3.0;
  const std::string other = guid(request);
  CHECK(other != one);
  request.rig.values.set("mass", 86.0);
  CHECK(guid(request) != other);
}

TEST_CASE("zip: names, contents and dates of what is in it", "[report]") {
  const std::vector<report::FmuFile> files{
      {"a/b.txt", std::string(10'000, 'x')}, {"c", ""}, {"d", std::string("\0\xff\r\n", 4)}};
  const std::string bytes = report::zipped(files);
  zip_error_t error;
  zip_source_t* source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  const std::unique_ptr<zip_t, decltype(&zip_discard)> archive(
      zip_open_from_source(source, ZIP_RDONLY, &error), zip_discard);
  REQUIRE(archive);
  REQUIRE(zip_get_num_entries(archive.get(), 0) == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    CAPTURE(files[i].path);
    zip_stat_t stat;
    REQUIRE(zip_stat_index(archive.get(), i, 0, &stat) == 0);
    CHECK(stat.name == files[i].path);
    REQUIRE(stat.size == files[i].content.size());
    zip_file_t* file = zip_fopen_index(archive.get(), i, 0);
    std::string content(stat.size, '\0');
    CHECK(zip_fread(file, content.data(), content.size()) ==
          static_cast<zip_int64_t>(content.size()));
    zip_fclose(file);
    CHECK(content == files[i].content);
    zip_uint8_t system = 0;
    zip_uint32_t attributes = 0;
    zip_file_get_external_attributes(archive.get(), i, 0, &system, &attributes);
    CHECK(system == ZIP_OPSYS_UNIX);
    CHECK(attributes >> 16U == 0100644);
  }
  // 1980-01-01 in the local header of the first file, bytes 12 and 13.
  CHECK(static_cast<unsigned char>(bytes[12]) == 0x21);
  CHECK(bytes[13] == 0);
}
