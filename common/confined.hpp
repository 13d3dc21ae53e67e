#pragma once

#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>

namespace rigcal {

/// Limits of confined work.
struct Confinement {
  std::size_t bytes = std::size_t{512} << 20;  ///< of memory, above what the process has
  int cpu_seconds = 20;
  int wall_seconds = 120;
};

/// Confined work crashed or was stopped; what() says why.
class ConfinedFailure : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs `work` in a child process and returns its result: for libraries that damaged input can
/// crash or hang. All other effects of the work are lost with the child, and so is its output.
/// Thread-safe.
///
/// @param work  must not need another thread; what it throws counts as a crash, and memory that
/// runs
///              out throws std::bad_alloc in it
/// @throws ConfinedFailure  the child crashed, or took more than it may
std::string run_confined(const std::function<std::string()>& work, const Confinement& confinement);

}  // namespace rigcal
