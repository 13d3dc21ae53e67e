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
  std::size_t bytes = std::size_t{512} << 20;  ///< of memory, above what the process has
  int cpu_seconds = 20;
  int wall_seconds = 120;

  /// For work on a file of this size: a few seconds, and as many as a slow reader takes for each
  /// MB.
  static Confinement of_file(std::uintmax_t file_bytes);
  /// Whether this process may take less memory than that itself: then a lack of it says nothing
  /// about the work.
  bool memory_is_short() const;
};

/// Confined work crashed or was stopped; what() says why.
class ConfinedFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The system has no process or no memory for confined work, whatever it works on.
class NoResources : public Error {
 public:
  explicit NoResources(const std::string& message) : Error(ExitCode::internal, message) {}
};

/// Runs `work` in a child process and returns its result: for libraries that damaged input can
/// crash or hang. All other effects of the work are lost with the child, and so is its output.
/// Thread-safe.
///
/// @param work  must not need another thread; what it throws counts as a crash, and memory that
/// runs
///              out throws std::bad_alloc in it
/// @throws ConfinedFailure  the child crashed, or took more than it may
/// @throws NoResources      no child can be made, or it had less memory than it may take
std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement);

}  // namespace rigcal
