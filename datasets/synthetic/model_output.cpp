#include "datasets/synthetic/model_output.hpp"

namespace rigcal::datasets {

std::optional<model::Output> model_output(Channel channel) {
  switch (channel) {
    case Channel::position:
      return model::Output::position;
    case Channel::load_pressure:
      return model::Output::load_pressure;
    case Channel::pressure_a:
      return model::Output::pressure_a;
    case Channel::pressure_b:
      return model::Output::pressure_b;
    case Channel::force:
      return model::Output::force;
    case Channel::command:
      return model::Output::command;
    case Channel::acceleration:
      return model::Output::acceleration;
    case Channel::payload_acceleration:
      return model::Output::payload_acceleration;
    case Channel::angle:
      return model::Output::angle;
    case Channel::torque:
      return model::Output::torque;
    case Channel::pilot_pressure:
      return model::Output::pilot_pressure;
    case Channel::reference:
    case Channel::force_reference:
    case Channel::load_pressure_reference:
    case Channel::acceleration_reference:
    case Channel::angle_reference:
    case Channel::torque_reference:
    case Channel::supply_pressure:
    case Channel::tank_pressure:
    case Channel::base_acceleration:
    case Channel::temperature:
      break;
  }
  return std::nullopt;
}

}  // namespace rigcal::datasets
