#pragma once

#include <string>
#include <string_view>

namespace rigcal {

/// Makes text safe to print on a terminal. File, column and campaign names may contain characters
/// that move the cursor, set the title or reverse the text direction. Control characters (C0
/// except newlines, DEL, C1), direction marks, line separators, and bytes that are not UTF-8
/// become "\u001B" or "\xFF". Other text is unchanged. Valid JSON remains valid, with the same
/// strings.
///
/// @param coloured  whether to keep the escape sequences for bold and colours
std::string printable(std::string_view text, bool coloured = false);

/// Writes printable(text) to stderr. Every message goes through this function.
void say(std::string_view text);

}  // namespace rigcal
