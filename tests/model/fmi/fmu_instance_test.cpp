#include "model/fmi/fmu_instance.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "model/fmi/references.hpp"
#include "tests/model/two_chamber_rig.hpp"
#include "tests/support/temporary_folder.hpp"

// Tests which calls an importer may make to an instance, when, and with which values.

using namespace rigcal::model;
using Catch::Contains;
using rigcal::test::TemporaryFolder;

namespace {

ExportedRig exported(double sample_time_s = 0.0) {
  ExportedRig rig;
  rig.guid = "{1}";
  rig.values = paper_rig();
  rig.values.set("external_force", 30.0);
  rig.tolerance = 1e-5;
  if (sample_time_s > 0.0) rig.values.set("sample_time", sample_time_s);
  return rig;
}

ExportedRig with_tank_input() {
  ExportedRig rig;
  rig.guid = "{1}";
  rig.rig = single_rod_rig().rig;
  rig.values = single_rod_rig().values;
  rig.values.set("tank_pressure", 2e5);
  return rig;
}

/// An instance of a rig, with the folder of its resources.
struct Importer {
  TemporaryFolder folder;
  FmuInstance instance;

  explicit Importer(bool exchange, const ExportedRig& rig = exported())
      : instance(written(folder, rig), "{1}", exchange) {}

