#pragma once

#include <pybind11/pybind11.h>

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "python/arguments.hpp"
#include "report/run/campaign_choice.hpp"

namespace rigcal::python {

/// A campaign with its options. Objects made from it keep it alive.
struct Campaign {
  report::CampaignChoice choice;
  datasets::Campaign campaign;
  std::string call;  ///< call that made it: rigcal.load('campaign.toml')

  /// Returns the record of a condition, which is read on the first call. May be called from any
  /// thread.
  datasets::Record record(const datasets::Condition& condition) const;

 private:
  mutable std::mutex mutex_;
  mutable std::map<std::string, datasets::Record> records_;
};
using CampaignPtr = std::shared_ptr<Campaign>;
using CampaignClass = pybind11::class_<Campaign, CampaignPtr>;

/// Returns None for an unknown number.
inline std::optional<double> none_if_nan(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

/// Translates the errors of rigcal to the exceptions in rigcal/errors.py.
void translate_errors();

// Each function adds the classes for one kind of result, and the methods of Campaign that return
// them.
CampaignClass bind_campaign(pybind11::module_& module);
void bind_records(pybind11::module_& module, CampaignClass& campaign);
void bind_simulations(pybind11::module_& module, CampaignClass& campaign);
void bind_scores(pybind11::module_& module);
void bind_assessment(pybind11::module_& module);
void bind_fitted_parameters(pybind11::module_& module);
void bind_progress(pybind11::module_& module);
void bind_fits(pybind11::module_& module, CampaignClass& campaign);
void bind_results(pybind11::module_& module);
void bind_verbs(pybind11::module_& module, CampaignClass& campaign);
void bind_synthesize(CampaignClass& campaign);

}  // namespace rigcal::python
