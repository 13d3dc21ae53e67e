#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "common/error.hpp"

namespace rigcal {

/// Limits on confined work.
struct Confinement {
  std::size_t bytes = std::size_t{512} << 20;  ///< memory beyond the present size of the process
  int cpu_seconds = 20;
  int wall_seconds = 120;

  /// Limits for work on a file of this size: a few seconds, plus the time per MB that a slow reader
  /// takes.
  static Confinement of_file(std::uintmax_t file_bytes);
  /// Whether this process has less memory left than the confined work may use. If so, a failure for
  /// lack of memory does not show that the file is damaged.
  bool memory_is_short() const;
};

/// Thrown if confined work crashed or was stopped; what() gives the reason.
class ConfinedFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown if the system cannot provide a process or memory for confined work, whatever the file.
class NoResources : public Error {
 public:
  explicit NoResources(const std::string& message) : Error(ExitCode::internal, message) {}
};

/// Runs `work` in a child process and returns its result. Meant for libraries that crash or hang on
/// damaged input. All other effects of the work, including its output, are lost with the child.
/// Thread-safe.
///
/// @param work  must not need another thread; an exception counts as a crash; if memory runs out,
///              std::bad_alloc is thrown within it
/// @throws ConfinedFailure  if the child crashed or exceeded its limits
/// @throws NoResources      if no child can be started, or if it had less memory than its limit
std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement);

}  // namespace rigcal
