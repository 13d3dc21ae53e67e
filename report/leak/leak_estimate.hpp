#pragma once

#include <optional>
#include <utility>

#include "diagnosis/leak/leak_estimate.hpp"
#include "report/store/stored/stored_leak.hpp"

namespace rigcal::report {

inline constexpr double kLitresPerMinute = 60e3;  ///< per m3/s
inline constexpr double kInPercent = 100.0;

/// Both ends times `scale`.
Range scaled_ends(const Range& range, double scale = 1.0);

/// Coefficient, share, flow and class of a leak, for a record or a state; empty without an estimate
/// (`ok` false).
StoredLeak stored(const diagnosis::LeakEstimate& estimate,
                  const std::optional<datasets::LeakClass>& leak_class, bool ok);

}  // namespace rigcal::report
