#pragma once

#include <cstddef>
#include <vector>

#include "datasets/record.hpp"

namespace rigcal::datasets {

/// Repeats that hold exactly the same samples of a measured channel, as one file given twice does;
/// noise does not come twice. Of a constant channel, and of a command or reference, that says
/// nothing.
///
/// @param carriers  indices of the repeats that carry the channel
/// @return          per carrier the place, among the carriers, of the first that is identical to
///                  it: its own place where there is none before it
std::vector<std::size_t> first_identical(const std::vector<Repeat>& repeats,
                                         const std::vector<std::size_t>& carriers, Channel channel);

}  // namespace rigcal::datasets
