#include "report/run/simulation_file.hpp"

#include <vector>

#include "report/store/csv.hpp"

namespace rigcal::report {

std::string simulation_file(const calib::SimulationTask& task,
                            const model::Simulation& simulation) {
  std::vector<model::Output> outputs;
  for (const model::Output output : model::kAllOutputs)
    if (has_output(task.values, output)) outputs.push_back(output);
  return simulation_csv(task.time_s, info(datasets::drive_channel(task.rig)).name,
                        calib::reference_of(task), outputs, simulation);
}

}  // namespace rigcal::report
