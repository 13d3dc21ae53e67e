#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/campaign/leak_table_settings.hpp"
#include "diagnosis/table/leak_table.hpp"

namespace rigcal::test {

inline std::string shake_table_file() {
  return std::string(RIGCAL_SOURCE_DIR) + "/datasets/rigs/uis_shake_table/campaign.toml";
}

/// The rig of the source paper with its published tables.
struct LeakRig {
  datasets::Campaign campaign = datasets::load_campaign(shake_table_file());
  datasets::LeakTableSettings settings = datasets::leak_table_settings(campaign);

  model::ParameterValues values() const { return leak_table_values(campaign, settings); }
  diagnosis::PeriodicDrive drive(datasets::Waveform waveform, double frequency_hz) const {
    diagnosis::PeriodicDrive result{campaign.rig, {}};
    result.signal.waveform = waveform;
    result.signal.frequency_hz = frequency_hz;
    result.signal.amplitude = 0.0508;
    return result;
  }
  model::ParameterValues leaking(double coefficient) const {
    model::ParameterValues result = values();
    result.set("leakage_coefficient", coefficient);
    return result;
  }
};

}  // namespace rigcal::test
