#pragma once

#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Conditions for a diagnosis: all except those of use `ignore`.
std::vector<const datasets::Condition*> diagnosed_conditions(const datasets::Campaign& campaign);

/// What a condition lacks for a diagnosis, in words; empty if it lacks nothing.
std::vector<std::string> lacks_for_diagnosis(const datasets::Campaign& campaign,
                                             const datasets::Condition& condition);

/// Leak levels that are known to be healthy: class normal in [diagnosis], or a known leakage
/// coefficient of 0.
bool is_healthy(const datasets::Campaign& campaign, const datasets::Condition& condition);

/// Lists, in words, why no condition of a campaign can be diagnosed; empty if one can. The checks
/// apply to any campaign:
///   a condition lacks data for a comparison with the model (datasets::lacks_for_model), or the
///   position, whose residual the classes are based on;
///   there is no fit, so the healthy state of the rig is unknown;
///   the leak level changes together with the specimen, the date or the temperature of the records,
///   so a difference between levels need not be a leak.
/// Confounding alone does not prevent a diagnosis by a fitted model, only its judgement by labels.
/// It is a reason only beside others, and otherwise a warning (see confounded).
///
/// @param has_fit  whether a fit of the rig is given
std::vector<std::string> obstacles(const datasets::Campaign& campaign, bool has_fit);

/// Factors that differ wherever the leak level differs, in words.
std::vector<std::string> confounded(const datasets::Campaign& campaign);

}  // namespace rigcal::diagnosis
