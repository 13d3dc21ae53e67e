#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "report/batch/batch_rigs.hpp"

namespace rigcal::app {

/// Runs `rigcal` with these arguments in a child process and waits for it, so that a crash or lack
/// of memory in the child does not end this process. Only the error message is kept from its
/// output. The child is not an MPI process, even if this one is. The child receives SIGTERM when
/// `cancel` becomes true or this process ends. Thread-safe. If the child cannot be started, the
/// result is ExitCode::internal with the reason.
report::VerbEnd run_child(const std::vector<std::string>& arguments,
                          const std::atomic<bool>& cancel);

}  // namespace rigcal::app
