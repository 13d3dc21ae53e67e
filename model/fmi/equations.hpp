#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "model/fmi/exported_rig.hpp"
#include "model/plant/layout.hpp"

namespace rigcal::model {

/// An input during one step: a straight line that starts at `value`.
struct Ramp {
  double value = 0.0;
  double slope_per_s = 0.0;
};

/// External inputs of a rig. The tank pressure is used only if the plant has a tank.
struct RigInputs {
  Ramp drive;  ///< reference [m] or valve command [V]
  Ramp external_load;
  Ramp supply_pressure_pa;
  Ramp tank_pressure_pa;
};

/// Data that co-simulation keeps between steps in addition to the states.
struct StepMemory {
  double planned_step_s = 0.0;  ///< 0: not planned yet
  std::vector<double> peak;     ///< shape (states): largest size of each state so far
};

/// The equations of a rig with any plant and any number of states. Time counts from the beginning
/// of a step.
class Equations {
 public:
  virtual ~Equations() = default;

  virtual const Layout& layout() const = 0;

  /// Sets parameters and inputs. The slopes of the inputs are valid for `length_s` > 0.
  virtual void set(const ParameterValues& values, const RigInputs& inputs, double length_s) = 0;

  virtual std::vector<double> initial() const = 0;
  virtual std::vector<double> derivatives(std::span<const double> x) const = 0;
  virtual double output(Output output, std::span<const double> x) const = 0;

  /// Quantities that change sign where the right-hand side has a kink: limits, edges of the valve,
  /// end stops.
  virtual std::vector<double> indicators(std::span<const double> x) const = 0;

  /// Applies one tick of the sampled controller.
  virtual void tick(std::span<double> x, double time_s) const = 0;

  /// Advances the states from one time within the step to another.
  ///
  /// @param tolerance  local error per step, relative to the running peak of each state
  /// @throws std::runtime_error  if the step size vanishes or a state is no longer finite
  virtual void advance(std::vector<double>& x, StepMemory& memory, double from_s, double to_s,
                       double tolerance) const = 0;
};

std::unique_ptr<Equations> make_equations(const ExportedRig& rig);

/// A state as the model description of the FMU presents it.
struct StateDescription {
  std::string name;     ///< name of the output with the same value, if there is one
  std::string unit;     ///< SI, as in a ParameterSpec
  std::string meaning;  ///< one line
  double nominal;       ///< typical size, from which an importer derives its absolute tolerance
};

/// Describes the states in the order of a layout.
std::vector<StateDescription> describe_states(const ExportedRig& rig, const Layout& layout);

}  // namespace rigcal::model
