#pragma once

#include <cstdint>

#include "datasets/campaign/campaign.hpp"
#include "datasets/synthetic/synthesize.hpp"
#include "report/store/folder.hpp"

namespace rigcal::report {

/// Writes the records of a known rig: all of them, or none if other files are in the way.
///
/// @throws InputError, NoResultError  as for datasets::synthesize()
/// @throws WriteError, UsageError     as for write_results()
datasets::SynthesisReport write_synthesis(HeldFolder& held, const datasets::Campaign& campaign,
                                          std::uint64_t seed, int threads);

}  // namespace rigcal::report
