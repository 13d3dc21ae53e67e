#include "report/job/fitted_rig.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rigcal::report {
namespace {

using datasets::Assumption;
using datasets::FittedValue;

const model::ParameterSpec& spec_in(const LeakTableInput& input, int index) {
  return datasets::assumption_spec(input.campaign.rig.plant, index);
}

/// Selects the covariance of the values that the leak table takes from the fit.
calib::RigUncertainty uncertainty_of(const LeakTableInput& input, const EarlierFit& earlier) {
  calib::RigUncertainty result;
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < earlier.indices.size(); ++i) {
    const Assumption* taken = input.settings.assumption(earlier.indices[i]);
    if (taken == nullptr || !taken->fitted) continue;
    result.indices.push_back(earlier.indices[i]);
    rows.push_back(static_cast<Eigen::Index>(i));
  }
  result.covariance = Eigen::MatrixXd(earlier.covariance(rows, rows));
  return result;
}

/// Warns about known values that differ from those used in the fit.
void warn_of_changed(const LeakTableInput& input, const EarlierFit& earlier,
                     std::vector<std::string>& warnings) {
  const auto values = datasets::leak_table_values(input.campaign, input.settings);
  for (const FittedValue& known : earlier.known) {
    const model::ParameterSpec& spec = spec_in(input, known.index);
    const double here = values.value[static_cast<std::size_t>(known.index)];
    if (spec.key == "leakage_coefficient" || here == known.value) continue;
    const Assumption* assumption = input.settings.assumption(known.index);
    warnings.push_back(fmt::format(
        "{} is {:g} {} here ({}), but the fit was made with {:g} {}: the table is not that of the "
        "fitted rig",
        spec.key, here, spec.unit,
        assumption == nullptr ? "campaign file" : "assumption: " + assumption->source, known.value,
        spec.unit));
  }
}

void warn_of_fit(const LeakTableInput& input, const EarlierFit& earlier,
                 const calib::RigUncertainty& uncertainty, std::vector<std::string>& warnings) {
  if (earlier.status == calib::FitStatus::stopped)
    warnings.push_back("the fit was stopped before it converged: " + earlier.message);
  for (const calib::Reason& reason : earlier.parameters.reasons) {
    if (calib::is_against(reason.state)) warnings.push_back("of the fit: " + reason.words);
  }
  std::vector<std::string_view> unknown;
  for (const Assumption& each : input.settings.assumptions) {
    if (each.fitted && std::find(uncertainty.indices.begin(), uncertainty.indices.end(),
                                 each.index) == uncertainty.indices.end())
      unknown.push_back(spec_in(input, each.index).key);
  }
  if (!unknown.empty())
    warnings.push_back(fmt::format(
        "the fit has no standard error of {}: it is missing in the intervals of the coefficients",
        fmt::join(unknown, ", ")));
}

}  // namespace

FittedRig take_fit(LeakTableInput& input, const EarlierFit& earlier,
                   const std::vector<std::string>& set) {
  datasets::take_fitted(input.settings, input.campaign, earlier.values);
  for (const std::string& assignment : set)
    override_assumption(input.settings, input.campaign, assignment);
  FittedRig rig;
  rig.uncertainty = uncertainty_of(input, earlier);
  std::vector<std::string_view> fitted;
  std::vector<std::string_view> assumed;
  for (const Assumption& each : input.settings.assumptions)
    (each.fitted ? fitted : assumed).push_back(spec_in(input, each.index).key);
  rig.notes.push_back(
      fitted.empty() ? "the table takes no value from the fit"
                     : fmt::format("the table takes {} from the fit", fmt::join(fitted, ", ")));
  if (!assumed.empty())
    rig.notes.push_back(
        fmt::format("the fit estimated none of these, so that what is assumed or "
                    "set still applies: {}",
                    fmt::join(assumed, ", ")));
  for (const FittedValue& value : earlier.values) {
    const Assumption* taken = input.settings.assumption(value.index);
    if (taken != nullptr && !taken->fitted)
      rig.warnings.push_back(fmt::format("{}: the value of the fit is not taken ({})",
                                         spec_in(input, value.index).key, taken->source));
  }
  warn_of_changed(input, earlier, rig.warnings);
  warn_of_fit(input, earlier, rig.uncertainty, rig.warnings);
  return rig;
}

std::vector<std::string> replaced_by_assumptions(const LeakTableInput& input) {
  std::vector<std::string> replaced;
  for (const Assumption& each : input.settings.assumptions) {
    if (each.index == datasets::kResidualScale) continue;
    const datasets::ParameterSetting* setting = input.campaign.setting(each.index);
    if (setting == nullptr || setting->value == each.value || each.source == "--set") continue;
    const model::ParameterSpec& spec = spec_in(input, each.index);
    replaced.push_back(
        fmt::format("{} ({:g} for {:g} {})", spec.key, each.value, setting->value, spec.unit));
  }
  if (replaced.empty()) return {};
  return {
      fmt::format("[leak_table.assumptions] replace values of [rig.parameters]: {}; if these were "
                  "fitted, --fit "
                  "fit.json makes the table of the fitted rig",
                  fmt::join(replaced, ", "))};
}

}  // namespace rigcal::report
