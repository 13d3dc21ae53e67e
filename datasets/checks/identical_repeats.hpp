#pragma once

#include <cstddef>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Finds repeats that have exactly the same samples of a measured channel, as when a file is given
/// twice: noise never repeats. A constant channel, a command or a reference proves nothing.
///
/// @param carriers  indices of the repeats that have the channel
/// @return          for each of them, the index within `carriers` of the first repeat identical to
///                  it; its own index if no earlier one is
std::vector<std::size_t> first_identical(const std::vector<Repeat>& repeats,
                                         const std::vector<std::size_t>& carriers, Channel channel);

}  // namespace rigcal::datasets
