#pragma once

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/model/rig.hpp"
#include "tests/support/sanitized.hpp"

// Compares the sensitivities of a scenario with central differences.

namespace rigcal::model {

using NamedValues = std::vector<std::pair<const char*, double>>;

struct Scenario {
  const char* name;
  Signal drive;
  NamedValues values;
  ControllerKind controller = ControllerKind::pid;
  InitialState initial = InitialState::rest;
  bool recorded_loads = false;
  Feedback feedback = Feedback::position;
  Before before = Before::hold;
};

inline Experiment experiment(const Scenario& s, const Experiment& rig = {}) {
  Experiment e = rig;
  e.rig.controller = s.controller;
  e.rig.initial = s.initial;
  e.rig.feedback = s.feedback;
  e.inputs.drive = s.drive;
  if (parameter_index(e.rig.plant, "kp") >= 0) e.set("kp", 900.0);
  for (const auto& [key, value] : s.values) e.set(key, value);
  if (s.recorded_loads) {
    e.inputs.external_load = Signal::linear({0.0, 0.05, 0.1}, {0.0, 500.0, -200.0});
    e.inputs.supply_pressure_pa = Signal::ripple(6e6, 2e5, 20.0, 0.4);
  }
  e.times_s.clear();
  for (int i = 0; i < 50; ++i) e.times_s.push_back(0.00131 + 0.00253 * i);  // avoids every edge
  if (s.initial == InitialState::rest) e.times_s.insert(e.times_s.begin(), 0.0);
  e.rig.before = s.before;
  e.inputs.drive_begins_s = e.times_s.front();
  e.outputs.assign(kAllOutputs.begin(), kAllOutputs.end());
  e.options.tolerance = 1e-9;
  // If the solver could switch methods, the errors of the two runs would differ more and would not
  // cancel in the difference.
  e.options.method = Method::rosenbrock;
  return e;
}

/// Parameters in use that may be fitted.
inline std::vector<int> fittable(const Experiment& e) {
  std::vector<int> result;
  const auto table = parameter_table(e.rig.plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const bool in_use = e.values.given[i] || table[i].kind == ParameterKind::plant;
    if (in_use && table[i].can_be_fitted) result.push_back(static_cast<int>(i));
  }
  return result;
}

/// Central difference of all outputs with respect to one parameter.
inline Eigen::MatrixXd difference_by(Experiment e, int index, double relative_step) {
  e.free.clear();
  const double value = e.values.value[static_cast<std::size_t>(index)];
  const double step = value != 0.0 ? relative_step * std::abs(value) : relative_step;
  e.values.set(index, value + step);
  const Simulation above = e();
  e.values.set(index, value - step);
  const Simulation below = e();
  REQUIRE(above.ok());
  REQUIRE(below.ok());
  return (above.outputs - below.outputs) / (2.0 * step);
}

/// Relative steps of the differences. With the first step, truncation in the ringing is (587 rad/s
/// 0.13 s / 2 1e-4)^2 / 6 = 2e-6. The second step is for cases in which the errors of the two runs
/// are less alike, although a kink within it would disturb the difference. A wrong sensitivity
/// disagrees with both.
inline constexpr std::array kRelativeSteps{1e-4, 1e-3};

/// Compares all sensitivities of an experiment with differences. Adds the parameters that have an
/// effect to `seen`.
///
/// @param parts  for an output that is a difference: peak of its terms, which determines its noise
inline void check_sensitivities(Experiment e, std::set<int>& seen,
                                const std::map<Output, double>& parts = {}) {
  e.free = fittable(e);
  const Simulation run = e();
  INFO(run.reason);
  REQUIRE(run.ok());
  for (std::size_t j = 0; j < e.free.size(); ++j) {
    const auto index = static_cast<std::size_t>(e.free[j]);
    const std::string key(parameter_table(e.rig.plant)[index].key);
    const bool at_zero = e.values.value[index] == 0.0;
    if (at_zero || std::isinf(e.values.value[index])) continue;
    if (test::kSanitized && seen.count(e.free[j]) == 1) continue;  // once per parameter
    const double value = std::abs(e.values.value[index]);
    const Eigen::MatrixXd fine = difference_by(e, e.free[j], kRelativeSteps[0]);
    std::optional<Eigen::MatrixXd> coarse;
    for (std::size_t k = 0; k < e.outputs.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      const Eigen::VectorXd exact = run.sensitivities[k].col(static_cast<Eigen::Index>(j));
      const auto part = parts.find(e.outputs[k]);
      const double least = part == parts.end() ? 0.0 : part->second;
      const double output_peak = std::max(least, peak(run.outputs.col(column)));
      // Noise of the difference: errors of 1e-9 per step, mostly alike in both runs, divided by the
      // step. The noise is larger at zero pressure, where the leak's root is steep.
      const auto noise_of = [&](double step) { return 5e-8 * output_peak / (step * value); };
      const auto agrees = [&](const Eigen::VectorXd& difference, double step) {
        return peak(exact - difference) <= 2e-3 * peak(difference) + noise_of(step);
      };
      CAPTURE(key, output_name(e.outputs[k]), peak(exact));
      if (!agrees(fine.col(column), kRelativeSteps[0])) {
        if (!coarse) coarse = difference_by(e, e.free[j], kRelativeSteps[1]);
        CAPTURE(peak(exact - fine.col(column)), peak(exact - coarse->col(column)));
        CHECK(agrees(coarse->col(column), kRelativeSteps[1]));
      }
      const double noise = noise_of(kRelativeSteps[0]);
      if (peak(exact) > 10.0 * noise) seen.insert(e.free[j]);
    }
  }
}

/// Checks that every parameter that can be fitted was seen, and no other.
inline void check_all_seen(PlantKind plant, const std::set<int>& seen) {
  const auto table = parameter_table(plant);
  for (std::size_t i = 0; i < table.size(); ++i) {
    CAPTURE(table[i].key);
    CHECK((seen.count(static_cast<int>(i)) == 1) == table[i].can_be_fitted);
  }
}

}  // namespace rigcal::model
