#pragma once

#include <cstddef>

namespace rigcal::report {

struct Style {
  bool colour = false;
  std::size_t columns = 0;  ///< width of the terminal; 0: no limit on the width of tables
  std::size_t lines = 0;    ///< maximum number of lines for a result; 0: no limit
  bool everything = false;  ///< also show what follows the first page, and folded sections
};

/// Number of lines that a result may take on a terminal without --verbose.
inline constexpr std::size_t kTerminalLines = 60;

}  // namespace rigcal::report
