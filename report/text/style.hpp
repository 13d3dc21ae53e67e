#pragma once

#include <cstddef>

namespace rigcal::report {

/// How text is shown.
struct Style {
  bool colour = false;
  std::size_t columns = 0;  ///< columns of the terminal; 0: tables as wide as they are
  std::size_t lines = 0;    ///< that a result may take; 0: as many as it has
  bool everything = false;  ///< also what follows the first page, and what is folded
};

/// Lines of a result on a terminal, unless --verbose asks for all.
inline constexpr std::size_t kTerminalLines = 60;

}  // namespace rigcal::report
