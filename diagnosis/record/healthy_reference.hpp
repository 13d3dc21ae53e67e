#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "metrics/residual_features.hpp"

namespace rigcal::diagnosis {

/// Difference between a healthy record and the healthy model, on the record's own time base.
struct TimedResidual {
  const std::map<datasets::Channel, std::vector<double>>* channels = nullptr;
  const std::vector<double>* time_s = nullptr;
};

/// Subtracts the mean residual of healthy records from every channel of a record. Each healthy
/// record contributes the sample that is nearest in time.
void take_off(std::span<const TimedResidual> healthy, datasets::Record& record);

/// Returns the features of a parity residual within the times that a record covers, ends included.
///
/// @param residual  shape (time_s)
/// @param covered   if std::nullopt, the whole residual is used
metrics::ResidualFeatures features_within(const std::vector<double>& residual,
                                          const std::vector<double>& time_s,
                                          const std::optional<datasets::TimeWindow>& covered);

}  // namespace rigcal::diagnosis
