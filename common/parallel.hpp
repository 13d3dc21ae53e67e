#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <system_error>
#include <thread>
#include <vector>

namespace rigcal {

/// Calls task(i) once for each i in [0, count), on up to `threads` threads including the caller's,
/// or on as many as the system provides. Each task must write to a separate place and must not read
/// what another task writes. The results are then identical to the bit for any number of threads.
///
/// @throws  the exception of the task with the lowest index, after the other tasks are completed
template <typename Task>
void parallel_for(std::size_t count, int threads, Task task) {
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        task(i);
      } catch (...) {
        errors[i] = std::current_exception();
      }
    }
  };
  const std::size_t helpers = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
  std::vector<std::jthread> pool;
  pool.reserve(helpers);
  try {
    while (pool.size() + 1 < helpers) pool.emplace_back(work);
  } catch (const std::system_error&) {
    // The system has no more threads, so the existing ones do the work.
  }
  work();
  pool.clear();
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace rigcal
