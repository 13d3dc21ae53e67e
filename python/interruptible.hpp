#pragma once

#include <atomic>
#include <exception>
#include <functional>

namespace rigcal::python {

/// Runs long work in a thread of its own, without the interpreter's lock, while this one looks
/// whether a signal has come: then `cancel` becomes true, and the work is waited for.
///
/// @return  what the handler of the signal raised, KeyboardInterrupt as a rule; null: no signal
/// came
/// @throws  what the work threw, unless a signal came first
std::exception_ptr run_interruptibly(std::atomic<bool>& cancel, const std::function<void()>& work);

}  // namespace rigcal::python
