#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "calib/consider/catalogue.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/estimate_spread.hpp"
#include "calib/trust/prediction_band.hpp"

namespace rigcal::calib {

/// Selects the effects considered in a fit that may act in a problem. The secants of curved effects
/// are taken at the sizes that prior and records give.
std::vector<Effect> considered_in(const Problem& problem, std::span<const double> z,
                                  const EffectSpread& effects);

/// Changes of the outputs of one condition due to the effects considered in a fit, at any parameter
/// values. An effect that does not act there has zeros.
///
/// @param acting   from considered_in()
/// @param further  outputs to append after the channels
EffectChanges changes_by(const Problem& problem, std::size_t condition,
                         const model::ParameterValues& values, const std::vector<Effect>& acting,
                         const EffectSpread& effects, const std::atomic<bool>* cancel,
                         std::span<const model::Output> further = {});

/// changes_by() for each condition that is predicted; empty for conditions of use `fit`.
std::vector<EffectChanges> predicted_changes(const Problem& problem, std::span<const double> z,
                                             const EffectSpread& effects, int threads,
                                             const std::atomic<bool>* cancel);

/// Changes of the readings of one channel due to each effect of its sensor, at the size that prior
/// and records give. They are the uncertainty of the measured side of a score in addition to noise.
///
/// @param acting     from considered_in()
/// @param simulated  simulated values of the channel at `time_s`
std::vector<std::vector<double>> sensor_changes(datasets::Channel channel,
                                                const std::vector<Effect>& acting,
                                                const EffectSpread& effects,
                                                std::span<const double> simulated,
                                                std::span<const double> time_s);

}  // namespace rigcal::calib
