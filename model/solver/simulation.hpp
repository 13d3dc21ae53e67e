#pragma once

#include <Eigen/Core>
#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"

namespace rigcal::model {

enum class Method {
  rosenbrock,  ///< RODAS4P, L-stable
  dopri5,      ///< Odeint's Dormand-Prince 5(4)
};

struct SimulationOptions {
  Method method = Method::rosenbrock;
  /// Allowed local error per step, relative to the running peak of each state and sensitivity.
  double tolerance = 1e-6;
  /// Factor by which the local error of a sensitivity may exceed `tolerance`. A fit needs
  /// derivatives only to one part in a thousand.
  double sensitivity_looseness = 50.0;
  /// Whether to extrapolate the rest of a run from its last periods, once it has reached its
  /// periodic steady state or approaches it in a known way. Otherwise every period is simulated.
  bool periodic_steady_state = true;
  long max_steps = 5'000'000;                 ///< limit for accepted and rejected steps together
  double max_seconds = 120.0;                 ///< wall time of one simulation
  const std::atomic<bool>* cancel = nullptr;  ///< the simulation ends when this becomes true

  /// @throws std::invalid_argument  if a field is invalid; the message names the field
  void validate() const;
};

enum class SimulationStatus {
  ok,
  bad_parameters,  ///< a value is not finite or outside its hard bounds
  not_finite,      ///< a state is infinite or NaN
  step_too_small,  ///< error control required a vanishing step
  too_many_steps,
  out_of_time,
  cancelled,
  no_equilibrium,  ///< Before::steady was requested, but the rig does not settle
};
RIGCAL_WORDS(SimulationStatus, ok, "ok", bad_parameters, "bad parameters", not_finite, "not finite",
             step_too_small, "step too small", too_many_steps, "too many steps", out_of_time,
             "out of time", cancelled, "cancelled", no_equilibrium, "no equilibrium")

/// A simulated run. The matrices are empty unless `status` is ok, so that nobody takes the output
/// of a failed run for a result.
struct Simulation {
  SimulationStatus status = SimulationStatus::ok;
  double failed_at_s = 0.0;  ///< time at which a failed run ended
  std::string reason;        ///< explains a failure; empty if the run succeeded
  Eigen::MatrixXd outputs;   ///< shape (samples, outputs), SI
  /// d outputs / d parameter: one matrix of shape (samples, free) per output, SI.
  std::vector<Eigen::MatrixXd> sensitivities;
  long steps = 0;
  long rejected_steps = 0;
  bool ok() const { return status == SimulationStatus::ok; }
};

}  // namespace rigcal::model
