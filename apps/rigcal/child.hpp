#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "common/error.hpp"

namespace rigcal::app {

/// How a run of this program in a process of its own ended.
struct ChildEnd {
  ExitCode code = ExitCode::internal;
  std::string error;  ///< the message that it ended with, on one line; empty where there was none
  double seconds = 0.0;
};

/// Runs `rigcal` with these arguments in a process of its own, so that not even a crash or want of
/// memory there ends this one, and waits for it. What it prints is dropped, but for its error. It
/// is no process of MPI, even where this one is. When `cancel` becomes true, and when this process
/// ends, it is told by SIGTERM. May be called from several threads at a time.
///
/// @throws WriteError  no process can be made
ChildEnd run_child(const std::vector<std::string>& arguments, const std::atomic<bool>& cancel);

}  // namespace rigcal::app
