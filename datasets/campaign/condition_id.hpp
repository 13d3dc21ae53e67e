#pragma once

#include <string_view>

namespace rigcal::datasets {

/// Whether a text is allowed as the id of a condition. The id becomes part of file names, so it
/// must not refer to another folder.
bool is_condition_id(std::string_view text);

/// Returns the rule for ids in words, for messages.
std::string_view condition_id_rule();

}  // namespace rigcal::datasets
