#include <fmt/format.h>

#include <optional>

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
  bind_members(module, spread);
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
  bind_members(module, line);
  py::class_<Budget95> budget(module, "UncertaintyBudget", struct_doc<Budget95>());
  budget.def_property_readonly(
      "beside",
      [](const Budget95& self) { return self.beside.value_or(std::vector<BudgetLine>()); },
      member_doc<Budget95>("beside"));
  bind_members(module, budget);
}

void bind_profile(py::module_& module) {
  using calib::Profile;
  using calib::ProfileEnd;
  py::class_<ProfileEnd> end(module, "ProfileEnd", struct_doc<ProfileEnd>());
  end.def_property_readonly("lost", &ProfileEnd::is_lost, member_doc<ProfileEnd>("lost"));
  bind_members(module, end);
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
  bind_members(module, profile);
}

}  // namespace

void bind_fitted_parameters(py::module_& module) {
  using Self = calib::FittedParameter;
  bind_spread<calib::BootstrapSpread>(module, "BootstrapSpread");
  bind_spread<calib::PosteriorSpread>(module, "PosteriorSpread");
  bind_budget(module);
  bind_profile(module);
  py::class_<Self> parameter(module, "FittedParameter", struct_doc<Self>());
  parameter
      .def_property_readonly(
          "profile",
          [](const Self& self) -> std::optional<std::shared_ptr<calib::Profile>> {
            if (!self.profile) return std::nullopt;
            return std::make_shared<calib::Profile>(*self.profile);
          },
          member_doc<Self>("profile"))
      .def("__repr__", [](const Self& self) {
        return fmt::format("<rigcal.FittedParameter {}{}: {:g} {}>", self.key,
                           self.level ? " of " + *self.level : "", self.value, self.unit);
      });
  bind_members(module, parameter);
}

}  // namespace rigcal::python
