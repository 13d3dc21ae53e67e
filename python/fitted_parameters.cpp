#include <fmt/format.h>

#include <optional>
#include <string>

#include "python/arrays.hpp"
#include "python/described_members.hpp"
#include "python/fit_result.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;

/// Binds the spread of a parameter, over the replicates of the bootstrap or the draws of the
/// posterior. Every spread in a result has an interval.
template <typename Spread>
void bind_spread(py::module_& module, const char* name) {
  py::class_<Spread> spread(module, name, struct_doc<Spread>());
  spread.def_property_readonly(
      "ci95", [](const Spread& self) { return self.ci95.value(); }, member_doc<Spread>("ci95"));
  bind_members(spread);
}

void bind_budget(py::module_& module) {
  using calib::Budget95;
  using calib::BudgetLine;
  using Kind = Typed<"Literal['records', 'known_value', 'effect', 'days', 'numerics']">;
  py::class_<BudgetLine> line(module, "BudgetLine", struct_doc<BudgetLine>());
  line.def_property_readonly(
          "kind", [](const BudgetLine& self) { return Kind(self.kind); },
          member_doc<BudgetLine>("kind"))
      .def("__repr__", [](const BudgetLine& self) {
        return fmt::format("<rigcal.BudgetLine {}: {:g}>", self.source, self.uncertainty);
      });
  bind_members(line);
  py::class_<Budget95> budget(module, "UncertaintyBudget", struct_doc<Budget95>());
  budget.def_property_readonly(
      "beside",
      [](const Budget95& self) { return self.beside.value_or(std::vector<BudgetLine>()); },
      member_doc<Budget95>("beside"));
  bind_members(budget);
}

void bind_profile(py::module_& module) {
  using calib::Profile;
  using calib::ProfileEnd;
  py::class_<ProfileEnd> end(module, "ProfileEnd", struct_doc<ProfileEnd>());
  end.def_property_readonly("lost", &ProfileEnd::is_lost, member_doc<ProfileEnd>("lost"));
  bind_members(end);
  py::class_<Profile, std::shared_ptr<Profile>> profile(module, "Profile", struct_doc<Profile>());
  profile
      .def_property_readonly(
          "values", [](const std::shared_ptr<Profile>& self) { return view(self, self->values); },
          member_doc<Profile>("values"))
      .def_property_readonly(
          "rises", [](const std::shared_ptr<Profile>& self) { return view(self, self->rises); },
          member_doc<Profile>("rises"))
      .def_readonly("lower_cost_found", &Profile::lower_cost_found,
                    member_doc<Profile>("lower_cost_found"));
  bind_members(profile);
}

}  // namespace

void bind_fitted_parameters(py::module_& module) {
  using Self = FittedParameter;
  bind_spread<calib::BootstrapSpread>(module, "BootstrapSpread");
  bind_spread<calib::PosteriorSpread>(module, "PosteriorSpread");
  bind_budget(module);
  bind_profile(module);
  py::class_<Self> parameter(module, "FittedParameter",
                             "One parameter of a result, fitted or known; SI.");
  bind_spec(parameter);
  parameter
      .def_property_readonly("scope", field(&Self::value, &calib::FittedParameter::scope),
                             "Scope of the value: \"rig\", \"leak_level\" or \"condition\".")
      .def_property_readonly(
          "level",
          [](const Self& self) -> std::optional<std::string> {
            if (self.value.scope == datasets::Scope::rig) return std::nullopt;
            return self.value.level;
          },
          "Its leak level or condition; None of the rig.")
      .def_property_readonly("value", field(&Self::value, &calib::FittedParameter::value),
                             "In `unit`.")
      .def_property_readonly("start", field(&Self::value, &calib::FittedParameter::start),
                             "Where the fit began, in `unit`.")
      .def_property_readonly(
          "lower",
          [](const Self& self) {
            return self.value.fitted ? std::optional(self.value.lower) : std::nullopt;
          },
          "Bound of the fit, in `unit`; None of a known value.")
      .def_property_readonly(
          "upper",
          [](const Self& self) {
            return self.value.fitted ? std::optional(self.value.upper) : std::nullopt;
          },
          "Bound of the fit, in `unit`; None of a known value.")
      .def_property_readonly("fitted", field(&Self::value, &calib::FittedParameter::fitted),
                             "False of a known value.")
      .def_property_readonly("nuisance", field(&Self::value, &calib::FittedParameter::nuisance),
                             "Fitted, but of no interest itself.")
      .def_property_readonly(
          "standard_error", field(&Self::value, &calib::FittedParameter::standard_error),
          "As if the residuals were independent, in `unit`; None where the records do not\n"
          "determine it.")
      .def_property_readonly("robust_standard_error",
                             field(&Self::value, &calib::FittedParameter::robust_standard_error),
                             "From the variation of the residuals themselves, in `unit`; or None.")
      .def_property_readonly("ci95", field(&Self::value, &calib::FittedParameter::ci95),
                             "95 % interval (low, high), in `unit`, with what the model leaves\n"
                             "out; or None.")
      .def_property_readonly("ci95_if_exact",
                             field(&Self::value, &calib::FittedParameter::ci95_if_exact),
                             "The same if the model were exact; or None.")
      .def_property_readonly(
          "ci95_from",
          [](const Self& self) {
            return self.value.ci95 ? std::optional(self.value.interval) : std::nullopt;
          },
          "What `ci95_if_exact` rests on: \"standard_error\", \"robust_standard_error\"...; or "
          "None.")
      .def_property_readonly(
          "degrees_of_freedom", field(&Self::value, &calib::FittedParameter::degrees_of_freedom),
          "With which the error that `ci95_if_exact` rests on is known; or None.")
      .def_property_readonly("budget", field(&Self::value, &calib::FittedParameter::budget),
                             "Contributions to `ci95`; None where no effects were considered.")
      .def_property_readonly("bootstrap", field(&Self::value, &calib::FittedParameter::bootstrap),
                             "Its spread, where the fit was asked for one.")
      .def_property_readonly("posterior", field(&Self::value, &calib::FittedParameter::posterior),
                             "Its spread over the draws, where the fit was asked for some.")
      .def_property_readonly(
          "profile",
          [](const Self& self) -> std::optional<std::shared_ptr<calib::Profile>> {
            if (!self.value.profile) return std::nullopt;
            return std::make_shared<calib::Profile>(*self.value.profile);
          },
          "Its profile likelihood, where the fit was asked for one.")
      .def_property_readonly("at_bound", field(&Self::value, &calib::FittedParameter::at_bound),
                             "Whether the estimate is at one of its bounds.")
      .def_property_readonly(
          "identifiability",
          [](const Self& self) {
            return self.value.fitted ? std::optional(self.value.identifiability) : std::nullopt;
          },
          "\"identified\", \"weak\", \"bounded\" or \"not_identifiable\"; None of a known value.")
      .def_property_readonly("reason", field(&Self::value, &calib::FittedParameter::reason),
                             "In words: why it has no error, why it is weak, at which bound it is.")
      .def("__repr__", [](const Self& self) {
        return fmt::format("<rigcal.FittedParameter {}{}: {:g} {}>", self.spec.key,
                           self.value.level.empty() ? "" : " of " + self.value.level,
                           self.value.value, self.spec.unit);
      });
}

}  // namespace rigcal::python
