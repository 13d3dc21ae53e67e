#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

#include "python/campaign.hpp"
#include "report/store/provenance.hpp"
#include "report/store/stored/stored_fit.hpp"

namespace rigcal::python {
namespace {

template <typename... Enums>
pybind11::dict texts_of() {
  pybind11::dict texts;
  const auto add = [&]<typename Enum>(std::type_identity<Enum>) {
    pybind11::list all;
    for (const Enum each : report::every<Enum>()) all.append(to_string(each));
    texts[pybind11::str(pybind11::type_id<Enum>())] = all;
  };
  (add(std::type_identity<Enums>()), ...);
  return texts;
}

/// Returns the texts of all enumerations that occur in signatures, by the C++ name.
pybind11::dict enumerations() {
  return texts_of<calib::AspectState, calib::FitStatus, calib::Identifiability,
                  calib::IntervalSource, calib::Verdict, datasets::Scope, datasets::Use,
                  datasets::Waveform, metrics::TestOutcome, model::PlantKind,
                  model::SimulationStatus>();
}

}  // namespace
}  // namespace rigcal::python

PYBIND11_MODULE(_rigcal, module) {
  using namespace rigcal::python;
  module.doc() = "Bindings to the libraries of the command, used by rigcal/__init__.py.";
  module.attr("__version__") = std::string(rigcal::report::version());
  module.attr("__revision__") = std::string(rigcal::report::revision());
  module.attr("_enumerations") = enumerations();
  translate_errors();
  CampaignClass campaign = bind_campaign(module);
  bind_records(module, campaign);
  bind_simulations(module, campaign);
  bind_assessment(module);
  bind_fitted_parameters(module);
  bind_scores(module);
  bind_progress(module);
  bind_results(module);
  bind_fits(module, campaign);
  bind_verbs(module, campaign);
  bind_synthesize(campaign);
}
