#include "model/plant/rig.hpp"

namespace rigcal::model {
namespace {

struct OutputName {
  Output output;
  std::string_view name;
};
constexpr std::array kOutputNames{
    OutputName{Output::position, "position_m"},
    OutputName{Output::velocity, "velocity_m_per_s"},
    OutputName{Output::load_pressure, "load_pressure_pa"},
    OutputName{Output::pressure_a, "pressure_a_pa"},
    OutputName{Output::pressure_b, "pressure_b_pa"},
    OutputName{Output::force, "force_n"},
    OutputName{Output::command, "command_v"},
    OutputName{Output::spool, "spool_m"},
    OutputName{Output::servo_flow, "servo_flow_m3_per_s"},
    OutputName{Output::leakage_flow, "leakage_flow_m3_per_s"},
    OutputName{Output::work_flow, "work_flow_m3_per_s"},
    OutputName{Output::acceleration, "acceleration_m_per_s2"},
    OutputName{Output::payload_acceleration, "payload_acceleration_m_per_s2"},
    OutputName{Output::angle, "angle_rad"},
    OutputName{Output::angular_velocity, "angular_velocity_rad_per_s"},
    OutputName{Output::pilot_pressure, "pilot_pressure_pa"},
    OutputName{Output::torque, "torque_n_m"},
};

}  // namespace

std::string_view output_name(Output output) {
  for (const OutputName& row : kOutputNames) {
    if (row.output == output) return row.name;
  }
  return "";
}

bool has_output(const ParameterValues& values, Output output) {
  switch (output) {
    case Output::payload_acceleration:
      return values.is_given("payload_mass");
    case Output::angle:
    case Output::angular_velocity:
    case Output::torque:
      return values.plant == PlantKind::linkage;
    case Output::pilot_pressure:
      return values.is_given("pilot_gain");
    case Output::command:
      return !values.is_given("pilot_gain");
    default:
      return true;
  }
}

}  // namespace rigcal::model
