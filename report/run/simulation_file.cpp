#include "report/run/simulation_file.hpp"

#include <span>

#include "report/store/csv.hpp"

namespace rigcal::report {

std::string simulation_file(const calib::SimulationTask& task,
                            const model::Simulation& simulation) {
  std::span<const model::Output> outputs = model::kAllOutputs;
  // The last output is that of the second mass, which some plants lack.
  const int payload = model::parameter_index(task.values.plant, "payload_mass");
  if (payload < 0 || !task.values.given[static_cast<std::size_t>(payload)])
    outputs = outputs.first(outputs.size() - 1);
  return simulation_csv(task.time_s, info(datasets::drive_channel(task.rig)).name,
                        calib::reference_of(task), outputs, simulation);
}

}  // namespace rigcal::report
