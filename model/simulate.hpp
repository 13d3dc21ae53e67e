#pragma once

#include <span>

#include "model/plant/rig.hpp"
#include "model/solver/simulation.hpp"

namespace rigcal::model {

/// Number of states of a rig, and the largest number that the solvers for its plant support.
struct StateCount {
  int needed = 0;
  int room = 0;
};
StateCount count_states(const Rig& rig, const ParameterValues& parameters);

/// Simulates the rig from the first to the last of `times_s`.
///
/// @param parameters  SI values, and which of them were given, which decides on the optional terms
/// @param free        table indices of the parameters with sensitivities; may be empty
/// @param times_s     shape (samples), increasing, at least one
/// @param outputs     what to return, in this order
/// @return            a run that cannot be simulated is reported in `status`, not thrown
/// @throws std::invalid_argument  if a size, the order of the times or an option is invalid
Simulation simulate(const Rig& rig, const ParameterValues& parameters, std::span<const int> free,
                    const SimulationInputs& inputs, std::span<const double> times_s,
                    std::span<const Output> outputs, const SimulationOptions& options = {});

}  // namespace rigcal::model
