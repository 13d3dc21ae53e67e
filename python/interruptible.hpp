#pragma once

#include <atomic>
#include <exception>
#include <functional>

namespace rigcal::python {

/// Runs long work in its own thread, without the GIL, while this thread checks for signals. A
/// signal sets `cancel`; the work is waited for all the same.
///
/// @return  what the signal handler raised, usually KeyboardInterrupt; null without a signal
/// @throws  what the work threw, unless a signal came first
std::exception_ptr run_interruptibly(std::atomic<bool>& cancel, const std::function<void()>& work);

}  // namespace rigcal::python
