#include "bench/two_chamber_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/clock.hpp"
#include "model/simulate.hpp"

namespace rigcal::bench {
namespace {

using model::Output;
using model::PlantKind;

/// Returns the values of a 16/10 x 200 mm cylinder with hoses at 44 bar, as on a training stand.
model::ParameterValues single_rod() {
  auto values = model::ParameterValues::defaults(PlantKind::two_chamber);
  for (const auto& [key, value] : std::initializer_list<std::pair<std::string_view, double>>{
           {"mass", 4.0},
           {"damping", 200.0},
           {"stiffness", 0.0},
           {"area_a", 2.011e-4},
           {"area_b", 1.225e-4},
           {"stroke", 0.2},
           {"dead_volume_a", 2.6e-4},
           {"dead_volume_b", 1.1e-4},
           {"supply_pressure", 4.4e6},
           {"tank_pressure", 1e5},
           {"density", 870.0},
           {"bulk_modulus", 8e8},
           {"discharge_coefficient", 0.6},
           {"area_gradient", 0.01},
           {"valve_gain", 2.2e-5},
           {"valve_dead_band", 0.2},
           {"valve_time_constant", 5e-3},
           {"coulomb_friction", 70.0},
           {"leakage_coefficient", 0.0},
           {"leakage_area", 0.0},
           {"laminar_leakage", 1e-13},
       }) {
    values.set(key, value);
  }
  return values;
}

}  // namespace

void two_chamber_record(int rounds) {
  const model::ParameterValues values = single_rod();
  std::vector<int> free;
  for (const char* key :
       {"mass", "damping", "dead_volume_a", "dead_volume_b", "supply_pressure", "bulk_modulus",
        "valve_gain", "valve_dead_band", "coulomb_friction", "laminar_leakage"})
    free.push_back(model::parameter_index(PlantKind::two_chamber, key));
  model::Rig rig;
  rig.plant = PlantKind::two_chamber;
  rig.controller = model::ControllerKind::none;
  std::vector<double> times;
  std::vector<double> every;
  for (int k = 0; k <= 200'000; ++k) {
    times.push_back(k / 1e4);
    every.push_back(1.5 * std::sin(9.0 * times.back()) + 0.5 * std::sin(61.0 * times.back()));
  }
  struct Row {
    const char* name_of_command;
    const model::Signal* command;
    const char* required;
  };
  const auto changing = model::Signal::held(times, every);
  const auto five = model::Signal::held({0.0, 4.0, 8.0, 12.0, 16.0}, {1.0, -1.0, 2.0, -2.0, 0.0});
  const std::vector<Output> outputs{Output::position, Output::pressure_a, Output::pressure_b};
  fmt::print(
      "### The same of a cylinder with two chambers, a valve of first order, dry friction\n\n");
  fmt::print("| command | CPU ms | required | steps |\n| --- | --- | --- | --- |\n");
  for (const Row& row :
       {Row{"changes at every sample", &changing, "1000"}, Row{"five steps", &five, "200"}}) {
    model::SimulationInputs inputs;
    inputs.drive = *row.command;
    model::SimulationOptions options;
    std::vector<double> round_ms;
    long steps = 0;
    for (int r = 0; r < std::max(3, rounds / 5); ++r) {
      const double begin = cpu_ms();
      const auto result = model::simulate(rig, values, free, inputs, times, outputs, options);
      round_ms.push_back(cpu_ms() - begin);
      steps = result.steps + result.rejected_steps;
      if (result.ok()) continue;
      fmt::print(stderr, "two chambers: {}\n", result.reason);
      std::exit(1);
    }
    fmt::print("| {} | {:.0f} | {} | {} |\n", row.name_of_command, median(round_ms), row.required,
               steps);
  }
  fmt::print("\n");
}

}  // namespace rigcal::bench
