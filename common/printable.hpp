#pragma once

#include <string>
#include <string_view>

namespace rigcal {

/// Makes text safe to print on a terminal. Names of files, columns and campaigns may contain
/// characters that move the cursor, set the window title or reverse the text direction. Control
/// characters (C0 except newlines, DEL, C1), direction marks and line separators are replaced by
/// escapes such as "\u001B", and bytes that are not UTF-8 by escapes such as "\xFF". Valid JSON
/// remains valid and keeps its strings.
///
/// @param coloured  whether to keep the escape sequences for bold and colours
std::string printable(std::string_view text, bool coloured = false);

/// Writes printable(text) to stderr. Every message goes through this function.
void say(std::string_view text);

}  // namespace rigcal
