#pragma once

#include <atomic>

namespace rigcal::app {

/// Lets the first SIGINT or SIGTERM set the flag that is returned; a second one ends the process.
/// Writing beyond a limit of the size of files fails, and ends nothing by itself.
const std::atomic<bool>& watch_signals();

/// Ends a run in which nothing was finished yet.
///
/// @throws Error  exit code `stopped`, if the flag is set
void stop_if(const std::atomic<bool>& cancel);

}  // namespace rigcal::app
