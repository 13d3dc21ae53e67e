#pragma once

#include <string>
#include <vector>

#include "report/json/described.hpp"

namespace rigcal::report {

/// How a leak search ended: `declined` if the records cannot answer the question, `failed` if no
/// record gave a result.
enum class LeakStatus { done, declined, failed };
RIGCAL_NAMES(LeakStatus, done, declined, failed)

/// @param reasons  why the search was declined; empty if it was not
/// @param usable   whether any record gave a result
inline LeakStatus leak_status(const std::vector<std::string>& reasons, bool usable) {
  if (!reasons.empty()) return LeakStatus::declined;
  return usable ? LeakStatus::done : LeakStatus::failed;
}

}  // namespace rigcal::report
