#pragma once

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// The first page of a fit or validation, which is the part that is signed.

namespace rigcal::report {

/// The verdict as a badge and a sentence with its numbers.
doc::Verdict fit_verdict(const StoredFit& fit);

/// The blocks below the verdict: all doubts, the calibrated values with their uncertainty, the
/// signals against their limits, the aspects, and the range of validity.
doc::Blocks certificate(const Calibration& stored);

}  // namespace rigcal::report
