#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/model/two_chamber_rig.hpp"
#include "tests/support/sanitized.hpp"

using namespace rigcal::model;

namespace {

struct Case {
  std::string name;
  Experiment experiment;
};

/// Rigs that together have every kind of state.
std::vector<Case> cases() {
  Experiment loop;
  loop.inputs.drive = Signal::sine(0.02, 4.0);
  loop.set("kp", 300.0).set("ki", 200.0).set("kd", 1.0).set("derivative_filter", 300.0);
  loop.set("valve_time_constant", 4e-3).set("transport_delay", 3e-3);
  Experiment open = single_rod_rig();
  open.inputs.drive = Signal::sine(2.0, 5.0);
  open.set("valve_frequency", 400.0).set("valve_damping_ratio", 0.8);
  open.set("hose_capacity_a", 3e-13).set("hose_capacity_b", 2e-13).set("hose_yield", 6e5);
  open.set("supply_resistance", 2e10).set("supply_capacity", 5e-12).set("coulomb_friction", 30.0);
  open.set("friction_smoothing", 0.02);
  std::vector<Case> result{{"loop with lag and delay", loop}, {"two chambers", open}};
  for (Case& each : result) {
    each.experiment.times_s = grid(0.0, 0.4, 81);
    each.experiment.options.tolerance = 3e-10;
    for (const char* key : {"mass", "bulk_modulus", "valve_gain", "supply_pressure", "damping"})
      each.experiment.free.push_back(parameter_index(each.experiment.rig.plant, key));
  }
  return result;
}

Simulation from(const Experiment& e, const Eigen::VectorXd& state) {
  Simulation run =
      simulate_from(state, e.rig, e.values, e.free, e.inputs, e.times_s, e.outputs, e.options);
  INFO(run.reason);
  REQUIRE(run.ok());
  return run;
}

/// The experiment restricted to its samples from `first` to `last`.
Experiment part(Experiment e, int first, int last) {
  e.times_s = {e.times_s.begin() + first, e.times_s.begin() + last + 1};
  return e;
}

}  // namespace

TEST_CASE("simulate_from: two halves are the whole", "[model]") {
  for (const auto& [name, e] : cases()) {
    CAPTURE(name);
    const auto parameters = static_cast<Eigen::Index>(e.free.size());
    const Simulation whole = e();
    REQUIRE(whole.ok());
    const Simulation first = part(e, 0, 37)();
    REQUIRE(first.ok());
    const Simulation second = from(part(e, 37, 80), first.end_state);
    CHECK(difference(whole.outputs.bottomRows(44), second.outputs) < 1e-6);
    const auto floor = whole.state_floor.array();
    CHECK(peak(((whole.end_state - second.end_state).array() / floor).matrix()) < 1.0);

    // Chain rule: the first half changes the state from which the second half starts.
    const Eigen::Index states = first.end_state.size();
    REQUIRE(second.end_sensitivities.cols() == parameters + states);
    const Eigen::MatrixXd passed_on =
        second.end_sensitivities.leftCols(parameters) +
        second.end_sensitivities.rightCols(states) * first.end_sensitivities;
    for (Eigen::Index j = 0; j < parameters; ++j) {
      const Eigen::ArrayXd scaled = whole.end_sensitivities.col(j).array() / floor;
      const Eigen::ArrayXd error = passed_on.col(j).array() / floor - scaled;
      CAPTURE(j);
      CHECK(error.abs().maxCoeff() < 1e-4 * scaled.abs().maxCoeff());
    }
  }
}

TEST_CASE("simulate_from: sensitivities to the state against differences", "[model]") {
  for (const auto& [name, e] : cases()) {
    CAPTURE(name);
    const Experiment rest = part(e, 37, rigcal::test::kSanitized ? 47 : 80);
    const Eigen::VectorXd state = part(e, 0, 37)().end_state;
    const Simulation run = from(rest, state);
    const auto parameters = static_cast<Eigen::Index>(e.free.size());
    for (Eigen::Index i = 0; i < state.size(); ++i) {
      CAPTURE(i);
      const double step = 3.0 * run.state_floor(i);
      Eigen::VectorXd above = state;
      Eigen::VectorXd below = state;
      above(i) += step;
      below(i) -= step;
      const Simulation high = from(rest, above);
      const Simulation low = from(rest, below);
      const Eigen::VectorXd by_end = (high.end_state - low.end_state) / (2.0 * step);
      const Eigen::ArrayXd end_error =
          (run.end_sensitivities.col(parameters + i) - by_end).array() / run.state_floor.array();
      const Eigen::ArrayXd end_size = by_end.array() / run.state_floor.array();
      // Allows for errors of 1e-9 in states of some 1e4 floors, with differences over 3 floors.
      CHECK((end_error * run.state_floor(i)).abs().maxCoeff() <
            1e-3 * (end_size * run.state_floor(i)).abs().maxCoeff() + 1e-4);
      for (std::size_t k = 0; k < e.outputs.size(); ++k) {
        const auto column = static_cast<Eigen::Index>(k);
        const Eigen::VectorXd expected =
            (high.outputs.col(column) - low.outputs.col(column)) / (2.0 * step);
        const Eigen::VectorXd exact = run.sensitivities[k].col(parameters + i);
        const double noise = 1e-7 * peak(run.outputs.col(column)) / step;
        CHECK(peak(exact - expected) <= 1e-3 * peak(expected) + noise);
      }
    }
  }
}

TEST_CASE("simulate_from: what it refuses", "[model]") {
  Experiment e;
  const Eigen::VectorXd state = e().end_state;
  REQUIRE(state.size() == 3);
  const auto go_on = [&](const Eigen::VectorXd& at) {
    return simulate_from(at, e.rig, e.values, {}, e.inputs, e.times_s, e.outputs, e.options);
  };
  CHECK(go_on(state).ok());
  CHECK_THROWS_AS(go_on(state.head(2)), std::invalid_argument);
  CHECK_THROWS_AS(go_on(Eigen::VectorXd::Constant(3, kNaN)), std::invalid_argument);
  e.set("sample_time", 1e-3);
  CHECK_THROWS_AS(go_on(e().end_state), std::invalid_argument);
}
