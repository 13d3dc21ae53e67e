#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/fmi/equations.hpp"

namespace rigcal::report {

enum class Causality { input, output, local, parameter };

/// A scalar variable of an FMU. All variables are real and in SI units.
struct FmuVariable {
  std::string name;
  unsigned reference = 0;
  Causality causality = Causality::local;
  bool tunable = false;  ///< for a parameter: may change during the simulation
  std::string unit;
  std::string meaning;
  std::optional<double> start;
  std::optional<double> lower;
  std::optional<double> upper;
  std::optional<double> nominal;
  std::size_t derivative_of = 0;  ///< index of the variable of which this is the derivative; 0:
                                  ///< none
  bool is_state = false;
  bool changes_at_ticks = false;  ///< true for a state of the sampled controller

  bool is_output() const { return causality == Causality::output; }
};

/// Returns the variables of a rig in the order of its model description: inputs, states and
/// outputs, derivatives, parameters.
std::vector<FmuVariable> fmu_variables(const model::ExportedRig& rig, const model::Layout& layout);

}  // namespace rigcal::report
