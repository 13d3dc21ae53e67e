#pragma once

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Returns the standard deviation of a channel's averaged samples, SI, by which residuals are
/// divided. It comes from the repeats, or otherwise from the campaign's `sd`; NaN if there is
/// neither.
double known_sd(const datasets::Campaign& campaign, datasets::Channel channel,
                const datasets::Series& series);

}  // namespace rigcal::calib
