#pragma once

#include <chrono>
#include <span>

#include "model/plant/layout.hpp"
#include "model/plant/rig.hpp"
#include "model/solver/sampled_period.hpp"
#include "model/solver/simulation.hpp"

namespace rigcal::model {

/// Everything that one simulation needs. Plant and number of states are fixed at compile time in
/// simulate_sized.cpp, which is compiled once per plant and number, so that the builds run in
/// parallel.
struct SizedRequest {
  const Layout& layout;
  InitialState initial;
  Before before;
  const ParameterValues& parameters;
  std::span<const int> free;
  const SimulationInputs& inputs;
  std::span<const double> times_s;
  std::span<const Output> outputs;
  const SimulationOptions& options;
  std::optional<SampledPeriod> period;  ///< period of the inputs, with which a steady state repeats
  std::chrono::steady_clock::time_point started;  ///< when the time limit max_seconds began to run
};

/// Instruction set of a compiled solver. `base` runs on every processor.
enum class InstructionSet { base, avx2 };

/// Returns the best instruction set that the processor supports and the solver was compiled for.
InstructionSet best_instruction_set();

/// @tparam N  room for states, at least as many as the layout has
template <typename Plant, int N, InstructionSet Set>
void simulate_sized(const SizedRequest& request, Simulation& result);

}  // namespace rigcal::model
