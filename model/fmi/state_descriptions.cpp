#include "model/fmi/equations.hpp"

namespace rigcal::model {
namespace {

constexpr double kTravel_m = 0.01;
constexpr double kSpeed_m_per_s = 0.1;
constexpr double kSignal_v = 1.0;
constexpr double kSignalRate_v_per_s = 100.0;
/// What pressures go through in ordinary motion, of the supply.
constexpr double kPressureShare = 0.1;

}  // namespace

std::vector<StateDescription> describe_states(const ExportedRig& rig, const Layout& layout) {
  const double pressure_pa = kPressureShare * rig.values["supply_pressure"];
  std::vector<StateDescription> states{
      {"position", "m", "position of the piston", kTravel_m},
      {"velocity", "m/s", "velocity of the piston", kSpeed_m_per_s}};
  if (rig.rig.plant == PlantKind::load_pressure) {
    states.push_back({"load_pressure", "Pa", "pressure of chamber A less that of B", pressure_pa});
  } else {
    states.push_back({"pressure_a", "Pa", "pressure of chamber A", pressure_pa});
    states.push_back({"pressure_b", "Pa", "pressure of chamber B", pressure_pa});
  }
  states.resize(static_cast<std::size_t>(layout.states));
  const auto put = [&states](int at, const StateDescription& state) {
    if (at >= 0) states[static_cast<std::size_t>(at)] = state;
  };
  put(layout.hoses, {"hose_memory_a", "1", "strain memory of the hose of chamber A", 1.0});
  if (layout.hoses >= 0)
    put(layout.hoses + 1, {"hose_memory_b", "1", "strain memory of the hose of chamber B", 1.0});
  put(layout.supply, {"valve_supply_pressure", "Pa", "supply pressure at the valve", pressure_pa});
  put(layout.valve, {"valve_signal", "V", "signal that the spool stands at", kSignal_v});
  if (layout.valve_order == 2)
    put(layout.valve + 1, {"valve_signal_rate", "V/s", "its rate", kSignalRate_v_per_s});
  put(layout.integral, {"controller_integral", "V", "integral action", kSignal_v});
  put(layout.filter, {"controller_filtered_error", "m", "filtered error", kTravel_m});
  put(layout.held, {"controller_held_output", "V", "output of the sampled controller", kSignal_v});
  return states;
}

}  // namespace rigcal::model
