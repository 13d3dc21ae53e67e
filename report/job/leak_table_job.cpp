#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnosis/table/leak_table.hpp"
#include "report/job/job.hpp"
#include "report/job/leak_table_files.hpp"
#include "report/leak/leak_table.hpp"
#include "report/page/page_parts.hpp"
#include "report/store/json.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using datasets::Assumption;
using datasets::FittedValue;

/// What a fit contributes to the rig of a leak table.
struct FittedRig {
  diagnosis::RigUncertainty uncertainty;
  std::vector<std::string> notes;     ///< origin of the values, in words
  std::vector<std::string> warnings;  ///< doubts about the fit or the campaign
};

const model::ParameterSpec& spec_in(const LeakTableInput& input, int index) {
  return datasets::assumption_spec(input.campaign.rig.plant, index);
}

/// Returns the covariance of those fitted values that the table uses.
diagnosis::RigUncertainty uncertainty_of(const LeakTableInput& input, const EarlierFit& earlier) {
  diagnosis::RigUncertainty result;
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

/// Warns about known values that have changed since the fit.
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
                 const diagnosis::RigUncertainty& uncertainty, std::vector<std::string>& warnings) {
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
    warnings.push_back(
        fmt::format("the fit has no standard error of {}, so the intervals of the coefficients do "
                    "not include it",
                    fmt::join(unknown, ", ")));
}

/// Replaces values of the campaign and its assumptions with the estimates of a fit, then applies
/// --set.
///
/// @throws InputError  if a parameter does not have a single value for the rig
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
  rig.notes.push_back(fitted.empty()
                          ? "the table uses no value of the fit"
                          : fmt::format("the table uses {} from the fit", fmt::join(fitted, ", ")));
  if (!assumed.empty())
    rig.notes.push_back(fmt::format("not fitted, so the assumed or set values apply: {}",
                                    fmt::join(assumed, ", ")));
  for (const FittedValue& value : earlier.values) {
    const Assumption* taken = input.settings.assumption(value.index);
    if (taken != nullptr && !taken->fitted)
      rig.warnings.push_back(fmt::format("{}: the value of the fit is not used ({})",
                                         spec_in(input, value.index).key, taken->source));
  }
  warn_of_changed(input, earlier, rig.warnings);
  warn_of_fit(input, earlier, rig.uncertainty, rig.warnings);
  return rig;
}

/// Describes the values of [rig.parameters] that assumptions replace although no fit is used, such
/// as values that `fit` wrote into its fitted.toml. Empty if there are none.
std::vector<std::string> replaced_by_assumptions(const LeakTableInput& input) {
  std::vector<std::string> replaced;
  for (const Assumption& each : input.settings.assumptions) {
    if (each.index == datasets::kResidualScale) continue;
    const datasets::ParameterSetting* setting = input.campaign.setting(each.index);
    if (setting == nullptr || setting->value == each.value || each.source == "--set") continue;
    const model::ParameterSpec& spec = spec_in(input, each.index);
    replaced.push_back(fmt::format("{} ({} for {})", spec.key, readable(each.value, spec.unit),
                                   readable(setting->value, spec.unit)));
  }
  if (replaced.empty()) return {};
  return {
      fmt::format("[leak_table.assumptions] replace values of [rig.parameters]: {}; if these were "
                  "fitted, --fit "
                  "fit.json makes the table of the fitted rig",
                  fmt::join(replaced, ", "))};
}

void choose_targets(const LeakTableRequest& request, datasets::LeakTableSettings& settings) {
  if (request.targets_percent.empty()) return;
  settings.targets_percent = request.targets_percent;
  std::sort(settings.targets_percent.begin(), settings.targets_percent.end());
  const auto last = std::unique(settings.targets_percent.begin(), settings.targets_percent.end());
  settings.targets_percent.erase(last, settings.targets_percent.end());
}

void choose_signals(const LeakTableRequest& request, const datasets::Campaign& campaign,
                    datasets::LeakTableSettings& settings) {
  if (request.signals.empty()) return;
  std::vector<datasets::LeakSignal> chosen;
  for (const std::string& text : request.signals) {
    chosen.push_back(signal_from_text(campaign, settings, text));
  }
  settings.signals = std::move(chosen);
}

}  // namespace

JobResult leak_table_job(const CampaignChoice& choice, const LeakTableRequest& request,
                         const JobTerms& terms) {
  LeakTableInput input = load_leak_table(choice);
  FittedRig rig;
  if (request.fit.given()) {
    rig = take_fit(input, request.fit.read(input.campaign.rig.plant), choice.set);
  } else {
    rig.warnings = replaced_by_assumptions(input);
  }
  choose_targets(request, input.settings);
  choose_signals(request, input.campaign, input.settings);
  terms.hold(planned_leak_table(input.settings));
  diagnosis::LeakTableOptions settings =
      leak_table_options(input.campaign, terms.threads, terms.cancel);
  settings.rig = rig.uncertainty;
  diagnosis::LeakTable table = diagnosis::leak_table(input.campaign, input.settings, settings);
  Provenance provenance;
  provenance.command = terms.command;
  provenance.options = terms.options;
  provenance.options.emplace_back("targets",
                                  fmt::format("{}", fmt::join(request.targets_percent, ",")));
  provenance.options.emplace_back("signals", fmt::format("{}", fmt::join(request.signals, ",")));
  provenance.inputs = hash_inputs(input.campaign, {}, request.fit.inputs());
  StoredLeakTable result = stored(std::move(table), input.campaign, provenance);
  result.notes = rig.notes;
  result.warnings = rig.warnings;
  JobResult job;
  job.files = leak_table_files(input.campaign, input.settings, std::move(result));
  job.first = {"leak_table.csv", "leak_table.json"};
  job.inputs = provenance.inputs;
  return job;
}

}  // namespace rigcal::report
