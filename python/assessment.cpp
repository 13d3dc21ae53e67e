#include <fmt/format.h>

#include "calib/result/aspect.hpp"
#include "python/campaign.hpp"
#include "python/described_members.hpp"

namespace rigcal::python {

namespace py = pybind11;

void bind_assessment(py::module_& module) {
  using calib::Aspect;
  using calib::Assessment;
  using calib::Reason;
  py::class_<Reason> reason(module, "Reason", struct_doc<Reason>());
  reason
      .def_property_readonly(
          "subject", [](const Reason& self) { return self.subject.value_or(""); },
          "Condition or parameter; empty for the whole result.")
      .def("__repr__",
           [](const Reason& self) { return fmt::format("<rigcal.Reason {}>", self.code); });
  bind_members(module, reason);
  py::class_<Aspect> aspect(module, "Aspect", struct_doc<Aspect>());
  aspect.def("__repr__", [](const Aspect& self) {
    return fmt::format("<rigcal.Aspect {}>", to_string(self.state));
  });
  bind_members(module, aspect);
  py::class_<Assessment> assessment(module, "Assessment", struct_doc<Assessment>());
  assessment.def("__repr__", [](const Assessment& self) {
    return fmt::format(
        "<rigcal.Assessment: agreement {}, validation {}, adequacy {}, parameters {}>",
        to_string(self.agreement.state), to_string(self.validation.state),
        to_string(self.adequacy.state), to_string(self.parameters.state));
  });
  bind_members(module, assessment);
}

}  // namespace rigcal::python
