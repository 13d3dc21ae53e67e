#pragma once

#include <functional>
#include <string>

#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "report/store/json.hpp"

namespace rigcal::report {

/// Findings of `check` about the records of a campaign.
struct Check {
  std::string text;
  Json json;
};

/// Reads and checks every record, one at a time.
///
/// @param keep  receives each record in campaign order; may be empty
/// @throws InputError  if a record is invalid
Check check(const datasets::Campaign& campaign,
            const std::function<void(datasets::Record)>& keep = {});

}  // namespace rigcal::report
