#pragma once

#include "bench/foreign_rig.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::bench {

/// Returns the campaign of a user who knows that the rig is at rest before a record begins, and
/// knows all values except mass, damping, bulk modulus, valve gain and leak. It has a position
/// channel, but no conditions.
datasets::Campaign foreign_campaign(const ForeignRig& rig);

}  // namespace rigcal::bench
