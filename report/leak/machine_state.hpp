#pragma once

#include <string>

#include "diagnosis/machine_state.hpp"
#include "report/store/stored/stored_diagnosis.hpp"

namespace rigcal::report {

/// Describes the state of a machine and its uncertainty in one sentence for an operator: "The seal
/// of 66.66 % leaks 15.0 % (14.8 to 15.2 %) of the servo flow at sine 0.1 Hz, 50.8 mm: medium
/// (probability 1.00), 5.0 percentage points below critical. 6 signals agree."
std::string state_sentence(const diagnosis::MachineState& state);

/// Builds an entry of `states` in diagnosis.json.
StoredState stored(const diagnosis::MachineState& state);

}  // namespace rigcal::report
