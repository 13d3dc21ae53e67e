#pragma once

#include <optional>

#include "calib/result/uncertainty_budget.hpp"
#include "common/describe.hpp"
#include "common/range.hpp"
#include "diagnosis/record/leak_estimate.hpp"

namespace rigcal::diagnosis {

inline constexpr double kInPercent = 100.0;

/// Returns a null probability for every class.
Keyed<std::optional<double>> no_probabilities();

/// The leak of a record or a state as results state it. What cannot be stated is absent.
struct StatedLeak {
  std::optional<double> leakage_coefficient;  ///< not negative
  std::optional<Range> ci95;                  ///< interval of the coefficient
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
  std::optional<LeakClass> class_;  ///< absent if undecided
  Keyed<std::optional<double>> class_probabilities = no_probabilities();
  RIGCAL_DESCRIBE(leakage_coefficient, ci95, standard_error, budget, leak_share_percent,
                  leak_share_ci95_percent, leak_share_upper_limit_percent, share_budget,
                  leak_flow_l_per_min, leak_detected, compatible_with_model, class_,
                  class_probabilities)
};

/// States an estimate. If it is incompatible with the model, only its error is stated; if its share
/// is impossible, neither share nor class.
///
/// @param least_probability  the most probable class is stated if it is at least this probable
StatedLeak stated(const LeakEstimate& estimate, double least_probability);

}  // namespace rigcal::diagnosis
