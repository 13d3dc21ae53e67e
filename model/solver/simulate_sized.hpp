#pragma once

#include <chrono>
#include <span>

#include "model/plant/layout.hpp"
#include "model/signal/sampled_period.hpp"
#include "model/simulate.hpp"

namespace rigcal::model {

/// Everything that one simulation needs, its plant and number of states fixed at compile time in
/// simulate_sized.cpp (compiled once per plant and number, so that the parts build side by side).
struct SizedRequest {
  const Layout& layout;
  InitialState initial;
  Before before;
  const Eigen::VectorXd* state;  ///< start of the run instead of `initial`; null: none
  const ParameterValues& parameters;
  std::span<const int> free;
  const SimulationInputs& inputs;
  std::span<const double> times_s;
  std::span<const Output> outputs;
  const SimulationOptions& options;
  std::optional<SampledPeriod> period;            ///< after which a steady state repeats itself
  std::chrono::steady_clock::time_point started;  ///< from when max_seconds counts
};

/// Instruction set of a compiled solver; `base` runs everywhere.
enum class InstructionSet { base, avx2 };

/// @return  of this processor, the best that the solver is compiled for
InstructionSet best_instruction_set();

/// @tparam N  room for the layout's states, at least as many
template <typename Plant, int N, InstructionSet Set>
void simulate_sized(const SizedRequest& request, Simulation& result);

}  // namespace rigcal::model
