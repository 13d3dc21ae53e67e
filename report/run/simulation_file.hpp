#pragma once

#include <string>

#include "calib/problem/simulation_task.hpp"

namespace rigcal::report {

/// The file of `simulate`: <condition>.csv.
std::string simulation_file(const calib::SimulationTask& task, const model::Simulation& simulation);

}  // namespace rigcal::report
