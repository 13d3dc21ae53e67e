#pragma once

#include <string_view>

namespace rigcal::datasets {

/// Whether a text may be the id of a condition. Result files are named after it, so it must not
/// lead to another folder.
bool is_condition_id(std::string_view text);

/// The rule for ids, in words.
std::string_view condition_id_rule();

}  // namespace rigcal::datasets
