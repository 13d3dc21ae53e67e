#pragma once

#include "report/page/section.hpp"

namespace rigcal::report {

StoredBatch load_batch(const ReadFile& read, const std::string& where);
/// Adds a batch. The folder of the rigs is shown in place of a campaign.
void add_batch(const StoredBatch& batch, Part& part);

}  // namespace rigcal::report
