#pragma once

#include <functional>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Use `fit` or `validate`.
bool is_planned_with(const datasets::Condition& condition);

/// Channels of a campaign's records that the model can be compared with.
std::vector<datasets::Channel> compared_channels(const datasets::Campaign& campaign);

/// Noise of a planned record: the channel's `sd`, that of [synthetic] divided by the root of its
/// repeats, or that of the records; with `planned_repeats` that of a single repeat divided by its
/// root.
///
/// @throws InputError  the noise is unknown
double planned_sd(const datasets::Campaign& campaign, const datasets::Condition& condition,
                  datasets::Channel channel, const std::vector<datasets::Record>& records);

/// The record that a condition would give from rest, without noise. Where it cannot be simulated
/// its channels are zero; its evaluation will say why.
///
/// @param sd  standard deviation of a sample of the mean, SI
datasets::Record planned_record(const datasets::Campaign& campaign,
                                const datasets::Condition& condition,
                                const std::function<double(datasets::Channel)>& sd);

}  // namespace rigcal::calib
