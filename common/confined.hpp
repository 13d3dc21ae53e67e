#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace rigcal {

/// What a confined piece of work may take at most.
struct Confinement {
  std::size_t bytes = std::size_t{512} << 20;  ///< of memory, above what the process has
  int cpu_seconds = 20;
  int wall_seconds = 120;
};

/// Confined work came to no end of its own; what() says why, in words.
class ConfinedFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a child process and returns the text that it returned there: for libraries that
/// damaged input can crash, or let run for ever. What the work does otherwise is lost with the
/// child; what it prints is dropped. May be called from several threads at a time.
///
/// @param work  must not need another thread, and must not throw
/// @throws ConfinedFailure  the child crashed, or took more than it may
std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement);

}  // namespace rigcal
