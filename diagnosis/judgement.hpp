#pragma once

#include "diagnosis/diagnose.hpp"

namespace rigcal::diagnosis {

/// Gives a record whose leak is estimated its class, unless it is undecided, and its warnings.
///
/// @param healthy_m  structured rms that the healthy model leaves in healthy records of the signal
void judge(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
           const datasets::DiagnosisSettings& settings);

}  // namespace rigcal::diagnosis
