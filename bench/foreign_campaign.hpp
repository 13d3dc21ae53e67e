#pragma once

#include "bench/foreign_rig.hpp"
#include "datasets/campaign/campaign.hpp"

namespace rigcal::bench {

/// What a user knows of the rig: every value but mass, damping, bulk modulus, valve gain and leak,
/// the position channel, and that the rig is at rest before a record begins. No conditions.
datasets::Campaign foreign_campaign(const ForeignRig& rig);

}  // namespace rigcal::bench
