#pragma once

#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Returns a warning if each pressure of a record appears to be that of the other chamber. Returns
/// an empty text otherwise, and if the record does not show which is which.
///
/// The pressure in chamber A minus that in chamber B, each times its area, is mass times
/// acceleration plus friction plus load. Friction grows with the velocity, and most loads follow
/// the position. What the acceleration explains beyond position and velocity is therefore positive
/// in chamber A and negative in chamber B, whatever the areas and the load. A warning needs a
/// partial correlation below -0.8 in A and above 0.8 in B, at two resolutions, and the same signs
/// for the velocity.
std::string swapped_chambers_warning(const Campaign& campaign, const Record& record);

}  // namespace rigcal::datasets
