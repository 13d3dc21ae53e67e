#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "common/range.hpp"
#include "python/arrays.hpp"
#include "python/fit_result.hpp"

/// The ends of an interval are a tuple in Python.
template <>
struct pybind11::detail::type_caster<rigcal::Range> {
  using Ends = make_caster<std::pair<double, double>>;
  PYBIND11_TYPE_CASTER(rigcal::Range, Ends::name);
  static handle cast(const rigcal::Range& range, return_value_policy policy, handle parent) {
    return Ends::cast(std::pair(range.low, range.high), policy, parent);
  }
};

namespace rigcal::python {
namespace {

namespace py = pybind11;

void bind_bootstrap(py::module_& module) {
  using calib::BootstrapSpread;
  py::class_<BootstrapSpread>(module, "BootstrapSpread",
                              "A parameter over the replicates of the bootstrap, in its unit.")
      .def_readonly("standard_error", &BootstrapSpread::standard_error,
                    "Standard deviation of the replicates.")
      .def_readonly("bias", &BootstrapSpread::bias, "Mean of the replicates minus the estimate.")
      .def_readonly("freedom", &BootstrapSpread::freedom,
                    "Degrees of freedom with which the spread is known.")
      .def_property_readonly(
          "ci95", [](const BootstrapSpread& self) { return self.ci95.value(); },
          "Percentiles, widened for the degrees of freedom.");
}

void bind_posterior(py::module_& module) {
  using calib::PosteriorSpread;
  py::class_<PosteriorSpread>(module, "PosteriorSpread",
                              "A parameter over the draws of the posterior, in its unit.")
      .def_readonly("median", &PosteriorSpread::median, "Median of the draws.")
      .def_readonly("sd", &PosteriorSpread::sd, "Standard deviation of the draws.")
      .def_property_readonly(
          "ci95", [](const PosteriorSpread& self) { return self.ci95.value(); },
          "Quantiles of 2.5 and 97.5 %.")
      .def_readonly("r_hat", &PosteriorSpread::r_hat,
                    "Rank-normalised split R-hat; above 1.01 the chains disagree.")
      .def_readonly("bulk_draws", &PosteriorSpread::bulk_draws,
                    "Effective sample size for the middle.")
      .def_readonly("tail_draws", &PosteriorSpread::tail_draws,
                    "Effective sample size for the ends of intervals.");
}

void bind_budget(py::module_& module) {
  using calib::Budget95;
  using calib::BudgetLine;
  py::class_<BudgetLine>(module, "BudgetLine", "One contribution to an uncertainty.")
      .def_readonly("source", &BudgetLine::source, "\"noise\", \"repeats\", a key...")
      .def_readonly("kind", &BudgetLine::kind,
                    "\"records\", \"known_value\", \"effect\", \"days\" or \"numerics\".")
      .def_readonly("uncertainty", &BudgetLine::uncertainty,
                    "Standard uncertainty, in the unit of the result.")
      .def_property_readonly(
          "sensitivity",
          [](const BudgetLine& self) -> std::optional<double> { return self.sensitivity; },
          "Change of an estimate per unit of an effect's size; or None.")
      .def("__repr__", [](const BudgetLine& self) {
        return fmt::format("<rigcal.BudgetLine {}: {:g}>", self.source, self.uncertainty);
      });
  py::class_<Budget95>(module, "UncertaintyBudget",
                       "Contributions to the uncertainty of an estimate or a score, in its unit.")
      .def_readonly("lines", &Budget95::lines, "The contributions; their squares add up.")
      .def_readonly("combined", &Budget95::combined, "Standard uncertainty.")
      .def_readonly("degrees_of_freedom", &Budget95::degrees_of_freedom,
                    "Effective ones, of `combined`.")
      .def_readonly("coverage_factor", &Budget95::coverage_factor, "k, for 95 %.")
      .def_readonly("expanded", &Budget95::expanded, "U, `coverage_factor` times `combined`.")
      .def_readonly("shift", &Budget95::shift,
                    "Offset of the centre of the interval from the estimate, due to small effects.")
      .def_property_readonly(
          "beside",
          [](const Budget95& self) { return self.beside.value_or(std::vector<BudgetLine>()); },
          "Contributions that `combined` leaves out: days, and an upper limit for numerics.");
}

void bind_profile(py::module_& module) {
  using calib::Profile;
  using calib::ProfileEnd;
  py::class_<ProfileEnd>(module, "ProfileEnd", "One end of a profile, in the parameter's unit.")
      .def_readonly("value", &ProfileEnd::value,
                    "End of the 95 % interval; None: the cost stays below up to `reached`.")
      .def_readonly("reached", &ProfileEnd::reached, "Value up to which it was followed.")
      .def_property_readonly("lost", &ProfileEnd::is_lost,
                             "Whether it was abandoned: an inner fit failed or was cancelled.");
  py::class_<Profile, std::shared_ptr<Profile>>(
      module, "Profile", "Least cost of all other parameters at fixed values of this one.")
      .def_readonly("low", &Profile::low, "Its lower end.")
      .def_readonly("high", &Profile::high, "Its upper end.")
      .def_property_readonly(
          "values", [](const std::shared_ptr<Profile>& self) { return view(self, self->values); },
          "Shape (points), ascending, in the parameter's unit.")
      .def_property_readonly(
          "rises", [](const std::shared_ptr<Profile>& self) { return view(self, self->rises); },
          "Rise of twice the cost as a fraction of the threshold, shape (points); the 95 % "
          "interval "
          "ends at 1.")
      .def_readonly("lower_cost_found", &Profile::lower_cost_found,
                    "Whether the fit was not at the minimum.");
}

/// Returns a getter for a member that is None if it is absent.
template <typename Member>
auto or_none(Member calib::FittedParameter::*member) {
  return [=](const calib::FittedParameter& self) -> std::optional<typename Member::value_type> {
    return self.*member;
  };
}
/// Returns a getter for an enumerator by its name, or None if it is absent.
template <typename Member>
auto name_or_none(Member calib::FittedParameter::*member) {
  return [=](const calib::FittedParameter& self) {
    return self.*member ? std::optional(to_string(*(self.*member))) : std::nullopt;
  };
}

}  // namespace

void bind_fitted_parameters(py::module_& module) {
  using Self = calib::FittedParameter;
  bind_bootstrap(module);
  bind_posterior(module);
  bind_budget(module);
  bind_profile(module);
  py::class_<Self> parameter(module, "FittedParameter",
                             "One parameter of a result, fitted or known; SI.");
  bind_spec(parameter);
  parameter
      .def_property_readonly("scope", named(&Self::scope),
                             "Scope of the value: \"rig\", \"leak_level\" or \"condition\".")
      .def_readonly("level", &Self::level, "Its leak level or condition; None of the rig.")
      .def_readonly("value", &Self::value, "In `unit`.")
      .def_readonly("start", &Self::start, "Where the fit began, in `unit`.")
      .def_readonly("lower", &Self::lower, "Bound of the fit, in `unit`; None of a known value.")
      .def_readonly("upper", &Self::upper, "Bound of the fit, in `unit`; None of a known value.")
      .def_readonly("fitted", &Self::fitted, "False of a known value.")
      .def_readonly("nuisance", &Self::nuisance, "Fitted, but of no interest itself.")
      .def_readonly(
          "standard_error", &Self::standard_error,
          "As if the residuals were independent, in `unit`; None where the records do not\n"
          "determine it.")
      .def_readonly("robust_standard_error", &Self::robust_standard_error,
                    "From the variation of the residuals themselves, in `unit`; or None.")
      .def_readonly("ci95", &Self::ci95,
                    "95 % interval (low, high), in `unit`, with what the model leaves\n"
                    "out; or None.")
      .def_property_readonly("ci95_if_exact", or_none(&Self::ci95_if_exact),
                             "The same if the model were exact; or None.")
      .def_property_readonly(
          "ci95_from", name_or_none(&Self::ci95_from),
          "What `ci95_if_exact` rests on: \"standard_error\", \"robust_standard_error\"...; or "
          "None.")
      .def_property_readonly(
          "degrees_of_freedom", or_none(&Self::degrees_of_freedom),
          "Degrees of freedom of the standard error behind `ci95_if_exact`; or None.")
      .def_property_readonly("budget", or_none(&Self::budget),
                             "Contributions to `ci95`; None where no effects were considered.")
      .def_property_readonly("bootstrap", or_none(&Self::bootstrap),
                             "Its spread, where the fit was asked for one.")
      .def_property_readonly("posterior", or_none(&Self::posterior),
                             "Its spread over the draws, where the fit was asked for some.")
      .def_property_readonly(
          "profile",
          [](const Self& self) -> std::shared_ptr<calib::Profile> {
            if (!self.profile) return nullptr;
            return std::make_shared<calib::Profile>(*self.profile);
          },
          "Its profile likelihood, where the fit was asked for one.")
      .def_readonly("at_bound", &Self::at_bound, "Whether the estimate is at one of its bounds.")
      .def_property_readonly(
          "identifiability", name_or_none(&Self::identifiability),
          "\"identified\", \"weak\", \"bounded\" or \"not_identifiable\"; None of a known value.")
      .def_readonly("reason", &Self::reason,
                    "In words: why it has no error, why it is weak, at which bound it is.")
      .def("__repr__", [](const Self& self) {
        return fmt::format("<rigcal.FittedParameter {}{}: {:g} {}>", self.key,
                           self.level ? " of " + *self.level : "", self.value, self.unit);
      });
}

}  // namespace rigcal::python
