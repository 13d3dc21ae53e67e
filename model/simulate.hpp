#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/plant/parameter.hpp"
#include "model/signal/signal.hpp"

namespace rigcal::model {

/// Outputs of a simulation at each sample. Those that are recorded include the offset of their
/// sensor.
enum class Output {
  position,              ///< reading of the position sensor [m]
  velocity,              ///< [m/s]
  load_pressure,         ///< P_L = p_A - p_B [Pa]
  pressure_a,            ///< [Pa]
  pressure_b,            ///< [Pa]
  force,                 ///< reading of a load cell in the rod [N] (docs/model.md)
  command,               ///< controller output after the limit, or the recorded command [V]
  spool,                 ///< valve spool travel [m]
  servo_flow,            ///< Q_L, flow of the servo valve to the load [m3/s]
  leakage_flow,          ///< internal leakage across the piston [m3/s]
  work_flow,             ///< A x', flow that moves the piston [m3/s]
  acceleration,          ///< acceleration of the piston and the mass fixed to it [m/s2]
  payload_acceleration,  ///< acceleration of the second mass [m/s2]; zero without one
  angle,                 ///< reading of the angle sensor of a joint [rad]; zero without one
  angular_velocity,      ///< [rad/s]; likewise
  pilot_pressure,        ///< pilot pressure that drives the spool [Pa]; zero without a pilot
};

/// "position_m", "servo_flow_m3_per_s": name with its SI unit.
std::string_view output_name(Output output);
inline constexpr std::array kAllOutputs{Output::position,
                                        Output::velocity,
                                        Output::load_pressure,
                                        Output::pressure_a,
                                        Output::pressure_b,
                                        Output::force,
                                        Output::command,
                                        Output::spool,
                                        Output::servo_flow,
                                        Output::leakage_flow,
                                        Output::work_flow,
                                        Output::acceleration,
                                        Output::payload_acceleration,
                                        Output::angle,
                                        Output::angular_velocity,
                                        Output::pilot_pressure};

/// Whether a rig computes an output; those that it does not are zero.
bool has_output(const ParameterValues& values, Output output);

enum class ControllerKind {
  none,  ///< the drive is the valve command [V]
  pid,   ///< the drive is the reference of the controlled quantity
};

/// Quantity that a loop controls; its reference has the same unit.
enum class Feedback { position, force, load_pressure, acceleration };

/// Gains, in the parameter table, of a loop by its controlled quantity.
struct FeedbackRow {
  std::string_view name;  ///< in campaign files
  std::string_view unit;  ///< SI
  std::string_view meaning;
  std::string_view kp, ki, kd;
};
inline constexpr std::array kFeedbacks{
    FeedbackRow{"position", "m", "where the piston is to be", "kp", "ki", "kd"},
    FeedbackRow{"force", "N", "force that a load cell in the rod is to read", "force_kp",
                "force_ki", "force_kd"},
    FeedbackRow{"load_pressure", "Pa", "what the pressure of chamber A is to be less that of B",
                "load_pressure_kp", "load_pressure_ki", "load_pressure_kd"},
    FeedbackRow{"acceleration", "m/s2", "what the acceleration of the piston is to be",
                "acceleration_kp", "acceleration_ki", "acceleration_kd"},
};
inline constexpr std::size_t kFeedbackCount = kFeedbacks.size();
constexpr const FeedbackRow& gain_keys(Feedback feedback) {
  return kFeedbacks[static_cast<std::size_t>(feedback)];
}

enum class InitialState {
  rest,   ///< all states zero, whatever the initial_* parameters say
  given,  ///< from the initial_* parameters (free or fixed)
};

/// Inputs of the rig. Only the drive is delayed by `transport_delay`.
struct SimulationInputs {
  Signal drive = Signal::constant(0.0);      ///< reference of the loop, or command [V]
  std::optional<Signal> external_force_n;    ///< added to the parameter `external_force`
  std::optional<Signal> supply_pressure_pa;  ///< in place of the parameter `supply_pressure`
  std::optional<Signal> tank_pressure_pa{};  ///< in place of the parameter `tank_pressure`
  double drive_begins_s = 0.0;               ///< time of its first sample; see Rig::before
  /// Added to the signal of the spool [V, or Pa of a pilot]: the play of a valve.
  std::optional<Signal> spool_error{};
};

enum class Method {
  rosenbrock,  ///< RODAS4P, L-stable
  dopri5,      ///< Odeint's Dormand-Prince 5(4)
};

struct SimulationOptions {
  Method method = Method::rosenbrock;
  /// Local error per step over the running peak of each state, and of each sensitivity.
  double tolerance = 1e-6;
  /// Factor by which the local error of a sensitivity may be larger: a fit needs derivatives to one
  /// part in a thousand.
  double sensitivity_looseness = 50.0;
  /// Whether the rest of a run is read from its last periods once it is in its periodic steady
  /// state, or comes nearer to it in a way that is known. Else every period is simulated.
  bool periodic_steady_state = true;
  long max_steps = 5'000'000;                 ///< accepted and rejected
  double max_seconds = 120.0;                 ///< wall time of one simulation
  const std::atomic<bool>* cancel = nullptr;  ///< ends the simulation when it becomes true

