#pragma once

#include "report/page/section.hpp"

namespace rigcal::report {

StoredBatch load_batch(const ReadFile& read, const std::string& where);
/// Its campaign is the folder of its rigs.
void add_batch(const StoredBatch& batch, Part& part);

}  // namespace rigcal::report
