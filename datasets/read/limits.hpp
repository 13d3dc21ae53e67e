#pragma once

#include <cstddef>

namespace rigcal::datasets {

/// Numbers that are taken from one file at most. 96 MB of them: with the window on a text file,
/// loading stays below 200 MB.
inline constexpr std::size_t kMostValues = 12'000'000;

}  // namespace rigcal::datasets
