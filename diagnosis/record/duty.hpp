#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "datasets/campaign/campaign.hpp"

namespace rigcal::diagnosis {

/// Chooses the duty, that is, the condition for whose motion leak shares are stated. This is the
/// condition named by `wanted`, or, if that is empty, the slowest generated sine (the largest, if
/// several are equally slow), or otherwise the first condition.
///
/// @param all  shape (conditions), at least one
/// @return     index in `all`; std::nullopt if no condition has the name
std::optional<std::size_t> duty_among(const std::vector<const datasets::Condition*>& all,
                                      const std::string& wanted);

}  // namespace rigcal::diagnosis
