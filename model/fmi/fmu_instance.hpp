#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/fmi/equations.hpp"

namespace rigcal::model {

/// State of an instance as the standard defines it. It decides which calls are allowed.
enum class Phase {
  instantiated,
  initialization,
  event,       ///< in model exchange
  continuous,  ///< in model exchange
  stepping,    ///< in co-simulation
  terminated,
};

/// Everything that changes during the life of an instance. fmi2GetFMUstate returns a copy of it.
struct InstanceState {
  Phase phase = Phase::instantiated;
  ParameterValues values;
  RigInputs inputs;
  double tolerance = 1e-6;
  double start_s = 0.0;
  double time_s = 0.0;
  long ticks = 0;  ///< number of ticks of a sampled controller so far
  std::vector<double> x;
  StepMemory memory;
};

/// Checks the length of an array from the importer.
///
/// @throws std::runtime_error  if the length is not the expected one
void require_size(std::size_t count, std::size_t expected);

/// One instance of an FMU, for either interface. A method that cannot do what the importer requests
/// throws std::runtime_error with the reason and leaves the instance unchanged.
class FmuInstance {
 public:
  /// @param guid  GUID of the model description that the importer has read
  FmuInstance(const std::filesystem::path& resources, const std::string& guid, bool exchange);

  void set_up(double start_s, const double* tolerance);
  void enter_initialization();
  void exit_initialization();
  void enter_event_mode();
  void enter_continuous_mode();
  void terminate();
  void reset();

  double real(unsigned reference);
  void set_real(unsigned reference, double value);
  void set_input_derivative(unsigned reference, int order, double value);

  void set_time(double time_s);
  void set_states(const double* x, std::size_t count);
  const std::vector<double>& states();
  std::vector<double> derivatives();
  std::vector<double> indicators();
  std::vector<double> nominals();

  /// Applies the controller's tick if it is due, and returns whether it was.
  bool new_discrete_states();
  /// Time at which the next tick is due; infinity if there is none.
  double next_tick_s() const;

  /// Advances a co-simulation by one step.
  void step(double time_s, double step_s);

  const InstanceState& state() const { return state_; }
  void restore(const InstanceState& state);

 private:
  void require_phase(std::initializer_list<Phase> allowed) const;
  Ramp& input(unsigned reference);
  /// Row in the parameter table; std::nullopt if no exported parameter has this reference.
  std::optional<std::size_t> parameter_row(unsigned reference) const;
  double next_tick_s(const InstanceState& state) const;
  /// Time difference within which a tick counts as due.
  double slack_s(const InstanceState& state, double time_s) const;
  bool tick_is_due(const InstanceState& state, double time_s) const;
  /// Updates equations and states after a change of parameters or inputs. Called before anything is
  /// computed from them.
  void refresh();

  ExportedRig rig_;
  bool exchange_;
  std::unique_ptr<Equations> equations_;
  std::vector<int> parameters_;
  InstanceState state_;
  bool stale_ = true;  ///< equations_ lacks the present parameters and inputs
};

}  // namespace rigcal::model
