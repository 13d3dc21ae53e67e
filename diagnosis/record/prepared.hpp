#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/record/leak_fit.hpp"
#include "diagnosis/record/leak_memo.hpp"
#include "diagnosis/record/leak_scan.hpp"

namespace rigcal::diagnosis {

/// A condition with its records and everything that was simulated in preparation for the leak fits.
struct Prepared {
  const datasets::Condition* condition = nullptr;
  const datasets::RepeatRecords* records = nullptr;
  LeakScan scan;
  std::shared_ptr<const LeakEffects> effects;  ///< null if no effects were considered
  Residuals residuals;                         ///< first for the average, then for each repeat
  std::string failure;
  std::optional<double> true_share;
  bool is_healthy = false;
  std::shared_ptr<LeakMemo> leaks;      ///< with slopes by the rig's parameters
  std::shared_ptr<LeakMemo> day_leaks;  ///< with slopes by the day quantities

  /// Makes a memo of its leaks. A condition with several records needs leaks that are close to each
  /// other, so interpolation pays. For a single record it would need more nodes than leaks.
  std::shared_ptr<LeakMemo> memo(const std::vector<int>& further) const {
    return std::make_shared<LeakMemo>(
        further, records->singles.empty() ? Between::simulated : Between::interpolated,
        scan.best_coefficient > 0.0 ? scan.best_coefficient : least_reach());
  }
  const std::vector<double>& time_s() const { return records->average.time_s; }
  /// Minimum half-width of a curve of shares. It is needed for a record that is its own reference:
  /// its error is zero, and any width that includes a leak is sufficient.
  double least_reach() const { return 1e-2 * scan.largest_coefficient; }
  /// A coefficient so small that its leak need not be simulated.
  double negligible() const { return 1e-4 * least_reach(); }
};

}  // namespace rigcal::diagnosis
