#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "calib/result/uncertainty_budget.hpp"
#include "report/json/described.hpp"
#include "report/store/described_campaign.hpp"

// Members that the results of leak searches have in common.

namespace rigcal::report {

/// How a leak search ended: `declined` if the records cannot answer the question, `failed` if no
/// record gave a result.
enum class LeakStatus { done, declined, failed };
RIGCAL_NAMES(LeakStatus, done, declined, failed)

/// A leak and its class; empty if it could not be estimated.
struct StoredLeak {
  std::optional<double> leakage_coefficient;
  std::optional<Range> ci95;  ///< interval of the coefficient
  std::optional<double> standard_error;
  Omittable<calib::Budget95> budget;         ///< contributions to the standard error
  std::optional<double> leak_share_percent;  ///< percentage of the servo flow
  std::optional<Range> leak_share_ci95_percent;
  std::optional<double> leak_share_upper_limit_percent;
  Omittable<calib::Budget95> share_budget;  ///< the share to first order, in percentage points
  std::optional<double> leak_flow_l_per_min;
  std::optional<bool> leak_detected;
  /// False if the coefficient is significantly negative; then no leak is reported.
  Later<std::optional<bool>> compatible_with_model;
  std::optional<datasets::LeakClass> class_;  ///< absent if undecided
  Keyed<std::optional<double>> class_probabilities;
  RIGCAL_DESCRIBE(leakage_coefficient, ci95, standard_error, budget, leak_share_percent,
                  leak_share_ci95_percent, leak_share_upper_limit_percent, share_budget,
                  leak_flow_l_per_min, leak_detected, compatible_with_model, class_,
                  class_probabilities)
};

}  // namespace rigcal::report
