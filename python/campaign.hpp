#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "report/run/campaign_choice.hpp"

namespace rigcal::python {

/// A campaign as it was chosen; what is made from it keeps it alive.
struct Campaign {
  report::CampaignChoice choice;
  datasets::Campaign campaign;
  std::string call;  ///< that made it: rigcal.load('campaign.toml')
};
using CampaignPtr = std::shared_ptr<Campaign>;
using CampaignClass = pybind11::class_<Campaign, CampaignPtr>;

// Each adds the classes of one kind of result, and to Campaign the methods that lead to them.
CampaignClass bind_campaign(pybind11::module_& module);
void bind_records(pybind11::module_& module, CampaignClass& campaign);
void bind_simulations(pybind11::module_& module, CampaignClass& campaign);
void bind_scores(pybind11::module_& module);
void bind_assessment(pybind11::module_& module);
void bind_fitted_parameters(pybind11::module_& module);
void bind_progress(pybind11::module_& module);
void bind_fits(pybind11::module_& module, CampaignClass& campaign);
void bind_synthesize(CampaignClass& campaign);

}  // namespace rigcal::python
