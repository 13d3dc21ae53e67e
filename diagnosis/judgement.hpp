#pragma once

#include "diagnosis/diagnose.hpp"

namespace rigcal::diagnosis {

/// Sets the warnings of a record whose leak has been estimated, and its class if this can be
/// decided.
///
/// @param healthy_m  RMS of the structured residual that the healthy model leaves in healthy
///                   records of the signal
void judge(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
           const datasets::DiagnosisSettings& settings);

}  // namespace rigcal::diagnosis
