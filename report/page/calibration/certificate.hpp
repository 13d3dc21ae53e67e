#pragma once

#include "report/document/document.hpp"
#include "report/store/stored.hpp"

// The first page of a fit or validation: what is signed.

namespace rigcal::report {

/// The verdict in a word, and in a sentence with its numbers.
doc::Verdict fit_verdict(const StoredFit& fit);

/// What stands beneath it: every doubt, the calibrated values with their uncertainty, the signals
/// against their limits, why the verdict is so, and where the model is valid.
doc::Blocks certificate(const Calibration& stored);

}  // namespace rigcal::report
