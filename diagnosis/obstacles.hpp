#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Conditions that a diagnosis considers: all except those with use `ignore`.
std::vector<const datasets::Condition*> diagnosed_conditions(const datasets::Campaign& campaign);

/// Lists, in words, what a condition lacks for a diagnosis; empty if it lacks nothing.
std::vector<std::string> lacks_for_diagnosis(const datasets::Campaign& campaign,
                                             const datasets::Condition& condition);

/// Whether the leak level of a condition is known to be healthy, through class normal in
/// [diagnosis] or a known leakage coefficient of 0.
bool is_healthy(const datasets::Campaign& campaign, const datasets::Condition& condition);

/// Lists, in words, why no condition of a campaign can be diagnosed; empty if one can. The checks
/// apply to any campaign:
/// - A condition lacks data for a comparison with the model (datasets::lacks_for_model), or the
///   position, on whose residual the classes are based.
/// - There is no fit, so the healthy state of the rig is unknown.
/// - The leak level changes together with the specimen, the date or the temperature of the records,
///   so a difference between levels need not be a leak.
///
/// Confounding by itself does not prevent a diagnosis with a fitted model, only its judgement by
/// labels. It is listed only together with other reasons, and is otherwise a warning (see
/// confounded()).
///
/// @param has_fit  whether a fit of the rig is given
std::vector<std::string> obstacles(const datasets::Campaign& campaign, bool has_fit);

/// Lists, in words, the factors that differ wherever the leak level differs.
std::vector<std::string> confounded(const datasets::Campaign& campaign);

}  // namespace rigcal::diagnosis
