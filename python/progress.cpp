#include "python/progress.hpp"

#include <fmt/format.h>

#include "python/campaign.hpp"
#include "python/described_members.hpp"

namespace rigcal::python {

namespace py = pybind11;

/// The GIL guards `raised_` while the fit runs, because a second lock could deadlock with it.
template <typename Event>
void Progress::tell(const Event& event) {
  const py::gil_scoped_acquire acquired;
  if (raised_) return;
  try {
    (*function_)(event);
  } catch (const py::error_already_set&) {
    raised_ = std::current_exception();
    cancel_ = true;
  }
}

void Progress::attach(calib::FitOptions& settings) {
  if (!function_) return;
  settings.progress = [this](int start, int iteration, double cost, double relative_change,
                             double /*seconds*/) {
    tell(Iteration{start, iteration, cost, relative_change});
  };
  settings.beside = [this](const char* work, int done, int all) { tell(Pieces{work, done, all}); };
}

void Progress::pieces(const char* work, int done, int all) {
  if (function_) tell(Pieces{work, done, all});
}

void Progress::rethrow() const {
  if (raised_) std::rethrow_exception(raised_);
}

void bind_progress(py::module_& module) {
  py::class_<Iteration> iteration(module, "Iteration", struct_doc<Iteration>());
  iteration.def("__repr__", [](const Iteration& self) {
    return fmt::format("<rigcal.Iteration {} of start {}: cost {:.6g}>", self.iteration, self.start,
                       self.cost);
  });
  bind_members(module, iteration);
  py::class_<Pieces> pieces(module, "Pieces", struct_doc<Pieces>());
  pieces.def("__repr__", [](const Pieces& self) {
    return fmt::format("<rigcal.Pieces: {} of {} {}>", self.done, self.all, self.work);
  });
  bind_members(module, pieces);
}

}  // namespace rigcal::python
