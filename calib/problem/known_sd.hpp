#pragma once

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Standard deviation of a channel's averaged samples, SI. It comes from the repeats, or else from
/// the campaign's `sd`; NaN without either. Residuals are divided by it.
double known_sd(const datasets::Campaign& campaign, datasets::Channel channel,
                const datasets::Series& series);

}  // namespace rigcal::calib
