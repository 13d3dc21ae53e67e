// Tests the internal leak as a single law from laminar to turbulent (docs/model.md, section 2).

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "tests/model/sensitivity.hpp"
#include "tests/model/two_chamber_rig.hpp"

using namespace rigcal::model;
using Catch::WithinRel;

namespace {

/// Pressure across the piston and its leakage, for a piston under load with the valve closed.
std::pair<double, double> held_leak(Experiment e, double load_n) {
  e.rig.controller = ControllerKind::none;
  e.inputs.drive = Signal::constant(0.0);
  e.set("external_force", load_n).set("leakage_coefficient", 0.5);
  e.set("leakage_resistance", 2e11);
  e.rig.initial = InitialState::given;  // pressures that balance the load
  e.times_s = {0.0};
  e.outputs = {Output::load_pressure, Output::leakage_flow};
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  return {run.outputs(0, 0), run.outputs(0, 1)};
}

}  // namespace

TEST_CASE("leak: orifice and laminar path in series are one law", "[model]") {
  for (const Experiment& rig : {Experiment(), single_rod_rig()}) {
    const double area = rig.values["leakage_area"];
    const double density = rig.values["density"];
    for (const double load_n : {-400.0, 3.0, 60.0, 400.0}) {
      const auto [head_pa, flow] = held_leak(rig, load_n);
      // The line takes the pressure R Q, the orifice the rest.
      const double conductance = 0.5 * area * std::sqrt(2.0 / density);
      const double rest_pa = std::abs(head_pa) - 2e11 * std::abs(flow);
      REQUIRE(rest_pa > 0.0);
      CHECK_THAT(std::abs(flow), WithinRel(conductance * std::sqrt(rest_pa), 1e-3));
      CHECK(flow * head_pa > 0.0);
    }
  }
}

TEST_CASE("leak: sensitivities of the one law are exact against differences", "[model]") {
  const NamedValues values{{"leakage_coefficient", 0.5}, {"leakage_resistance", 2e11}};
  std::set<int> seen;
  const Scenario scenario{"one law", Signal::sine(0.01, 9.0), values};
  check_sensitivities(experiment(scenario), seen);
  CHECK(seen.count(parameter_index(PlantKind::load_pressure, "leakage_resistance")) == 1);
}
