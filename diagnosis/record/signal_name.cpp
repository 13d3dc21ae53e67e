#include "diagnosis/record/signal_name.hpp"

#include <fmt/format.h>

namespace rigcal::diagnosis {

std::string signal_name(const datasets::Campaign& campaign, const datasets::Condition& condition) {
  std::string text(to_string(condition.waveform));
  if (condition.frequency_hz) text += fmt::format(" {:.6g} Hz", *condition.frequency_hz);
  if (condition.end_frequency_hz) text += fmt::format(" to {:.6g} Hz", *condition.end_frequency_hz);
  if (!condition.amplitude) return text;
  if (campaign.rig.controller == model::ControllerKind::none)
    return text + fmt::format(", {:.6g} V", *condition.amplitude);
  if (campaign.rig.feedback == model::Feedback::position)
    return text + fmt::format(", {:.6g} mm", 1e3 * *condition.amplitude);
  return text + fmt::format(", {:.6g} {}", *condition.amplitude,
                            model::gain_keys(campaign.rig.feedback).unit);
}

}  // namespace rigcal::diagnosis