  static std::filesystem::path written(const TemporaryFolder& folder, const ExportedRig& rig) {
    folder.write(kRigFile, exported_rig_text(rig));
    return folder.path();
  }
  void start(double at_s = 0.0) {
    instance.set_up(at_s, nullptr);
    instance.enter_initialization();
    instance.exit_initialization();
  }
};

std::string complaint(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

unsigned parameter(const char* key) {
  return kParameterReference +
         static_cast<unsigned>(parameter_index(PlantKind::load_pressure, key));
}
constexpr unsigned kReference = 0;
constexpr unsigned kForce = 1;
constexpr unsigned kSupplyPressure = 2;
constexpr unsigned kTank = 3;

}  // namespace

TEST_CASE("fmu instance: an importer of another description is refused", "[model]") {
  const TemporaryFolder folder;
  Importer::written(folder, exported());
  CHECK_THAT(complaint([&] { FmuInstance(folder.path(), "{2}", true); }),
             Contains("the GUID is {2}, expected {1}"));
  CHECK(complaint([&] { FmuInstance(folder.path(), "{1}", true); }).empty());
}

TEST_CASE("fmu instance: it starts from the rig's own values", "[model]") {
  Importer importer(false);
  const InstanceState& state = importer.instance.state();
  CHECK(state.phase == Phase::instantiated);
  CHECK(state.tolerance == 1e-5);
  CHECK(state.inputs.external_load.value == 30.0);
  CHECK(state.inputs.supply_pressure_pa.value == exported().values["supply_pressure"]);
  CHECK(state.inputs.drive.value == 0.0);
  CHECK(importer.instance.real(kForce) == 30.0);
  CHECK(importer.instance.real(parameter("mass")) == exported().values["mass"]);
  CHECK_THAT(complaint([&] { importer.instance.real(kTank); }),
             Contains("no input has the value reference 3"));
  Importer with_tank(false, with_tank_input());
  CHECK(with_tank.instance.real(kTank) == 2e5);
}

TEST_CASE("fmu instance: tolerances between 0 and 0.1, and times that are numbers", "[model]") {
  Importer importer(false);
  for (const double tolerance : {1e-12, 0.05, 0.0999}) {
    importer.instance.set_up(3.0, &tolerance);
    CHECK(importer.instance.state().tolerance == tolerance);
  }
  CHECK(importer.instance.state().start_s == 3.0);
  CHECK(importer.instance.state().time_s == 3.0);
  for (const double tolerance : {0.0, -1e-6, 0.1, 1.0, kNaN, kInfinity})
    CHECK_THAT(complaint([&] { importer.instance.set_up(0.0, &tolerance); }),
               Contains("expected one between 0 and 0.1"));
  for (const double start : {kNaN, kInfinity, -kInfinity})
    CHECK_THAT(complaint([&] { importer.instance.set_up(start, nullptr); }),
               Contains("startTime: found"));
  importer.instance.set_up(-2.0, nullptr);
  CHECK(importer.instance.state().start_s == -2.0);
  CHECK(importer.instance.state().tolerance == 0.0999);  // unchanged
}

TEST_CASE("fmu instance: parameters within their limits, which are allowed", "[model]") {
  const auto& spec =
      parameter_table(PlantKind::load_pressure)[parameter("mass") - kParameterReference];
  Importer importer(false);
  for (const double value : {spec.lower, spec.upper, 77.0}) {
    importer.instance.set_real(parameter("mass"), value);
    CHECK(importer.instance.real(parameter("mass")) == value);
  }
  for (const double value : {std::nextafter(spec.lower, -1.0), std::nextafter(spec.upper, 1e99)})
    CHECK_THAT(complaint([&] { importer.instance.set_real(parameter("mass"), value); }),
               Contains("mass: found ") && Contains(" kg"));
  CHECK_THAT(complaint([&] { importer.instance.set_real(parameter("mass"), kNaN); }),
             Contains("mass: found nan, expected a finite number"));
  CHECK(importer.instance.real(parameter("mass")) == 77.0);
  for (const unsigned none :
       {parameter("position_gain"), parameter("transport_delay"), parameter("supply_pressure"),
        kParameterReference + 5000U, 100U, 200U})
    CHECK_THAT(complaint([&] { importer.instance.set_real(none, 1.0); }),
               Contains("no input or parameter has it"));
}

TEST_CASE("fmu instance: what may be set while it runs", "[model]") {
  Importer importer(false, exported(1e-3));
  importer.instance.set_real(parameter("sample_time"), 2e-3);
  importer.start();
  CHECK_THAT(complaint([&] { importer.instance.set_real(parameter("sample_time"), 1e-3); }),
             Contains("the instance is initialized for co-simulation, expected instantiated or in "
                      "initialization mode"));
  importer.instance.set_real(parameter("mass"), 70.0);
  CHECK(importer.instance.real(parameter("mass")) == 70.0);
  Importer exchange(true);
  exchange.start();
  exchange.instance.set_real(parameter("mass"), 70.0);  // in event mode
  exchange.instance.enter_continuous_mode();
  CHECK_THAT(complaint([&] { exchange.instance.set_real(parameter("mass"), 71.0); }),
             Contains("the instance is in continuous-time mode"));
  exchange.instance.set_real(kReference, 0.001);  // inputs may change at any time
  exchange.instance.terminate();
  CHECK_THAT(complaint([&] { exchange.instance.set_real(kReference, 0.0); }),
             Contains("the instance is terminated"));
}

TEST_CASE("fmu instance: one phase after the other", "[model]") {
  Importer one(true);
  FmuInstance& exchange = one.instance;
  CHECK_THAT(complaint([&] { exchange.exit_initialization(); }), Contains("is instantiated"));
  CHECK_THAT(complaint([&] { exchange.enter_event_mode(); }), Contains("is instantiated"));
  CHECK_THAT(complaint([&] { exchange.terminate(); }), Contains("is instantiated"));
  CHECK_THAT(complaint([&] { exchange.real(kStateReference); }),
             Contains("from initialization mode on"));
  CHECK_THAT(complaint([&] { exchange.states(); }), Contains("is instantiated"));
  exchange.enter_initialization();
  CHECK_THAT(complaint([&] { exchange.enter_initialization(); }),
             Contains("is in initialization mode, expected instantiated"));
  CHECK_THAT(complaint([&] { exchange.set_up(0.0, nullptr); }), Contains("in initialization mode"));
  CHECK(exchange.real(kStateReference) == 0.0);
  exchange.exit_initialization();
  CHECK(exchange.state().phase == Phase::event);
  CHECK_THAT(complaint([&] { exchange.step(0.0, 0.1); }), Contains("is in event mode"));
  exchange.enter_continuous_mode();
  CHECK_THAT(complaint([&] { exchange.enter_continuous_mode(); }),
             Contains("is in continuous-time mode, expected in event mode"));
  CHECK_THAT(complaint([&] { exchange.new_discrete_states(); }),
             Contains("expected in event mode"));
  exchange.set_time(0.5);
  CHECK(exchange.state().time_s == 0.5);
  CHECK_THAT(complaint([&] { exchange.set_time(kNaN); }), Contains("time: found nan"));
  exchange.enter_event_mode();
  exchange.enter_event_mode();
  exchange.terminate();
  CHECK(exchange.states().size() == 3);
  exchange.reset();
  CHECK(exchange.state().phase == Phase::instantiated);
  CHECK(exchange.state().time_s == 0.0);

  Importer two(false);
  two.start();
  CHECK(two.instance.state().phase == Phase::stepping);
  CHECK_THAT(complaint([&] { two.instance.set_time(0.0); }), Contains("for co-simulation"));
  CHECK_THAT(complaint([&] { two.instance.enter_event_mode(); }), Contains("for co-simulation"));
  const double x[3] = {0.0, 0.0, 0.0};
  CHECK_THAT(complaint([&] { two.instance.set_states(x, 3); }), Contains("for co-simulation"));
}

TEST_CASE("fmu instance: states as the importer sets them, all of them numbers", "[model]") {
  Importer importer(true);
  importer.start();
  importer.instance.enter_continuous_mode();
  const std::vector<double> x{0.001, -0.02, 3e5};
  importer.instance.set_states(x.data(), 3);
  CHECK(importer.instance.states() == x);
  for (unsigned i = 0; i < 3; ++i) CHECK(importer.instance.real(kStateReference + i) == x[i]);
  CHECK_THAT(complaint([&] { importer.instance.set_states(x.data(), 2); }),
             Contains("found room for 2 numbers, expected 3"));
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<double> bad = x;
    bad[i] = kInfinity;
    CHECK_THAT(complaint([&] { importer.instance.set_states(bad.data(), 3); }),
               Contains("state " + std::to_string(i) + ": found inf"));
  }
  CHECK(importer.instance.states() == x);
  const auto dx = importer.instance.derivatives();
  REQUIRE(dx.size() == 3);
  CHECK(dx[0] == -0.02);
  for (unsigned i = 0; i < 3; ++i) CHECK(importer.instance.real(kDerivativeReference + i) == dx[i]);
  CHECK(importer.instance.real(kOutputReference + static_cast<unsigned>(Output::load_pressure)) ==
        3e5);
  CHECK(importer.instance.real(kOutputReference + static_cast<unsigned>(Output::position)) ==
        0.001);
  for (const unsigned none : {103U, 203U, 300U + static_cast<unsigned>(kAllOutputs.size()), 99U})
    CHECK_THAT(complaint([&] { importer.instance.real(none); }),
               Contains("no variable has the value reference " + std::to_string(none)));
  CHECK(importer.instance.nominals() ==
        std::vector<double>{0.01, 0.1, 0.1 * exported().values["supply_pressure"]});
}

