#pragma once

#include <optional>

#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::datasets {

/// What the model computes for a recorded channel; empty for those that only drive it.
std::optional<model::Output> model_output(Channel channel);

}  // namespace rigcal::datasets
