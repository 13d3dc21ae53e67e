#pragma once

#include <string>

#include "calib/problem/simulation_task.hpp"

namespace rigcal::report {

/// Writes <condition>.csv, the file that `simulate` produces.
std::string simulation_file(const calib::SimulationTask& task, const model::Simulation& simulation);

}  // namespace rigcal::report
