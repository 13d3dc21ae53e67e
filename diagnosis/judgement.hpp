#pragma once

#include "diagnosis/diagnose.hpp"

namespace rigcal::diagnosis {

/// Sets the class of a record whose leak has been estimated, unless it is undecided, and its
/// warnings.
///
/// @param healthy_m  structured rms residual that the healthy model leaves in healthy records of
///                   the signal
void judge(RecordDiagnosis& record, const SignalErrors& errors, double healthy_m,
           const datasets::DiagnosisSettings& settings);

}  // namespace rigcal::diagnosis
