#pragma once

#include <cstddef>

namespace rigcal::datasets {

/// Maximum number of values read from one file. They take 96 MB. With the buffer for a text file,
/// loading needs less than 200 MB.
inline constexpr std::size_t kMostValues = 12'000'000;

}  // namespace rigcal::datasets
