#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "calib/consider/catalogue.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/estimate_spread.hpp"
#include "calib/trust/prediction_band.hpp"

namespace rigcal::calib {

/// Those of the effects that a fit considered which may act in a problem, the curved ones with
/// their secant at the size that prior and records leave them.
std::vector<Effect> considered_in(const Problem& problem, std::span<const double> z,
                                  const EffectSpread& effects);

/// What the effects that a fit considered do to one condition at any values of the parameters; an
/// effect that does not act there has zeros.
///
/// @param acting   from considered_in()
/// @param further  outputs that follow the channels
EffectChanges changes_by(const Problem& problem, std::size_t condition,
                         const model::ParameterValues& values, const std::vector<Effect>& acting,
                         const EffectSpread& effects, const std::atomic<bool>* cancel,
                         std::span<const model::Output> further = {});

/// The same for each condition of a problem that is predicted. A condition of use `fit` has none.
std::vector<EffectChanges> predicted_changes(const Problem& problem, std::span<const double> z,
                                             const EffectSpread& effects, int threads,
                                             const std::atomic<bool>* cancel);

/// Changes of the readings of one channel by each effect of its sensor, at the size that prior and
/// records leave it: what the measured side of a score is uncertain by, beside noise.
///
/// @param acting     from considered_in()
/// @param simulated  of the channel, at `time_s`
std::vector<std::vector<double>> sensor_changes(datasets::Channel channel,
                                                const std::vector<Effect>& acting,
                                                const EffectSpread& effects,
                                                std::span<const double> simulated,
                                                std::span<const double> time_s);

}  // namespace rigcal::calib
