#include "apps/rigcal/earlier_fit.hpp"

#include <fmt/format.h>

namespace rigcal::app {

std::vector<std::string> doubts_about(const report::EarlierFit& earlier,
                                      const datasets::Campaign& campaign) {
  std::vector<std::string> warnings;
  if (earlier.status == calib::FitStatus::stopped) {
    warnings.push_back("the fit was stopped before it converged: " + earlier.message);
  }
  const auto table = model::parameter_table(campaign.rig.plant);
  for (const datasets::FittedValue& known : earlier.known) {
    const datasets::ParameterSetting* setting = campaign.setting(known.index);
    if (setting == nullptr || setting->fit || setting->value == known.value) continue;
    const model::ParameterSpec& spec = table[static_cast<std::size_t>(known.index)];
    warnings.push_back(fmt::format("{} is {:g} {} here, but was {:g} {} in the fit", spec.key,
                                   setting->value, spec.unit, known.value, spec.unit));
  }
  return warnings;
}

}  // namespace rigcal::app
