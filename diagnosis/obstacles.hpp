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

/// Why no condition of a campaign can be diagnosed at all, in words; empty if one can. Each reason
/// is found by a check that holds for any campaign:
///   a condition lacks what a comparison with the model needs (datasets::lacks_for_model), or the
///   position, whose residual the classes stand on;
///   nothing tells what the rig was before: no fit;
///   the leak level goes together with the specimen, the date or the temperature of the records, so
///   that a difference between levels need not be a leak.
/// Confounding alone does not forbid a diagnosis by a fitted model, but its judgement by labels: it
/// is a reason only beside others, and else a warning (see confounded).
///
/// @param has_fit  whether a fit of the rig is given
std::vector<std::string> obstacles(const datasets::Campaign& campaign, bool has_fit);

/// Factors that differ wherever the leak level differs, in words.
std::vector<std::string> confounded(const datasets::Campaign& campaign);

/// Lists, in words, what the diagnosis assumes to be as on the day of the reference: oil, and
/// supply unless it was recorded. The reference is the healthy conditions, or the fitted ones if
/// there are none. Empty if all conditions have dates of the reference.
std::vector<std::string> other_days(const datasets::Campaign& campaign);

}  // namespace rigcal::diagnosis
