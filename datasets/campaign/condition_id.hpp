#pragma once

#include <string_view>

namespace rigcal::datasets {

/// Whether a text may be the id of a condition. Files of the results are named after it: nothing in
/// it leads to another folder.
bool is_condition_id(std::string_view text);

/// What is expected of one, in words.
std::string_view condition_id_rule();

}  // namespace rigcal::datasets