TEST_CASE("fmu instance: inputs act at once, each on what it is", "[model]") {
  Importer importer(true);
  importer.start();
  FmuInstance& instance = importer.instance;
  const ParameterValues values = exported().values;
  const auto acceleration = [&] { return instance.derivatives()[1]; };
  const double before = acceleration();
  CHECK(before == Approx(-30.0 / values["mass"]));  // at rest, without pressure
  instance.set_real(kForce, 30.0 + values["mass"]);
  CHECK(acceleration() == Approx(before - 1.0).margin(1e-9));
  instance.set_real(kForce, 30.0);
  CHECK(acceleration() == Approx(before).margin(1e-12));
  instance.set_real(kReference, 0.002);
  CHECK(instance.real(kOutputReference + static_cast<unsigned>(Output::command)) ==
        Approx(values["kp"] * (0.002 - instance.real(kStateReference))));
  const double flow = instance.derivatives()[2];
  instance.set_real(kSupplyPressure, 4.0 * values["supply_pressure"]);
  CHECK(instance.derivatives()[2] / flow ==
        Approx(2.0).epsilon(0.02));  // root of the pressure ratio
  CHECK_THAT(complaint([&] { instance.set_real(kTank, 1e5); }), Contains("no input has"));
  CHECK_THAT(complaint([&] { instance.set_real(kReference, kNaN); }),
             Contains("value reference 0: found nan"));
}

