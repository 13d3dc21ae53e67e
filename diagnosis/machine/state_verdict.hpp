#pragma once

#include <string>
#include <vector>

#include "diagnosis/machine/machine_state.hpp"

namespace rigcal::diagnosis {

/// Describes the state of a machine and its uncertainty in one sentence for an operator: "The seal
/// of 66.66 % leaks 15.0 % (14.8 to 15.2 %) of the servo flow at sine 0.1 Hz, 50.8 mm: medium
/// (probability 1.00), 5.0 percentage points below critical. 6 signals agree."
std::string state_sentence(const MachineState& state);

/// Sets what results state of a state: its leak, leakage area, nearest limit and sentence. They
/// follow from its members, their pooled leak and the estimate at the duty.
void give_verdict(const datasets::DiagnosisSettings& settings, MachineState& state);

/// Returns the states without healthy references, largest leak first.
std::vector<const MachineState*> judged_states(const std::vector<MachineState>& states);

/// What the states of a campaign say together: `leak` if one of them leaks, `no_leak` if all are
/// normal, `not_judged` if none has a class.
enum class Finding { leak, no_leak, unclear, not_judged };
Finding finding_of(const std::vector<MachineState>& states);

}  // namespace rigcal::diagnosis
