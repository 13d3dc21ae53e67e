#pragma once

#include <functional>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Returns true for conditions with use `fit` or `validate`.
bool is_planned_with(const datasets::Condition& condition);

/// Returns the channels in the campaign's records that the model can be compared with.
std::vector<datasets::Channel> compared_channels(const datasets::Campaign& campaign);

/// Returns the noise of a planned record: the `sd` of the channel, or that of [synthetic] divided
/// by the root of the number of repeats, or that of the existing records. With `planned_repeats` it
/// is the noise of a single repeat divided by the root of that number.
///
/// @throws InputError  if the noise is unknown
double planned_sd(const datasets::Campaign& campaign, const datasets::Condition& condition,
                  datasets::Channel channel, const std::vector<datasets::Record>& records);

/// Simulates the record that a condition would give from rest, without noise. If it cannot be
/// simulated its channels are zero; the evaluation then reports why.
///
/// @param sd  standard deviation of a sample of the mean, SI
datasets::Record planned_record(const datasets::Campaign& campaign,
                                const datasets::Condition& condition,
                                const std::function<double(datasets::Channel)>& sd);

}  // namespace rigcal::calib