  /// @throws std::invalid_argument  naming the field
  void validate() const;
};

enum class SimulationStatus {
  ok,
  bad_parameters,  ///< a value is not finite or outside its hard bounds
  not_finite,      ///< the state left the numbers
  step_too_small,  ///< error control required a vanishing step
  too_many_steps,
  out_of_time,
  cancelled,
  no_equilibrium,  ///< Before::steady, but the rig does not settle
};
std::string_view to_string(SimulationStatus status);

/// A simulated run. Unless `status` is ok the matrices are empty: a failed run has no numbers that
/// could be taken for good ones.
struct Simulation {
  SimulationStatus status = SimulationStatus::ok;
  double failed_at_s = 0.0;  ///< time at which it ended, if it failed
  std::string reason;        ///< in words, if it failed
  Eigen::MatrixXd outputs;   ///< shape (samples, outputs), SI
  /// d outputs / d parameter: one matrix of shape (samples, free) per output, SI.
  std::vector<Eigen::MatrixXd> sensitivities;
  /// State at the last sample: plant, hoses, supply, second mass, valve and controller, in the
  /// order of Layout.
  Eigen::VectorXd end_state;
  Eigen::MatrixXd end_sensitivities;  ///< shape (states, columns of `sensitivities`)
  Eigen::VectorXd state_floor;        ///< below it a state counts as zero in the error control
  long steps = 0;
  long rejected_steps = 0;
  bool ok() const { return status == SimulationStatus::ok; }
};

/// The rig that is simulated: which parameters it has and how it is driven.
struct Rig {
  PlantKind plant = PlantKind::load_pressure;
  ControllerKind controller = ControllerKind::pid;
  InitialState initial = InitialState::rest;
  Feedback feedback = Feedback::position;  ///< controlled quantity, if there is a controller
  Before before = Before::hold;
  bool pilot = false;  ///< the drive is a pilot pressure [Pa], not a command [V]
};

/// How many states a rig has, and how many the solvers of its plant have room for.
struct StateCount {
  int needed = 0;
  int room = 0;
};
StateCount count_states(const Rig& rig, const ParameterValues& parameters);

/// Solves the model from the first of `times_s` to the last.
///
/// @param parameters  SI values and which are given (decides the optional terms)
/// @param free        table indices of the parameters whose sensitivities are wanted; may be empty
/// @param times_s     shape (samples), increasing, at least one
/// @param outputs     what to return, in this order
/// @return            never throws for a point that cannot be simulated: see `status`
/// @throws std::invalid_argument  broken contract (sizes, order, options)
Simulation simulate(const Rig& rig, const ParameterValues& parameters, std::span<const int> free,
                    const SimulationInputs& inputs, std::span<const double> times_s,
                    std::span<const Output> outputs, const SimulationOptions& options = {});

/// The same from a state in the middle of a longer run, in place of the rig's initial one. Started
/// from the `end_state` of a run that ended at the first of these times, it continues that run.
/// Lags of sensors start anew.
///
/// @param state  shape (states), at the first of `times_s`; all sensitivities have a column per
///               state after those of `free`
/// @throws std::invalid_argument  also for a controller with `sample_time`, since the phase of its
///                                ticks is unknown
Simulation simulate_from(const Eigen::VectorXd& state, const Rig& rig,
                         const ParameterValues& parameters, std::span<const int> free,
                         const SimulationInputs& inputs, std::span<const double> times_s,
                         std::span<const Output> outputs, const SimulationOptions& options = {});

}  // namespace rigcal::model
