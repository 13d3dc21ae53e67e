#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

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
  torque,                ///< reading of a torque transducer at a joint [N m]; zero without a joint
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
                                        Output::pilot_pressure,
                                        Output::torque};

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
  angle,
  torque,
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
  /// Gains of the rate of the reference and of the rate of that rate; empty: no feed-forward.
  std::string_view velocity_feedforward, acceleration_feedforward;
};
inline constexpr std::array kFeedbacks{
    FeedbackRow{"position", "m", "desired position of the piston", "kp", "ki", "kd", "",
                "velocity_feedforward", "acceleration_feedforward"},
    FeedbackRow{"force", "N", "desired reading of a load cell in the rod", "force_kp", "force_ki",
                "force_kd", "", "", ""},
    FeedbackRow{"load_pressure", "Pa", "desired pressure of chamber A minus that of B",
                "load_pressure_kp", "load_pressure_ki", "load_pressure_kd", "", "", ""},
    FeedbackRow{"acceleration", "m/s2", "desired acceleration of the piston", "acceleration_kp",
                "acceleration_ki", "acceleration_kd", "", "", ""},
    FeedbackRow{"angle", "rad", "desired angle of the joint", "angle_kp", "angle_ki", "angle_kd",
                "", "angular_velocity_feedforward", "angular_acceleration_feedforward"},
    FeedbackRow{"torque", "N m", "desired reading of a torque sensor at the joint", "torque_kp",
                "torque_ki", "torque_kd", "", "", ""},
    FeedbackRow{"three_variable", "m", "desired position of the piston", "kp", "ki", "velocity_kp",
                "acceleration_kp", "velocity_feedforward", "acceleration_feedforward"},
    FeedbackRow{"three_variable_acceleration", "m/s2", "desired acceleration of the piston", "kp",
                "ki", "velocity_kp", "acceleration_kp", "velocity_feedforward",
                "acceleration_feedforward"},
};
inline constexpr std::size_t kFeedbackCount = kFeedbacks.size();
constexpr const FeedbackRow& gain_keys(Feedback feedback) {
  return kFeedbacks[static_cast<std::size_t>(feedback)];
}

/// Whether a plant has a loop on a quantity: whether its table has the gain of that loop.
inline bool has_loop(PlantKind plant, Feedback feedback) {
  return parameter_index(plant, gain_keys(feedback).kp) >= 0;
}

/// Whether a loop acts on position, velocity and acceleration together.
constexpr bool is_three_variable(Feedback feedback) {
  return !gain_keys(feedback).acceleration.empty();
}

/// Whether the reference of a loop is where the piston or the joint is to be.
constexpr bool controls_motion(Feedback feedback) {
  return feedback == Feedback::position || feedback == Feedback::angle ||
         feedback == Feedback::three_variable;
}

enum class InitialState {
  rest,   ///< all states zero, whatever the initial_* parameters say
  given,  ///< from the initial_* parameters (free or fixed)
};

/// Inputs of the rig. Only the drive is delayed by `transport_delay`.
struct SimulationInputs {
  Signal drive = Signal::constant(0.0);  ///< reference of the loop, or command [V]
  /// Load against positive travel [N], added to the parameter `external_force`; for a linkage,
  /// moment against positive angle [N m], added to the gravity moment.
  std::optional<Signal> external_load;
  std::optional<Signal> supply_pressure_pa;  ///< replaces the parameter `supply_pressure`
  std::optional<Signal> tank_pressure_pa{};  ///< replaces the parameter `tank_pressure`
  double drive_begins_s = 0.0;               ///< time of its first sample; see Rig::before
  /// Added to the spool signal [V, or Pa for a pilot]; represents the play of a valve.
  std::optional<Signal> spool_error{};
  /// Acceleration of the base to which the cylinder is fixed, in the direction of positive travel.
  /// Position and velocity are relative to it.
  std::optional<Signal> base_acceleration_m_per_s2{};
  std::optional<Signal> oil_temperature_k{};  ///< replaces the parameter `oil_temperature`
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

}  // namespace rigcal::model
