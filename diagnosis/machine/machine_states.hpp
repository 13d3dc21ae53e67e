#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnosis/machine/machine_state.hpp"
#include "diagnosis/record/prepared.hpp"
#include "diagnosis/record/record_diagnosis.hpp"

namespace rigcal::diagnosis {

/// Returns a verdict on the machine in each of its states, based on the averages of all conditions
/// in that state. The leak share is stated for the same duty in all states.
///
/// @param records  records that have been fitted and judged
/// @param errors   errors of each signal
/// @throws InputError  if the campaign names a duty that cannot be diagnosed
std::vector<MachineState> machine_states(const LeakProblem& problem, const RigFit& rig,
                                         const std::vector<Prepared>& all,
                                         const std::vector<RecordDiagnosis>& records,
                                         const std::map<std::string, SignalErrors>& errors,
                                         const DayVariance& days = {});

}  // namespace rigcal::diagnosis
