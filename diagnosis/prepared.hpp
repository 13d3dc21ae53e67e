#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/leak/leak_fit.hpp"
#include "diagnosis/leak/leak_memo.hpp"
#include "diagnosis/leak/leak_scan.hpp"

namespace rigcal::diagnosis {

/// A condition with its records and the simulated effects of a leak.
struct Prepared {
  const datasets::Condition* condition = nullptr;
  const datasets::RepeatRecords* records = nullptr;
  LeakScan scan;
  std::shared_ptr<const LeakEffects> effects;  ///< null if none were considered
  Residuals residuals;                         ///< for the average, then for each repeat
  std::string failure;
  std::optional<double> true_share;
  bool is_healthy = false;
  std::shared_ptr<LeakMemo> leaks = std::make_shared<LeakMemo>();

  const std::vector<double>& time_s() const { return records->average.time_s; }
  /// Minimum half width of a curve of shares. A record that is its own reference has no error, and
  /// any width that includes a leak will do.
  double least_reach() const { return 1e-2 * scan.largest_coefficient; }
  /// Coefficient whose share is a ten-thousandth of the smallest share of interest.
  double negligible() const { return 1e-4 * least_reach(); }
};

}  // namespace rigcal::diagnosis
