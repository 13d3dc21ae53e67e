#pragma once

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// The first page of a fit or validation, which is the page to be signed.

namespace rigcal::report {

/// Returns the verdict as a badge and a sentence with the key numbers.
doc::Verdict fit_verdict(const StoredFit& fit);

/// Returns the blocks below the verdict: all doubts, the calibrated values with their uncertainty,
/// the signals compared with their limits, the aspects, and the range of validity.
doc::Blocks certificate(const Calibration& stored);

}  // namespace rigcal::report
