#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

#include "common/error.hpp"

namespace rigcal {

/// Limits of confined work.
struct Confinement {
  std::size_t bytes = std::size_t{512} << 20;  ///< memory beyond the present size of the process
  int cpu_seconds = 20;
  int wall_seconds = 120;

  /// Limits for work on a file of this size: a few seconds, plus the time that a slow reader takes
  /// per MB.
  static Confinement of_file(std::uintmax_t file_bytes);
  /// Whether this process has less memory left than the confined work may use. Running out of
  /// memory then says nothing about the file.
  bool memory_is_short() const;
};

/// Confined work crashed or was stopped; what() gives the reason.
class ConfinedFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The system cannot provide a process or memory for confined work, regardless of the file.
class NoResources : public Error {
 public:
  explicit NoResources(const std::string& message) : Error(ExitCode::internal, message) {}
};

/// Runs `work` in a child process and returns its result; for libraries that damaged input can
/// crash or hang. All other effects of the work, and its output, are lost with the child.
/// Thread-safe.
///
/// @param work  must not need another thread; an exception counts as a crash; lack of memory throws
///              std::bad_alloc in it
/// @throws ConfinedFailure  the child crashed, or exceeded its limits
/// @throws NoResources      no child can be started, or it had less memory than its limit
std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement);

}  // namespace rigcal
