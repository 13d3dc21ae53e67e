#include "report/run/validation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "report/store/validity.hpp"

namespace rigcal::report {
namespace {

using datasets::Campaign;
using datasets::Use;

/// Finds the records that the earlier fit was based on. Compares contents, because new recordings
/// may reuse old names.
calib::Origin origin_of(const EarlierFit& earlier, const std::vector<datasets::Record>& records,
                        const Provenance& provenance) {
  const auto seen = [&](const FileState& file) {
    const auto input = std::find_if(provenance.inputs.begin(), provenance.inputs.end(),
                                    [&](const auto& each) { return each.path == file.path; });
    return input != provenance.inputs.end() &&
           std::find(earlier.input_hashes.begin(), earlier.input_hashes.end(), input->sha256) !=
               earlier.input_hashes.end();
  };
  calib::Origin origin;
  origin.parameters = earlier.parameters;
  origin.covariance = earlier.joint;
  for (const datasets::Record& record : records) {
    if (std::none_of(record.files.begin(), record.files.end(), seen)) continue;
    const auto then =
        std::find_if(earlier.conditions.begin(), earlier.conditions.end(),
                     [&](const auto& each) { return each.first == record.condition; });
    // A file that the fit read under another condition name counts as fitted.
    if (then == earlier.conditions.end() || then->second == Use::fit)
      origin.estimated_from.insert(record.condition);
  }
  return origin;
}

}  // namespace

std::vector<std::string> doubts_about(const EarlierFit& earlier, const Campaign& campaign) {
  std::vector<std::string> warnings;
  if (earlier.status == calib::FitStatus::stopped) {
    warnings.push_back("the fit was stopped before it converged: " + earlier.message);
  }
  for (const datasets::FittedValue& known : earlier.known) {
    const datasets::ParameterSetting* setting = campaign.setting(known.index);
    if (setting == nullptr || setting->fit || setting->value == known.value) continue;
    const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, known.index);
    warnings.push_back(fmt::format("{} is {:g} {} here, but was {:g} {} in the fit", spec.key,
                                   setting->value, spec.unit, known.value, spec.unit));
  }
  return warnings;
}

calib::Fit validate(const Campaign& campaign, const std::vector<datasets::Record>& records,
                    const EarlierFit* earlier, const Provenance& provenance,
                    const calib::FitOptions& settings) {
  if (earlier == nullptr) return calib::validate(campaign, records, nullptr, settings);
  const calib::Origin origin = origin_of(*earlier, records, provenance);
  calib::Fit fit = calib::validate(campaign, records, &earlier->values, settings, &origin);
  const auto validity = calib::coverage(campaign, records, fit, {Use::fit, Use::validate});
  for (const auto& warnings :
       {doubts_about(*earlier, campaign),
        outside(validity, earlier->validity, earlier->validated ? &*earlier->validated : nullptr)})
    fit.warnings.insert(fit.warnings.end(), warnings.begin(), warnings.end());
  return fit;
}

}  // namespace rigcal::report
