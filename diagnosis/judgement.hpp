#pragma once

#include "diagnosis/diagnose.hpp"

namespace rigcal::diagnosis {

/// States the leak of a record that has been estimated, with its class if this can be decided, and
/// sets the warnings. The leak of a healthy reference is not stated.
///
/// @param healthy_m  RMS of the structured residual that the healthy model leaves in healthy
///                   records of the signal
void judge(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
           const datasets::DiagnosisSettings& settings);

}  // namespace rigcal::diagnosis
