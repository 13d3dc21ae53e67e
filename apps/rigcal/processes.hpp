#pragma once

#include <memory>

#include "common/task_farm.hpp"

namespace rigcal::app {

/// Returns the processes that `mpirun` or `srun` started together with this one, or null if there
/// are none. The object must live until the end of the run. Its destructor waits while other
/// processes are still working.
///
/// @throws UsageError  if there are other processes and this rigcal was built without MPI
std::unique_ptr<TaskFarm> launched_processes();

/// Returns the number of launched processes on this machine; 1 without a launcher.
int processes_on_this_machine();

}  // namespace rigcal::app
