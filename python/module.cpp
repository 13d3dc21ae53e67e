#include <pybind11/pybind11.h>

#include <string>

#include "python/campaign.hpp"
#include "python/errors.hpp"
#include "report/store/provenance.hpp"

PYBIND11_MODULE(_rigcal, module) {
  using namespace rigcal::python;
  module.doc() = "What rigcal/__init__.py takes from the libraries of the command.";
  module.attr("__version__") = std::string(rigcal::report::version());
  module.attr("__revision__") = std::string(rigcal::report::revision());
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
