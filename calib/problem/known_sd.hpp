#pragma once

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Standard deviation of a channel's averaged samples, SI, as its repeats tell it, else the
/// campaign's `sd`; NaN if neither does. What residuals are divided by.
double known_sd(const datasets::Campaign& campaign, datasets::Channel channel,
                const datasets::Series& series);

}  // namespace rigcal::calib
