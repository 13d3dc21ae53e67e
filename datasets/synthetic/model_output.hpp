#pragma once

#include <optional>

#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::datasets {

/// Returns the model output that a recorded channel measures; std::nullopt for channels that only
/// drive the model.
std::optional<model::Output> model_output(Channel channel);

}  // namespace rigcal::datasets
