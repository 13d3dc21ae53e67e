#pragma once

#include <functional>
#include <vector>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::calib {

/// Returns true for conditions with use `fit` or `validate`.
bool is_planned_with(const datasets::Condition& condition);

/// Returns the channels of the campaign's records with which the model can be compared.
std::vector<datasets::Channel> compared_channels(const datasets::Campaign& campaign);

/// Returns the standard deviation of the noise in a planned record. It is the `sd` of the channel,
/// or the noise in [synthetic] divided by the square root of the number of repeats, or the noise of
/// the existing records. If `planned_repeats` is given, it is the noise of a single repeat divided
/// by the square root of that number.
///
/// @throws InputError  if the noise is unknown
double planned_sd(const datasets::Campaign& campaign, const datasets::Condition& condition,
                  datasets::Channel channel, const std::vector<datasets::Record>& records);

/// Simulates the noise-free record that a condition would give when it starts from rest. If the
/// simulation fails, the channels are zero, and a later evaluation reports the reason.
///
/// @param sd  returns the standard deviation of a sample of the averaged channel, SI
datasets::Record planned_record(const datasets::Campaign& campaign,
                                const datasets::Condition& condition,
                                const std::function<double(datasets::Channel)>& sd);

}  // namespace rigcal::calib