TEST_CASE("fmu instance: a step begins where the last one ended, and has a length", "[model]") {
  Importer importer(false);
  importer.start(10.0);
  FmuInstance& instance = importer.instance;
  instance.step(10.0, 0.1);
  CHECK(instance.state().time_s == Approx(10.1).epsilon(1e-15));
  instance.step(10.1 + 0.9e-4, 0.1);  // within a thousandth of the step
  CHECK(instance.state().time_s == Approx(10.2 + 0.9e-4).epsilon(1e-15));
  const double now = instance.state().time_s;
  for (const double off : {1.1e-4, -1.1e-4, 0.1})
    CHECK_THAT(complaint([&] { instance.step(now + off, 0.1); }),
               Contains("currentCommunicationPoint: found"));
  for (const double length : {0.0, -0.1})
    CHECK_THAT(complaint([&] { instance.step(now, length); }), Contains("expected one above 0"));
  for (const double length : {kNaN, kInfinity})
    CHECK_THAT(complaint([&] { instance.step(now, length); }), Contains("communicationStepSize"));
  CHECK_THAT(complaint([&] { instance.step(kNaN, 0.1); }), Contains("currentCommunicationPoint"));
  CHECK(instance.state().time_s == now);
}

TEST_CASE("fmu instance: the slope of an input holds for one step, from where it was", "[model]") {
  Importer importer(false);
  importer.start();
  FmuInstance& instance = importer.instance;
  const std::vector<std::pair<unsigned, double>> slopes{
      {kReference, 0.01}, {kForce, -5.0}, {kSupplyPressure, 1e5}};
  for (const auto& [input, slope] : slopes) instance.set_input_derivative(input, 1, slope);
  const double supply = instance.real(kSupplyPressure);
  instance.step(0.0, 0.5);
  CHECK(instance.real(kReference) == Approx(0.005));
  CHECK(instance.real(kForce) == Approx(30.0 - 2.5));
  CHECK(instance.real(kSupplyPressure) == Approx(supply + 5e4));
  instance.step(0.5, 0.5);
  CHECK(instance.real(kReference) == Approx(0.005));
  CHECK(instance.real(kForce) == Approx(27.5));
  // Outputs are those of the end of the step, even if they were read before it.
  const unsigned command = kOutputReference + static_cast<unsigned>(Output::command);
  instance.set_input_derivative(kReference, 1, 0.01);
  const double before = instance.real(command);
  instance.step(1.0, 0.1);
  CHECK(instance.real(command) ==
        Approx(exported().values["kp"] * (0.006 - instance.real(kStateReference))));
  CHECK(instance.real(command) != before);
  Importer with_tank(false, with_tank_input());
  with_tank.start();
  with_tank.instance.set_input_derivative(kTank, 1, 1e4);
  for (const double begin_s : {0.0, 0.5}) {
    with_tank.instance.step(begin_s, 0.5);
    CHECK(with_tank.instance.real(kTank) == Approx(2.05e5));
  }
  for (const int order : {0, 2, -1})
    CHECK_THAT(complaint([&] { instance.set_input_derivative(kForce, order, 1.0); }),
               Contains("found order " + std::to_string(order) + ", expected 1"));
  CHECK_THAT(complaint([&] { instance.set_input_derivative(kForce, 1, kNaN); }),
             Contains("derivative of value reference 1: found nan"));
  CHECK_THAT(complaint([&] { instance.set_input_derivative(kTank, 1, 1.0); }),
             Contains("no input has"));
  Importer early(false);
  CHECK_THAT(complaint([&] { early.instance.set_input_derivative(kForce, 1, 1.0); }),
             Contains("is instantiated"));
}

