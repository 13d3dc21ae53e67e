#pragma once

#include <string>
#include <vector>

#include "calib/design/design.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {

/// The twin with unknown mass and valve gain, one square wave, and the settings for a test of two
/// seconds to be designed.
inline Twin designed_twin() {
  Twin twin = one_square();
  datasets::Condition& own = twin.campaign.conditions.back();
  own.duration_s = 2.0;
  own.sample_rate_hz = 200.0;
  datasets::DesignSettings settings;
  settings.lowest_m.value = -0.012;
  settings.highest_m.value = 0.015;
  settings.speed_m_per_s = datasets::StatedLimit{0.15, {}};
  settings.acceleration_m_per_s2 = datasets::StatedLimit{12.0, {}};
  settings.command_v = datasets::StatedLimit{5.0, {}};
  settings.flow_m3_per_s = datasets::StatedLimit{1e-3, {}};
  settings.duration_s = 2.0;
  settings.sample_rate_hz = 200.0;
  settings.repeats = 1;
  settings.evaluations = 24;
  settings.noise_sd[datasets::Channel::position] = 5e-5;
  twin.campaign.design = settings;
  return twin;
}

inline Design designed(const datasets::Campaign& campaign, const std::vector<std::string>& names,
                       int threads = 2) {
  return design(campaign, {}, names, nullptr, {threads, nullptr, {}});
}

}  // namespace rigcal::calib
