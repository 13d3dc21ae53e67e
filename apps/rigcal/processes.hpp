#pragma once

#include <memory>

#include "common/task_farm.hpp"

namespace rigcal::app {

/// The processes that `mpirun` or `srun` has started together with this one, or null where there
/// are none. Lives until the run has ended: where another process still works, its end waits.
///
/// @throws UsageError  there are others, and this rigcal was built without MPI
std::unique_ptr<TaskFarm> launched_processes();

/// Number of processes that share this machine; 1 without a launcher.
int processes_on_this_machine();

}  // namespace rigcal::app
