#pragma once

#include <optional>
#include <utility>

#include "common/quantity.hpp"
#include "diagnosis/leak/leak_estimate.hpp"
#include "report/store/stored/stored_leak.hpp"

namespace rigcal::report {

inline constexpr double kInPercent = 100.0;

/// Multiplies both ends of a range by `scale`.
Range scaled_ends(const Range& range, double scale = 1.0);

/// Collects coefficient, share, flow and class of the leak in a record or a state. All are absent
/// if there is no estimate (`ok` is false).
StoredLeak stored(const diagnosis::LeakEstimate& estimate,
                  const std::optional<datasets::LeakClass>& leak_class, bool ok);

}  // namespace rigcal::report
