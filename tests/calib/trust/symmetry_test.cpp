#include "calib/trust/symmetry.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/calib/twin.hpp"
#include "tests/model/two_chamber_rig.hpp"

namespace rigcal::calib {
namespace {

using Catch::Contains;
using datasets::Waveform;
using model::Experiment;

/// A rig with every term that involves a force, a pressure or a flow. Air is left out, because its
/// law depends on the atmospheric pressure.
Experiment everything(model::PlantKind plant) {
  const bool chambers = plant == model::PlantKind::two_chamber;
  Experiment e = chambers ? model::two_chamber_rig() : Experiment();
  e.set("stiffness", 2e4).set("coulomb_friction", 200.0).set("stribeck_friction", 300.0);
  e.set("external_force", 150.0).set("laminar_leakage", 2e-12).set("valve_null_leakage", 1e-12);
  e.set("load_gradient", 1e4).set("load_curvature", 1e5).set("leakage_resistance", 1e10);
  e.set("supply_resistance", 2e9).set("supply_capacity", 1e-12);
  if (!chambers) {  // once, since they are the same for both plants
    e.set("payload_mass", 20.0).set("payload_frequency", 300.0).set("payload_damping_ratio", 0.1);
    e.set("bristle_stiffness", 2e6).set("bristle_damping", 2e3);
  }
  if (chambers) {
    e.set("gravity", 9.8).set("tank_pressure", 2e5);
    e.set("external_leakage_a", 1e-12).set("external_leakage_b", 2e-12);
    e.set("hose_capacity_a", 2e-13).set("hose_capacity_b", 1e-13);
    e.set("hose_yield", 2e6).set("hose_yield_ratio", 0.5);
    e.set("initial_pressure_a", 3e6).set("initial_pressure_b", 2.9e6);
    e.set("stroke", 0.02);  // short enough to reach the end stops
  } else {
    e.set("initial_load_pressure", 1e5);
  }
  e.inputs.drive = model::Signal::square(0.015, 2.0);
  e.rig.initial = model::InitialState::given;
  e.outputs = {model::Output::position};
  e.options.tolerance = 1e-9;
  return e;
}

/// Terms of valve and pump that everything() lacks, because its valve is electric.
constexpr std::array<std::string_view, 10> kMetering{
    "pilot_gain",          "bypass_opening",       "return_line_opening", "return_line_resistance",
    "make_up_conductance", "compensator_pressure", "load_sensing_margin", "relief_pressure",
    "relief_conductance",  "accumulator_precharge"};

/// The loads of a table, which everything() lacks because it has a polynomial.
constexpr std::array<std::string_view, 6> kTable{"load_0",  "load_20", "load_40",
                                                 "load_60", "load_80", "load_100"};

Experiment tabled() {
  Experiment e = everything(model::PlantKind::load_pressure);
  e.set("load_gradient", 0.0).set("load_curvature", 0.0);
  e.set("load_table_from", -0.005).set("load_table_to", 0.005);
  for (std::size_t i = 0; i < kTable.size(); ++i) e.set(kTable[i], i % 2 == 0 ? 150.0 : -100.0);
  return e;
}

/// A rig with a pilot-operated valve, a pump and all of these terms except the accumulator, whose
/// gas law depends on the atmospheric pressure.
Experiment metered() {
  Experiment e = model::pilot_rig();
  e.set("pilot_gain", 8e-11).set("pilot_exponent", 1.6).set("return_dead_band", 0.8e6);
  e.set("return_line_opening", 3e-4).set("return_line_resistance", 2e9);
  e.set("bypass_opening", 5e-5).set("compensator_pressure", 8e5);
  e.set("supply_resistance", 2e9).set("supply_capacity", 5e-12).set("pump_flow", 5e-4);
  e.set("load_sensing_margin", 6e5).set("make_up_conductance", 2e-9).set("relief_pressure", 4e6);
  e.set("relief_conductance", 3e-10).set("external_force", -2e4).set("gain_b_to_tank", 20.0);
  e.set("load_gradient", 4e5);
  e.inputs.drive = model::Signal::sine(3e6, 0.8);
  e.times_s = model::grid(0.0, 2.5, 251);
  e.outputs = {model::Output::position};
  return e;
}

/// Returns the largest change in position, relative to its peak, if everything except `left_out` is
/// scaled by s = 2.
double change(const Experiment& e, std::string_view left_out) {
  Experiment scaled = e;
  for (const model::ParameterSpec& spec : model::parameter_table(e.rig.plant)) {
    double exponent = scaling_exponent(spec);
    if (spec.key == "leakage_smoothing") exponent = 1.0;
    if (exponent == 0.0 || spec.key == left_out || e.values[spec.key] == 0.0) continue;
    scaled.set(spec.key, e.values[spec.key] * std::pow(2.0, exponent));
  }
  const auto before = e();
  const auto after = scaled();
  REQUIRE(before.ok());
  REQUIRE(after.ok());
  return model::difference(before.outputs, after.outputs);
}

}  // namespace

TEST_CASE("scaling_exponent: positions stay where all that has one is scaled", "[calib]") {
  const auto plant = GENERATE(model::PlantKind::load_pressure, model::PlantKind::two_chamber);
  const Experiment e = everything(plant);
  CAPTURE(to_string(plant));
  // The limit is the tolerance of the simulations, which matters most at the end stops.
  CHECK(change(e, "") < 5e-6);
  for (const model::ParameterSpec& spec : model::parameter_table(plant)) {
    if (scaling_exponent(spec) == 0.0) continue;
    if (plant == model::PlantKind::two_chamber &&
        (spec.key == "payload_mass" || spec.key.starts_with("bristle")))
      continue;
    if (std::find(kMetering.begin(), kMetering.end(), spec.key) != kMetering.end()) continue;
    if (std::find(kTable.begin(), kTable.end(), spec.key) != kTable.end()) continue;
    CAPTURE(spec.key);
    // Each scaled parameter acts in this rig and matters for the symmetry.
    CHECK(spec.can_be_fitted);
    CHECK(e.values[spec.key] != 0.0);
    CHECK(change(e, spec.key) > 2e-5);
  }
}

TEST_CASE("scaling_exponent: a recorded pilot pressure stays", "[calib]") {
  const Experiment e = metered();
  CHECK(change(e, "") < 5e-6);
  for (const std::string_view key : kMetering) {
    if (key == "accumulator_precharge") continue;
    CAPTURE(key);
    CHECK(change(e, key) > 2e-5);
  }
}

TEST_CASE("scaling_exponent: the loads of a table are forces", "[calib]") {
  const Experiment e = tabled();
  CHECK(change(e, "") < 5e-6);
  for (const std::string_view key : kTable) {
    CAPTURE(key);
    CHECK(change(e, key) > 2e-5);
  }
}

TEST_CASE("scaling_exponent: what it is of", "[calib]") {
  const auto exponent = [](const char* key) {
    const auto plant = model::PlantKind::two_chamber;
    const int row = model::parameter_index(plant, key);
    REQUIRE(row >= 0);
    return scaling_exponent(model::parameter_table(plant)[static_cast<std::size_t>(row)]);
  };
  for (const char* key : {"mass", "supply_pressure", "supply_resistance", "stop_stiffness",
                          "hose_yield", "initial_pressure_a"})
    CHECK(exponent(key) == 1.0);
  for (const char* key : {"laminar_leakage", "hose_capacity_a", "supply_capacity"})
    CHECK(exponent(key) == -1.0);
  for (const char* key : {"valve_gain", "leakage_coefficient"}) CHECK(exponent(key) == -0.5);
  // Density is not scaled, sensors and controllers only involve positions and volts, and smoothing
  // has no physical meaning.
  for (const char* key : {"density", "area_a", "pressure_a_offset", "pressure_a_maximum", "kp",
                          "leakage_smoothing", "stop_damping"})
    CHECK(exponent(key) == 0.0);
}

TEST_CASE("symmetry: a prior alone tells the scale, as well as it is stated", "[calib]") {
  Twin twin;
  twin.free("mass", 85.0, 10.0, 500.0);
  twin.free("damping", 1000.0, 100.0, 5000.0);
  twin.free("stiffness", 2e4, 1e3, 1e5);
  twin.free("bulk_modulus", 6.89e8, 1e8, 2e9);
  auto& supply = twin.free("supply_pressure", 6.2e6, 1e6, 2e7);
  supply.prior = datasets::Prior{6.2e6, 0.05 * 6.2e6};
  twin.free("valve_gain", 4.06e-5, 1e-5, 2e-4);
  twin.free("leakage_coefficient", 0.35, 0.05, 2.0);
  twin.add("square", Waveform::square, 2.0, 0.01);
  const auto records = twin.records(200, 500.0, 3);
  const Problem problem = problem_of(twin, records);
  const auto found = scaling_symmetry(problem, problem.start(), 1.0, 1);
  REQUIRE(found.has_value());
  CHECK(found->unknowns.size() == 7);
  // Scaling by a factor of 1.5 changes the residual of the prior by 0.5 / 0.05, divided by ln 1.5.
  CHECK_THAT(found->relative_sd, Catch::WithinRel(0.05 * std::log(1.5) / 0.5, 0.02));
  CHECK_FALSE(found->holds());
  twin.setting("supply_pressure").prior->sd *= 10.0;  // now half of the value
  CHECK(scaling_symmetry(problem_of(twin, records), problem.start(), 1.0, 1)->holds());
}

TEST_CASE("symmetry: a known supply pressure leaves none", "[calib]") {
  // A slow, short signal: mass and bulk modulus together are determined to 10 % at best, but a
  // known supply pressure, valve gain and damping fix the scale.
  Twin twin;
  twin.free("mass", 70.0, 17.0, 425.0);
  twin.free("bulk_modulus", 800e6, 138e6, 3445e6);
  twin.add("sine", Waveform::sine, 0.1, 0.0508);
  const Fit found = fit(twin.campaign, twin.records(500, 100.0, 5), {});
  for (const std::string& text : found.combinations) CHECK_THAT(text, !Contains("symmetry"));
  for (const std::string& text : found.warnings) CHECK_THAT(text, !Contains("supply pressure"));
}

}  // namespace rigcal::calib
