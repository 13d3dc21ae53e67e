#pragma once

#include <catch2/catch.hpp>
#include <chrono>
#include <optional>

#include "model/plant/two_chamber.hpp"
#include "model/solver/run.hpp"
#include "tests/model/rig.hpp"

namespace rigcal::model {

/// State of a rig with two chambers, in the order of Layout. Those it does not have are zero.
using TwoChamberState = State<12, 0>;

struct EndOfRun {
  TwoChamberState state{};
  Eigen::RowVectorXd outputs;  ///< at the last sample, in the order of the experiment
};

/// Runs a rig with two chambers. Of its inputs, only the drive and the supply pressure may vary.
///
/// @param from  state at the first sample; null: the initial state of the rig
inline EndOfRun end_of_run(const Experiment& e, const TwoChamberState* from = nullptr) {
  constexpr int kRoom = static_cast<int>(std::tuple_size_v<TwoChamberState>);
  const Layout layout = layout_of(e.rig, e.values, {}, TwoChamberPlant::kStates);
  const double start_s = e.times_s.front();
  std::optional<InputTrack> supply;
  if (e.inputs.supply_pressure_pa) supply.emplace(*e.inputs.supply_pressure_pa, start_s, 0.0);
  System<TwoChamberPlant, kRoom, 0> system(
      layout, e.values, {},
      InputTrack(e.inputs.drive, start_s, e.values["transport_delay"], e.rig.before,
                 e.inputs.drive_begins_s),
      std::nullopt, std::move(supply), std::nullopt);
  TwoChamberState start = system.initial(e.rig.initial, e.rig.before, 0.0);
  system.forget_hoses(start, 0.0);
  Simulation result;
  result.outputs.resize(static_cast<Eigen::Index>(e.times_s.size()),
                        static_cast<Eigen::Index>(e.outputs.size()));
  result.sensitivities.resize(e.outputs.size());
  Run<TwoChamberPlant, kRoom, 0> run(std::move(system), {}, e.times_s, e.outputs, e.options,
                                     std::nullopt, std::chrono::steady_clock::now());
  run(from != nullptr ? *from : start, result, 0, 0);
  INFO(result.reason);
  REQUIRE(result.ok());
  return {run.state(), result.outputs.bottomRows(1)};
}

}  // namespace rigcal::model