TEST_CASE("fmu instance: however a ramp is cut into steps, it leads to the same end", "[model]") {
  const auto position_after = [](const std::vector<double>& steps_s, double tolerance) {
    Importer importer(false);
    importer.instance.set_up(0.0, &tolerance);
    importer.instance.enter_initialization();
    importer.instance.exit_initialization();
    double t = 0.0;
    for (const double step_s : steps_s) {
      importer.instance.set_input_derivative(kReference, 1, 0.01);
      importer.instance.step(t, step_s);
      t += step_s;
    }
    return importer.instance.real(kStateReference);
  };
  const double whole = position_after({0.2}, 1e-9);
  CHECK(std::abs(whole) > 1e-4);
  CHECK(position_after({0.1, 0.1}, 1e-9) == Approx(whole).epsilon(1e-6));
  CHECK(position_after({0.05, 0.15}, 1e-9) == Approx(whole).epsilon(1e-6));
  // The tolerance allows a millionth of the peak per step.
  CHECK(position_after({0.2}, 1e-6) == Approx(whole).epsilon(1e-4));
}

TEST_CASE("exported_rig: a choice is one of two", "[model]") {
  const TemporaryFolder folder;
  for (const char* line : {"controller pdi", "controller", "initial gone", "controller given"}) {
    CAPTURE(line);
    folder.write(kRigFile, std::string("rigcal.rig/1\nplant load_pressure\n") + line + "\n");
    CHECK_THAT(complaint([&] { read_exported_rig(folder / kRigFile); }),
               Contains(std::string(kRigFile) + ":3: found"));
  }
  folder.write(kRigFile, "rigcal.rig/1\nplant load_pressure\ncontroller none\ninitial given\n");
  const ExportedRig rig = read_exported_rig(folder / kRigFile);
  CHECK(rig.rig.controller == ControllerKind::none);
  CHECK(rig.rig.initial == InitialState::given);
}

TEST_CASE("fmu instance: ticks of a sampled controller, a period apart from the start", "[model]") {
  Importer importer(true, exported(0.01));
  FmuInstance& instance = importer.instance;
  importer.start(2.0);
  CHECK(instance.next_tick_s() == 2.0);
  instance.set_real(kReference, 0.001);
  CHECK(instance.new_discrete_states());
  CHECK(instance.next_tick_s() == Approx(2.01).epsilon(1e-15));
  const double kp = exported().values["kp"];
  const unsigned command = kOutputReference + static_cast<unsigned>(Output::command);
  CHECK(instance.real(command) == Approx(kp * 0.001));
  CHECK_FALSE(instance.new_discrete_states());
  instance.set_real(kReference, 0.002);
  CHECK(instance.real(command) == Approx(kp * 0.001));  // the output keeps its value
  instance.set_time(2.01 - 0.01 * 1e-4);
  CHECK_FALSE(instance.new_discrete_states());
  instance.set_time(2.01 - 0.01 * 1e-7);  // importers add up times, which rounds them
  CHECK(instance.new_discrete_states());
  CHECK(instance.real(command) == Approx(kp * 0.002));
  CHECK(instance.state().ticks == 2);
  CHECK(instance.next_tick_s() == Approx(2.02).epsilon(1e-15));

  Importer continuous(true);
  continuous.start();
  CHECK(std::isinf(continuous.instance.next_tick_s()));
  CHECK_FALSE(continuous.instance.new_discrete_states());
}

