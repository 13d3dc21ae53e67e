#include "python/interruptible.hpp"

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace rigcal::python {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kBetweenLooks{50};

}  // namespace

std::exception_ptr run_interruptibly(std::atomic<bool>& cancel, const std::function<void()>& work) {
  std::exception_ptr thrown;
  std::exception_ptr raised;
  {
    const py::gil_scoped_release released;
    std::mutex mutex;
    std::condition_variable ended;
    bool done = false;
    std::jthread worker([&] {
      try {
        work();
      } catch (...) {
        thrown = std::current_exception();
      }
      const std::lock_guard lock(mutex);
      done = true;
      ended.notify_one();
    });
    std::unique_lock lock(mutex);
    while (!ended.wait_for(lock, kBetweenLooks, [&] { return done; })) {
      if (raised) continue;
      lock.unlock();
      {
        const py::gil_scoped_acquire acquired;
        if (PyErr_CheckSignals() != 0) {
          raised = std::make_exception_ptr(py::error_already_set());
          cancel = true;
        }
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  // A signal that arrived while the work was ending also belongs to this call. If an earlier signal
  // already raised an exception, that one is kept.
  if (PyErr_CheckSignals() != 0) {
    const auto last = std::make_exception_ptr(py::error_already_set());
    if (!raised) raised = last;
  }
  if (!raised && thrown) std::rethrow_exception(thrown);
  return raised;
}

}  // namespace rigcal::python
