#pragma once

#include <atomic>
#include <exception>
#include <functional>

namespace rigcal::python {

/// Runs long work in a separate thread without the GIL, while this thread checks for signals. A
/// signal sets `cancel`; the function then waits for the work to end.
///
/// @return  the exception of the signal handler, usually KeyboardInterrupt; null if there was no
///          signal
/// @throws std::exception  any exception that the work throws, unless a signal came first
std::exception_ptr run_interruptibly(std::atomic<bool>& cancel, const std::function<void()>& work);

}  // namespace rigcal::python
