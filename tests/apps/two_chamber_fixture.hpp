#pragma once

#include <string>

#include "tests/apps/cli_fixture.hpp"

namespace rigcal::test {

/// A single-rod cylinder driven by its valve command, with two seconds of a square wave at 200 Hz.
inline const std::string kTwoChamber = R"(schema = "rigcal.campaign/1"
name = "single rod"
[rig]
model = "two_chamber"
[rig.parameters]
mass = { start = "6 kg", lower = "1 kg", upper = "50 kg", fit = true }
damping = "300 N s/m"
stiffness = "0 N/m"
area_a = "200 mm2"
area_b = "120 mm2"
stroke = "200 mm"
dead_volume_a = "20 cm3"
dead_volume_b = "30 cm3"
supply_pressure = "44 bar"
tank_pressure = "1 bar"
density = "850 kg/m3"
bulk_modulus = "500 MPa"
discharge_coefficient = 0.6
area_gradient = "20 mm"
valve_gain = { start = "5e-6 m/V", lower = "1e-6 m/V", upper = "2e-5 m/V", fit = true }
leakage_coefficient = 0
leakage_area = "1 mm2"
[rig.controller]
type = "none"
[recording.channels]
time = { column = "t_s", unit = "s" }
command = { column = "u_V", unit = "V" }
position = { column = "x_mm", unit = "mm" }
pressure_a = { column = "pA_bar", unit = "bar" }
pressure_b = { column = "pB_bar", unit = "bar" }
[[condition]]
id = "square"
waveform = "square"
frequency = "1 Hz"
amplitude = "1 V"
use = "fit"
repeats = ["records/square_*.csv"]
)";

/// The true parameters of the single-rod rig, and the noise of its records.
inline const std::string kTwoChamberTruth = R"([synthetic]
parameters = { mass = "5 kg", valve_gain = "4e-6 m/V" }
repeats = 3
duration = "2 s"
sample_rate = "200 Hz"
noise = { position = "0.02 mm", pressure_a = "0.1 bar", pressure_b = "0.1 bar" }
)";

/// Makes records of this rig in `twin/` with the command itself.
inline Outcome write_two_chamber_twin(const CommandFolder& folder, const Edits& edits = {}) {
  return synthesize_twin(folder, edited(kTwoChamber, edits) + kTwoChamberTruth);
}

}  // namespace rigcal::test
