#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Returns the conditions that a diagnosis considers: all except those with use `ignore`.
std::vector<const datasets::Condition*> diagnosed_conditions(const datasets::Campaign& campaign);

/// Lists, in words, what a condition lacks for a diagnosis; empty if it lacks nothing.
std::vector<std::string> lacks_for_diagnosis(const datasets::Campaign& campaign,
                                             const datasets::Condition& condition);

/// Returns true if the leak level of a condition is known to be healthy, because it has the class
/// normal in [diagnosis] or a known leakage coefficient of 0.
bool is_healthy(const datasets::Campaign& campaign, const datasets::Condition& condition);

/// Lists, in words, why no condition of a campaign can be diagnosed; empty if at least one can. The
/// possible obstacles are:
/// - A condition lacks data for a comparison with the model (datasets::lacks_for_model), or lacks
///   the position, whose residual determines the class.
/// - There is no fit, so the healthy state of the rig is unknown.
/// - The leak level changes together with the specimen, date or temperature of the records, so that
///   a difference between levels need not be due to a leak.
///
/// Confounding alone does not prevent a diagnosis with a fitted model, but only its judgement using
/// labels. It is listed only together with other reasons, and otherwise leads to a warning (see
/// confounded()).
///
/// @param has_fit  true if a fit of the rig is given
std::vector<std::string> obstacles(const datasets::Campaign& campaign, bool has_fit);

/// Lists, in words, the factors that differ wherever the leak level differs.
std::vector<std::string> confounded(const datasets::Campaign& campaign);

}  // namespace rigcal::diagnosis
