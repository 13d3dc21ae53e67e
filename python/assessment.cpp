#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>
#include <string>

#include "calib/result/aspect.hpp"
#include "python/campaign.hpp"

namespace rigcal::python {

namespace py = pybind11;

void bind_assessment(py::module_& module) {
  using calib::Aspect;
  using calib::Assessment;
  using calib::Reason;
  py::class_<Reason>(module, "Reason", "One reason of an aspect.")
      .def_property_readonly(
          "state", named(&Reason::state),
          "What it speaks for: \"pass\", \"reservation\", \"fail\" or \"not_assessed\"; or\n"
          "\"note\", which changes nothing.")
      .def_readonly("code", &Reason::code, "\"limit_broken\", \"lack_of_fit\"...: docs/report.md")
      .def_property_readonly(
          "subject", [](const Reason& self) { return self.subject.value_or(""); },
          "Condition or parameter; empty: the whole result.")
      .def_property_readonly(
          "numbers",
          [](const Reason& self) {
            return std::map<std::string, double>(self.numbers.begin(), self.numbers.end());
          },
          "Numbers behind the reason, by name.")
      .def_readonly("words", &Reason::words, "The reason as a sentence.")
      .def("__repr__",
           [](const Reason& self) { return fmt::format("<rigcal.Reason {}>", self.code); });
  py::class_<Aspect>(module, "Aspect", "One of the four separate judgements.")
      .def_property_readonly(
          "state", named(&Aspect::state),
          "State of the gravest reason: \"pass\", \"reservation\", \"fail\" or \"not_assessed\".")
      .def_readonly("reasons", &Aspect::reasons, "Reasons for the state, the gravest first.")
      .def("__repr__", [](const Aspect& self) {
        return fmt::format("<rigcal.Aspect {}>", to_string(self.state));
      });
  py::class_<Assessment>(module, "Assessment", "What the verdict follows from: docs/report.md")
      .def_readonly("agreement", &Assessment::agreement,
                    "Every scored condition against the limits of the campaign.")
      .def_readonly("validation", &Assessment::validation,
                    "The conditions that no estimate rests on, against the same limits.")
      .def_readonly("adequacy", &Assessment::adequacy,
                    "Size of the residuals, compared with the noise of the records.")
      .def_readonly("parameters", &Assessment::parameters,
                    "Whether the records determine what was estimated.")
      .def("__repr__", [](const Assessment& self) {
        return fmt::format(
            "<rigcal.Assessment: agreement {}, validation {}, adequacy {}, parameters {}>",
            to_string(self.agreement.state), to_string(self.validation.state),
            to_string(self.adequacy.state), to_string(self.parameters.state));
      });
}

}  // namespace rigcal::python
