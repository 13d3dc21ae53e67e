#pragma once

#include <pybind11/pybind11.h>

#include <cmath>
#include <functional>
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

/// Binds the properties that come from the plant's parameter table.
///
/// @param row  returns, for a parameter, the object with these members; the default is itself
template <typename Parameter, typename Row = std::identity>
void bind_spec(pybind11::class_<Parameter>& parameter, Row row = {}) {
  parameter
      .def_property_readonly(
          "key", [row](const Parameter& self) { return std::invoke(row, self).key; },
          "Name in the campaign file: \"bulk_modulus\".")
      .def_property_readonly(
          "name", [row](const Parameter& self) { return std::invoke(row, self).name; },
          "Name in results, with its unit: \"bulk_modulus_pa\".")
      .def_property_readonly(
          "symbol", [row](const Parameter& self) { return std::invoke(row, self).symbol; },
          "Symbol in the equations.")
      .def_property_readonly(
          "unit", [row](const Parameter& self) { return std::invoke(row, self).unit; },
          "SI unit; \"1\" for a plain number.");
}

/// Returns None for an unknown number.
inline std::optional<double> none_if_nan(double value) {
  return std::isnan(value) ? std::nullopt : std::optional(value);
}

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
