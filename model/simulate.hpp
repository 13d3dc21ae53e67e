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

/// Quantities that a simulation returns at each sample. If a quantity has a sensor, its reading is
/// returned.
enum class Output {
  position,              ///< reading of the position sensor [m]
  velocity,              ///< [m/s]
  load_pressure,         ///< P_L = p_A - p_B [Pa]
  pressure_a,            ///< [Pa]
  pressure_b,            ///< [Pa]
  force,                 ///< reading of a load cell in the rod [N] (docs/model.md)
  command,               ///< output of the controller after its limit, or the recorded command [V]
  spool,                 ///< valve spool travel [m]
  servo_flow,            ///< Q_L, flow of the servo valve to the load [m3/s]
  leakage_flow,          ///< internal leakage across the piston [m3/s]
  work_flow,             ///< A x', flow that the moving piston displaces [m3/s]
  acceleration,          ///< reading of an accelerometer on the first mass [m/s2]
  payload_acceleration,  ///< the same on the second mass; zero if there is none
  angle,                 ///< reading of the angle sensor of a joint [rad]; zero without a joint
  angular_velocity,      ///< angular velocity of the joint [rad/s]; zero without a joint
  pilot_pressure,        ///< pilot pressure that drives the spool [Pa]; zero without a pilot
};

/// Name of an output, ending in its SI unit: "position_m", "servo_flow_m3_per_s".
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

/// Whether a rig computes an output. Outputs that it does not compute are zero.
bool has_output(const ParameterValues& values, Output output);

enum class ControllerKind {
  none,  ///< the drive is the valve command [V]
  pid,   ///< the drive is the reference of the controlled quantity
};

/// Quantity that a loop controls. The reference has the same unit. Three-variable control acts on
/// position, velocity and acceleration together; its reference is a position or an acceleration.
enum class Feedback {
  position,
  force,
  load_pressure,
  acceleration,
  three_variable,
  three_variable_acceleration,
};

/// Maps a controlled quantity to the parameters with the gains of its loop.
struct FeedbackRow {
  std::string_view name;  ///< in campaign files
  std::string_view unit;  ///< SI unit of the reference
  std::string_view meaning;
  std::string_view kp, ki, kd;
  std::string_view acceleration;  ///< gain of the acceleration besides kp; empty: none
};
inline constexpr std::array kFeedbacks{
    FeedbackRow{"position", "m", "where the piston is to be", "kp", "ki", "kd", ""},
    FeedbackRow{"force", "N", "force that a load cell in the rod is to read", "force_kp",
                "force_ki", "force_kd", ""},
    FeedbackRow{"load_pressure", "Pa", "what the pressure of chamber A is to be less that of B",
                "load_pressure_kp", "load_pressure_ki", "load_pressure_kd", ""},
    FeedbackRow{"acceleration", "m/s2", "what the acceleration of the piston is to be",
                "acceleration_kp", "acceleration_ki", "acceleration_kd", ""},
    FeedbackRow{"three_variable", "m", "where the piston is to be", "kp", "ki", "velocity_kp",
                "acceleration_kp"},
    FeedbackRow{"three_variable_acceleration", "m/s2",
                "what the acceleration of the piston is to be", "kp", "ki", "velocity_kp",
                "acceleration_kp"},
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
  std::optional<Signal> supply_pressure_pa;  ///< replaces the parameter `supply_pressure`
  std::optional<Signal> tank_pressure_pa{};  ///< replaces the parameter `tank_pressure`
  double drive_begins_s = 0.0;               ///< time of its first sample; see Rig::before
  /// Added to the spool signal [V, or Pa for a pilot]; represents the play of a valve.
  std::optional<Signal> spool_error{};
  /// Acceleration of what the cylinder is fixed to, in the direction of positive travel. Position
  /// and velocity are relative to it.
  std::optional<Signal> base_acceleration_m_per_s2{};
  std::optional<Signal> oil_temperature_k{};  ///< replaces the parameter `oil_temperature`
};

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
std::string_view to_string(SimulationStatus status);

/// Whether a loop acts on position, velocity and acceleration together.
constexpr bool is_three_variable(Feedback feedback) {
  return !gain_keys(feedback).acceleration.empty();
}

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

/// The rig that is simulated: which parameters it has and how it is driven.
struct Rig {
  PlantKind plant = PlantKind::load_pressure;
  ControllerKind controller = ControllerKind::pid;
  InitialState initial = InitialState::rest;
  Feedback feedback = Feedback::position;  ///< controlled quantity of a rig with a controller
  Before before = Before::hold;
  bool pilot = false;  ///< the drive is a pilot pressure [Pa], not a command [V]
};

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