TEST_CASE("fmu instance: a step takes the ticks within it, the one at its end with the next",
          "[model]") {
  Importer importer(false, exported(0.01));
  FmuInstance& instance = importer.instance;
  importer.start();
  const double kp = exported().values["kp"];
  const unsigned command = kOutputReference + static_cast<unsigned>(Output::command);
  instance.set_real(kReference, 0.001);
  // Before the first step, the controller's output is already that for the present inputs.
  CHECK(instance.real(command) == Approx(kp * 0.001));
  CHECK(instance.state().ticks == 0);
  instance.step(0.0, 0.03);
  CHECK(instance.state().ticks == 3);
  instance.step(0.03, 0.005);
  CHECK(instance.state().ticks == 4);
  instance.step(0.035, 0.004);
  CHECK(instance.state().ticks == 4);
  instance.step(0.039, 0.002);
  CHECK(instance.state().ticks == 5);
}

TEST_CASE("fmu instance: it goes back to what it was", "[model]") {
  Importer importer(false);
  FmuInstance& instance = importer.instance;
  importer.start();
  instance.set_real(kReference, 0.002);
  instance.step(0.0, 0.02);
  const InstanceState kept = instance.state();
  const double there = instance.real(kStateReference);
  const double acceleration = instance.real(kDerivativeReference + 1);
  instance.set_real(parameter("mass"), 500.0);
  instance.step(0.02, 0.02);
  CHECK(instance.real(kStateReference) != there);
  instance.restore(kept);
  CHECK(instance.real(kStateReference) == there);
  CHECK(instance.real(kDerivativeReference + 1) == acceleration);
  CHECK(instance.real(parameter("mass")) == exported().values["mass"]);
  CHECK(instance.state().time_s == Approx(0.02));
  instance.reset();
  CHECK(instance.real(kReference) == 0.0);
  CHECK(instance.real(kForce) == 30.0);
  CHECK(instance.state().phase == Phase::instantiated);
}

TEST_CASE("fmu instance: the initial state follows what is set before it is left", "[model]") {
  ExportedRig rig = exported();
  rig.rig.initial = InitialState::given;
  rig.values.set("initial_position", 0.0);
  Importer importer(false, rig);
  FmuInstance& instance = importer.instance;
  instance.enter_initialization();
  const double before = instance.real(kStateReference + 2);
  instance.set_real(kForce, 600.0);
  // In equilibrium, the load pressure balances the force.
  CHECK(instance.real(kStateReference + 2) - before ==
        Approx(570.0 / exported().values["piston_area"]).epsilon(1e-9));
  instance.exit_initialization();
  CHECK_THAT(complaint([&] { instance.set_real(parameter("initial_position"), 0.001); }),
             Contains("expected instantiated or in initialization mode"));
  const double held = instance.real(kStateReference + 2);
  instance.set_real(kForce, 30.0);
  CHECK(instance.real(kStateReference + 2) == held);
}

TEST_CASE("equations: where the valve, the stops and the spool have their kinks", "[model]") {
  ExportedRig rig = exported();
  rig.rig.controller = ControllerKind::none;
  const auto indicators = [](const ExportedRig& of, double drive, const std::vector<double>& x) {
    const auto equations = make_equations(of);
    RigInputs inputs;
    inputs.drive.value = drive;
    inputs.supply_pressure_pa.value = of.values["supply_pressure"];
    equations->set(of.values, inputs, 1.0);
    return equations->indicators(x);
  };
  const std::vector<double> rest(3, 0.0);
  CHECK(indicators(rig, 0.25, rest) == std::vector<double>{0.25});
  rig.values.set("valve_dead_band", 0.1);
  rig.values.set("valve_offset", 0.02);
  const auto banded = indicators(rig, 0.25, rest);
  REQUIRE(banded.size() == 2);
  CHECK(banded[0] == Approx(0.25 + 0.02 - 0.1));
  CHECK(banded[1] == Approx(0.25 + 0.02 + 0.1));
  rig.values.set("valve_time_constant", 0.01);
  rig.values.set("valve_rate_limit", 50.0);
  const auto limited = indicators(rig, 0.25, {0.0, 0.0, 0.0, 0.05});
  REQUIRE(limited.size() == 4);
  CHECK(limited[0] == Approx(0.05 + 0.02 - 0.1));  // limits apply to the spool, not to the command
  CHECK(limited[2] == Approx(50.0 - 20.0));        // 0.2 V in 10 ms
  CHECK(limited[3] == Approx(50.0 + 20.0));
}

