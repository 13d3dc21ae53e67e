#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/command.hpp"
#include "tests/support/replaced.hpp"
#include "tests/support/small_rig.hpp"

namespace rigcal::test {

/// Replacements in a text; each `from` must occur.
using Edits = std::vector<std::pair<std::string, std::string>>;

inline std::string edited(std::string text, const Edits& edits) {
  for (const auto& [from, to] : edits) text = replaced(text, from, to);
  return text;
}

/// A small campaign: the paper's rig in closed loop, with two seconds of a 2 Hz sine at 200 Hz.
inline const std::string kCampaign = R"(schema = "rigcal.campaign/1"
name = "small rig"
[rig]
model = "load_pressure"
[rig.parameters]
supply_pressure = "6.2 MPa"
mass = "60 kg"
damping = { start = "2000 N s/m", lower = "10 N s/m", upper = "1e5 N s/m", fit = true }
valve_gain = { start = "2e-5 m/V", lower = "1e-6 m/V", upper = "1e-3 m/V", fit = true }
leakage_coefficient = 0.3
)" + kSmallRig + R"([rig.controller]
type = "pid"
kp = "1000 V/m"
[leak_level."none"]
[recording.channels]
time = { column = "t_s", unit = "s" }
reference = { column = "ref_mm", unit = "mm" }
position = { column = "x_mm", unit = "mm" }
load_pressure = { column = "pl_bar", unit = "bar" }
[acceptance]
rho2 = 0.9
not_judged = ["load_pressure"]
[[condition]]
id = "sine"
waveform = "sine"
frequency = "2 Hz"
amplitude = "5 mm"
leak_level = "none"
use = "fit"
repeats = ["records/sine_*.csv"]
[[condition]]
id = "square"
waveform = "square"
frequency = "1 Hz"
amplitude = "4 mm"
leak_level = "none"
use = "validate"
repeats = ["records/square_*.csv"]
)";

/// Section that makes records from kCampaign with known parameters.
inline const std::string kSynthetic = R"([synthetic]
parameters = { damping = "1000 N s/m", valve_gain = "3e-5 m/V" }
repeats = 3
duration = "2 s"
sample_rate = "200 Hz"
noise = { position = "0.01 mm", load_pressure = "0.05 bar" }
)";

/// Writes kCampaign with hand-made records that look like ordinary recordings.
inline void write_campaign(const CommandFolder& folder, const Edits& edits = {}) {
  folder.write("campaign.toml", edited(kCampaign, edits));
  for (const char* name : {"sine_1", "sine_2", "square_1", "square_2"}) {
    std::ostringstream csv;
    csv << "t_s,ref_mm,x_mm,pl_bar\n";
    const double repeat = name[std::string(name).size() - 1] - '0';
    for (int i = 0; i < 400; ++i) {
      const double t = 0.005 * i;
      const double angle = 12.566370614359172 * t;
      const double wobble = 0.01 * std::sin(repeat * 17.0 * i);
      csv << t << ',' << 5.0 * std::sin(angle) << ',' << 4.9 * std::sin(angle - 0.1) + wobble << ','
          << std::cos(angle) + wobble << '\n';
    }
    folder.write(std::string("records/") + name + ".csv", csv.str());
  }
}

/// Makes records of a known rig in `twin/` with the command itself.
///
/// @param campaign  text of a campaign with a section [synthetic]
inline Outcome synthesize_twin(const CommandFolder& folder, const std::string& campaign) {
  folder.write("truth.toml", campaign);
  return folder.run({"synthesize", "truth.toml", "--seed", "3", "--out", "twin", "--quiet"});
}

inline Outcome write_twin(const CommandFolder& folder, const Edits& edits = {}) {
  return synthesize_twin(folder, edited(kCampaign, edits) + kSynthetic);
}

}  // namespace rigcal::test
