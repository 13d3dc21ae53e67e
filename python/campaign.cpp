#include "python/campaign.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <vector>

#include "datasets/prepare/load_record.hpp"

namespace rigcal::python {
namespace {

namespace py = pybind11;

/// A parameter of the campaign, with its row in the plant's parameter table.
struct Parameter {
  datasets::ParameterSetting setting;
  model::ParameterSpec spec;
};

std::vector<Parameter> campaign_parameters(const Campaign& self) {
  std::vector<Parameter> parameters;
  for (const datasets::ParameterSetting& setting : self.campaign.parameters)
    parameters.push_back({setting, model::parameter_spec(self.campaign.rig.plant, setting.index)});
  return parameters;
}

CampaignPtr load_campaign(
    const std::filesystem::path& campaign, const std::optional<std::filesystem::path>& data,
    const std::optional<Dict<std::string, std::variant<std::string, double>>>& set,
    const std::optional<std::vector<std::string>>& free,
    const std::optional<std::filesystem::path>& root) {
  require_path("campaign", campaign);
  require_path("data", data);
  require_path("root", root);
  if (free && free->empty())
    throw py::value_error("free: found an empty list, expected names of parameters, or None");
  auto loaded = std::make_shared<Campaign>();
  report::CampaignChoice& choice = loaded->choice;
  choice.campaign = campaign;
  choice.data = data.value_or("");
  choice.root = root.value_or("");
  choice.set = assignments(set);
  choice.free = free.value_or(std::vector<std::string>());
  loaded->call = "rigcal.load(" + std::string(py::repr(decoded(campaign.string())));
  if (data) loaded->call += ", " + written("data", decoded(data->string()));
  if (set) loaded->call += ", " + written("set", *set);
  if (free) loaded->call += ", " + written("free", py::cast(*free));
  if (root) loaded->call += ", " + written("root", decoded(root->string()));
  loaded->call += ")";
  const py::gil_scoped_release released;
  loaded->campaign = report::load(choice);
  return loaded;
}

void bind_parameter(py::module_& module) {
  using model::ParameterSpec;
  py::class_<Parameter> parameter(module, "Parameter", "A parameter of the campaign; SI.");
  parameter
      .def_property_readonly("key", field(&Parameter::spec, &ParameterSpec::key),
                             "Name in the campaign file: \"bulk_modulus\".")
      .def_property_readonly("name", field(&Parameter::spec, &ParameterSpec::name),
                             "Name in results, with its unit: \"bulk_modulus_pa\".")
      .def_property_readonly("symbol", field(&Parameter::spec, &ParameterSpec::symbol),
                             "Symbol in the equations.")
      .def_property_readonly("unit", field(&Parameter::spec, &ParameterSpec::unit),
                             "SI unit; \"1\" for a plain number.")
      .def_property_readonly("meaning", field(&Parameter::spec, &model::ParameterSpec::meaning),
                             "In one line.")
      .def_property_readonly("start",
                             field(&Parameter::setting, &datasets::ParameterSetting::value),
                             "Known value, or start value of the fit, in `unit`.")
      .def_property_readonly(
          "lower", [](const Parameter& self) { return none_if_nan(self.setting.lower); },
          "Bound of the fit, in `unit`; None for a known value.")
      .def_property_readonly(
          "upper", [](const Parameter& self) { return none_if_nan(self.setting.upper); },
          "Bound of the fit, in `unit`; None for a known value.")
      .def_property_readonly("free", field(&Parameter::setting, &datasets::ParameterSetting::fit),
                             "Whether it is fitted.")
      .def_property_readonly("scope",
                             field(&Parameter::setting, &datasets::ParameterSetting::scope),
                             "Scope of one value: \"rig\", \"leak_level\" or \"condition\".")
      .def_property_readonly(
          "nuisance", field(&Parameter::setting, &datasets::ParameterSetting::nuisance),
          "Whether it is a nuisance parameter, which validation estimates again.")
      .def_property_readonly(
          "prior",
          [](const Parameter& self) -> std::optional<std::pair<double, double>> {
            if (!self.setting.prior) return std::nullopt;
            return std::pair(self.setting.prior->mean, self.setting.prior->sd);
          },
          "Mean and standard deviation that the campaign states, in `unit`; or None.")
      .def("__repr__", [](const Parameter& self) {
        return fmt::format("<rigcal.Parameter {}: {:g} {}{}>", self.spec.key, self.setting.value,
                           self.spec.unit, self.setting.fit ? ", free" : "");
      });
}

void bind_condition(py::module_& module) {
  using datasets::Condition;
  py::class_<Condition>(module, "Condition",
                        "A signal at a leak level, recorded once or several times; SI.")
      .def_readonly("id", &Condition::id, "Its name in campaign and results.")
      .def_readonly("use", &Condition::use, "\"fit\", \"validate\", \"diagnose\" or \"ignore\".")
      .def_readonly("waveform", &Condition::waveform, "\"sine\", \"square\", \"recorded\"...")
      .def_readonly("frequency_hz", &Condition::frequency_hz,
                    "Frequency [Hz]; for a chirp the one at its start.")
      .def_readonly("amplitude", &Condition::amplitude,
                    "Amplitude [m], or [V] without a controller.")
      .def_readonly("leak_level", &Condition::leak_level, "Name of the leak level.")
      .def_readonly("temperature_k", &Condition::temperature_k, "[K]")
      .def_property_readonly("has_record", &Condition::has_record,
                             "Whether the campaign has recordings of it.")
      .def("__repr__", [](const Condition& self) {
        return fmt::format("<rigcal.Condition {}: {}>", self.id, to_string(self.use));
      });
}

}  // namespace

datasets::Record Campaign::record(const datasets::Condition& condition) const {
  const std::lock_guard lock(mutex_);
  const auto found = records_.find(condition.id);
  if (found != records_.end()) return found->second;
  return records_.emplace(condition.id, datasets::load_record(campaign, condition)).first->second;
}

CampaignClass bind_campaign(py::module_& module) {
  bind_parameter(module);
  bind_condition(module);
  CampaignClass campaign(module, "Campaign",
                         "A checked campaign in SI units, made by load(). Immutable.");
  campaign
      .def_property_readonly("name", field(&Campaign::campaign, &datasets::Campaign::name),
                             "Name stated in the file.")
      .def_property_readonly("file", field(&Campaign::campaign, &datasets::Campaign::file),
                             "Path of the campaign file.")
      .def_property_readonly(
          "plant", [](const Campaign& self) { return self.campaign.rig.plant; },
          "Kind of plant: \"load_pressure\", \"two_chamber\" or \"linkage\".")
      .def_property_readonly("synthetic",
                             field(&Campaign::campaign, &datasets::Campaign::synthetic),
                             "Whether its records were made by `rigcal synthesize`.")
      .def_property_readonly("conditions",
                             field(&Campaign::campaign, &datasets::Campaign::conditions),
                             "Conditions in the order of the file.")
      .def_property_readonly(
          "parameters", &campaign_parameters,
          "Parameters in the order of the file, with the changes by `set` and `free`.")
      .def("__reduce__",
           [](const Campaign& self) {
             const report::CampaignChoice& choice = self.choice;
             const auto path = [](const std::filesystem::path& of) -> py::object {
               return of.empty() ? py::object(py::none()) : py::object(decoded(of.string()));
             };
             py::dict set;
             for (const std::string& assignment : choice.set) {
               const std::size_t at = assignment.find('=');
               set[py::str(assignment.substr(0, at))] = assignment.substr(at + 1);
             }
             return py::make_tuple(py::module_::import("rigcal.notebook").attr("loaded"),
                                   py::make_tuple(path(choice.campaign), path(choice.data), set,
                                                  choice.free.empty() ? py::object(py::none())
                                                                      : py::cast(choice.free),
                                                  path(choice.root)));
           })
      .def("__repr__",
           [](const Campaign& self) { return "<rigcal.Campaign \"" + self.campaign.name + "\">"; });
  module.def("load", &load_campaign, py::arg("campaign"), py::arg("data") = py::none(),
             py::arg("set") = py::none(), py::arg("free") = py::none(),
             py::arg("root") = py::none(),
             R"(Reads and checks a campaign file.

Args:
    campaign: its path
    data: where relative paths of records start; the file's folder if None
    set: values in place of the file's, {"mass": "60 kg"}, as --set of the command
    free: exactly these parameters are fitted, ["mass", "bulk_modulus"], as --free of the command
    root: no campaign and no recording outside this folder is read, wherever links lead; None: no limit

Raises:
    InputError: the file is wrong; with file, line and column
    UsageError: set or free names an unknown parameter, or a value outside its limits)");
  return campaign;
}

}  // namespace rigcal::python