TEST_CASE("equations: two chambers have the edges of four orifices and two stops", "[model]") {
  ExportedRig rig;
  rig.rig = {PlantKind::two_chamber, ControllerKind::none, InitialState::rest};
  rig.values = ParameterValues::defaults(PlantKind::two_chamber);
  rig.values.set("supply_pressure", 7e6);
  rig.values.set("stroke", 0.2);
  rig.values.set("valve_dead_band", 0.1);
  rig.values.set("overlap_supply_to_a", 0.01);
  rig.values.set("overlap_a_to_tank", 0.02);
  rig.values.set("overlap_supply_to_b", 0.03);
  rig.values.set("overlap_b_to_tank", 0.04);
  const auto equations = make_equations(rig);
  RigInputs inputs;
  inputs.drive.value = 0.25;
  inputs.supply_pressure_pa.value = 7e6;
  equations->set(rig.values, inputs, 1.0);
  const auto found = equations->indicators(equations->initial());
  REQUIRE(found.size() == 6);
  CHECK(found[0] == Approx(0.25 - 0.1 - 0.01));
  CHECK(found[1] == Approx(-0.25 - 0.1 - 0.02));
  CHECK(found[2] == Approx(-0.25 - 0.1 - 0.03));
  CHECK(found[3] == Approx(0.25 - 0.1 - 0.04));
  // Zero is the middle of the stroke, unless the retracted position is given.
  CHECK(found[4] == Approx(0.1));
  CHECK(found[5] == Approx(0.1));
}

TEST_CASE("equations: every state with the unit and size of what it is", "[model]") {
  ExportedRig rig = exported(1e-3);
  for (const char* key :
       {"valve_frequency", "valve_damping_ratio", "ki", "kd", "derivative_filter"})
    rig.values.set(key, 1.0);
  const auto states = describe_states(rig, make_equations(rig)->layout());
  const std::vector<std::pair<std::string, double>> expected{
      {"m", 0.01}, {"m/s", 0.1},   {"Pa", 0.1 * rig.values["supply_pressure"]},
      {"V", 1.0},  {"V/s", 100.0}, {"V", 1.0},
      {"m", 0.01}, {"V", 1.0}};
  REQUIRE(states.size() == expected.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    CAPTURE(states[i].name);
    CHECK(states[i].unit == expected[i].first);
    CHECK(states[i].nominal == Approx(expected[i].second));
    CHECK_FALSE(states[i].meaning.empty());
  }
  ExportedRig two;
  two.rig = {PlantKind::two_chamber, ControllerKind::none, InitialState::rest};
  two.values = ParameterValues::defaults(PlantKind::two_chamber);
  for (const char* key : {"hose_capacity_a", "hose_yield", "supply_resistance", "supply_capacity"})
    two.values.set(key, 1e-12);
  std::vector<std::string> names;
  for (const auto& each : describe_states(two, make_equations(two)->layout()))
    names.push_back(each.name + " " + each.unit);
  CHECK(std::vector<std::string>(names.begin(), names.begin() + 4) ==
        std::vector<std::string>{"position m", "velocity m/s", "pressure_a Pa", "pressure_b Pa"});
  CHECK(std::count(names.begin(), names.end(), "hose_memory_a 1") == 1);
  CHECK(std::count(names.begin(), names.end(), "hose_memory_b 1") == 1);
  CHECK(std::count(names.begin(), names.end(), "valve_supply_pressure Pa") == 1);
}
