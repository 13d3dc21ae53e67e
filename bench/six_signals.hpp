#pragma once

#include <string>
#include <vector>

#include "datasets/campaign.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"

/// The six-signal problem: sine and square at 0.1, 1 and 10 Hz on one rig, 86 006 samples at 1 kHz.
namespace rigcal::bench {

struct SixSignal {
  std::string waveform;
  double frequency_hz;
  double amplitude_m;
  double duration_s;
};
inline const std::vector<SixSignal> kSixSignals{
    {"sine", 0.1, 0.0508, 30.0}, {"square", 0.1, 0.0508, 30.0}, {"sine", 1.0, 0.02, 10.0},
    {"square", 1.0, 0.02, 10.0}, {"sine", 10.0, 0.002, 3.0},    {"square", 10.0, 0.002, 3.0}};

inline model::ParameterValues six_signal_truth() {
  auto values = model::ParameterValues::defaults(model::PlantKind::load_pressure);
  values.set("mass", 85.0);
  values.set("damping", 1000.0);
  values.set("stiffness", 75e3);
  values.set("piston_area", 1.62e-3);
  values.set("total_volume", 1.62e-3 * 0.1524);
  values.set("supply_pressure", 6.2e6);
  values.set("density", 847.0);
  values.set("bulk_modulus", 689e6);
  values.set("discharge_coefficient", 0.6);
  values.set("area_gradient", 20.75e-3);
  values.set("valve_gain", 4.06e-5);
  values.set("leakage_coefficient", 0.35);
  values.set("leakage_area", 5e-7);
  values.set("leakage_smoothing", 1e4);
  values.set("kp", 400.0);
  values.set("output_limit", 10.0);
  return values;
}

inline std::vector<double> sample_times(const SixSignal& signal) {
  std::vector<double> times;
  const auto samples = static_cast<long>(signal.duration_s * 1000.0 + 0.5);
  for (long k = 0; k <= samples; ++k) times.push_back(static_cast<double>(k) / 1000.0);
  return times;
}

inline model::SimulationInputs inputs(const SixSignal& signal) {
  model::SimulationInputs inputs;
  inputs.drive = signal.waveform == "sine"
                     ? model::Signal::sine(signal.amplitude_m, signal.frequency_hz)
                     : model::Signal::square(signal.amplitude_m, signal.frequency_hz);
  return inputs;
}

/// The campaign (mass, bulk modulus, valve gain and leakage free, started off the truth) and its
/// noisy records, without any file.
struct SixSignalCampaign {
  datasets::Campaign campaign;
  std::vector<datasets::Record> records;
};
SixSignalCampaign six_signal_campaign();

}  // namespace rigcal::bench
