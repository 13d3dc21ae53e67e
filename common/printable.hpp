#pragma once

#include <string>
#include <string_view>

namespace rigcal {

/// Text as a terminal may show it: names of files, columns and campaigns may hold what would move
/// its cursor, set its title, or show text in another order than it has. Control characters (C0 but
/// for line ends, DEL, C1), marks of direction and of lines, and bytes that are no UTF-8 become
/// "\u001B" or "\xFF"; a text without any stays as it is. What is valid JSON stays that, of the
/// same texts.
///
/// @param coloured  keep the sequences that make text bold or coloured
std::string printable(std::string_view text, bool coloured = false);

/// Writes printable() text; where all that goes to stderr does.
void say(std::string_view text);

}  // namespace rigcal
