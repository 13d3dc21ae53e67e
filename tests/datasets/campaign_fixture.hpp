#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>

#include "common/error.hpp"
#include "datasets/campaign/campaign.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/temporary_folder.hpp"

namespace rigcal::test {

inline datasets::Campaign load_text(const std::string& text) {
  const TemporaryFolder folder;
  return datasets::load_campaign(folder.write("campaign.toml", text));
}

/// Returns the error message of `read`, which must name a line, or "(loaded)" if it accepts the
/// text.
template <typename Read>
std::string complaint_of(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    CHECK(error.code() == ExitCode::bad_input);
    CHECK(error.where().line > 0);
    return error.what();
  }
  return "(loaded)";
}

/// Number of the line in which `part` first occurs in `text`, from 1.
inline long line_of(const std::string& text, const std::string& part) {
  const std::size_t at = text.find(part);
  if (at == std::string::npos) throw std::logic_error("the text has no '" + part + "'");
  return 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
}

/// The example from the documentation, with the plant parameters that it leaves out.
inline const std::string kExample = R"(schema = "rigcal.campaign/1"
name = "UIS shake table"

[rig]
model = "load_pressure"
[rig.parameters]
supply_pressure = "6.2 MPa"
mass = { start = "60 kg", lower = "10 kg", upper = "500 kg", fit = true }
damping = { start = "1000 N s/m", lower = "0 N s/m", upper = "1e5 N s/m", fit = true, prior = "900 N s/m", prior_sd = "100 N s/m" }
leakage_coefficient = { start = 0.3, lower = 0, upper = 5, fit = true, scope = "leak_level" }
position_offset = { start = "0 mm", lower = "-5 mm", upper = "5 mm", fit = true, scope = "condition", nuisance = true }
stiffness = "0 N/m"
piston_area = "633 mm2"
total_volume = "468 cm3"
density = "850 kg/m3"
bulk_modulus = "689 MPa"
discharge_coefficient = 0.6
area_gradient = "25 mm"
valve_gain = "0.0254 mm/V"
leakage_area = "3 mm2"
[rig.controller]
type = "pid"
kp = "78.74 V/m"

[leak_level."33.33 %"]
parameters = { leakage_coefficient = 0.35 }

[recording]
initial = "rest"
separator = ","
[recording.channels]
time = { column = "t_s", unit = "s" }
reference = { column = "ref_mm", unit = "mm" }
position = { column = "x_mm", unit = "mm", sd = "0.05 mm" }
pressure_a = { unit = "bar" }
pressure_b = { unit = "bar" }

[averaging]
align = "correlate"

[acceptance]
rho2 = 0.99
warn_rho2 = 0.995
ccc = 0.99
absolute_error_percent = 1.0

[[condition]]
id = "sine_0.1Hz_open_33"
waveform = "sine"
frequency = "0.1 Hz"
amplitude = "50.8 mm"
leak_level = "33.33 %"
use = "fit"
parameters = { }
repeats = ["records/sine_0.1Hz_33_*.csv"]

[[condition]]
id = "steps"
waveform = "recorded"
leak_level = "none"
use = "validate"
repeats = [ { file = "steps_1V.csv", n = "01..10", columns = { position = "x_mm_A{n}", pressure_a = "pA_bar_{n}" } },
            { file = "steps_1V.csv", n = "01..10", columns = { position = "x_mm_B{n}", pressure_b = "pB_bar_{n}" } } ]
window = ["0.5 s", "12 s"]
temperature = "38 degC"
date = 2026-03-01
)";

}  // namespace rigcal::test
