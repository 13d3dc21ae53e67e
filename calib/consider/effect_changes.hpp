#pragma once

#include <atomic>
#include <span>
#include <string>
#include <vector>

#include "calib/consider/catalogue.hpp"
#include "calib/problem/problem.hpp"
#include "calib/result/estimate_covariance.hpp"
#include "calib/trust/prediction_band.hpp"

namespace rigcal::calib {

/// Selects, from the effects considered in a fit, those that may act in a problem. The secants of
/// curved effects are computed at the sizes that follow from prior and records.
std::vector<Effect> considered_in(const Problem& problem, std::span<const double> z,
                                  const EffectCovariance& effects);

/// Returns the changes in the outputs of one condition due to the effects considered in a fit, at
/// any parameter values. An effect that does not act in the condition has a column of zeros.
///
/// @param acting   from considered_in()
/// @param further  outputs to append after the channels
EffectChanges changes_by(const Problem& problem, std::size_t condition,
                         const model::ParameterValues& values, const std::vector<Effect>& acting,
                         const EffectCovariance& effects, const std::atomic<bool>* cancel,
                         std::span<const model::Output> further = {});

/// Returns changes_by() for each condition that is predicted; empty for conditions with use `fit`.
std::vector<EffectChanges> predicted_changes(const Problem& problem, std::span<const double> z,
                                             const EffectCovariance& effects, int threads,
                                             const std::atomic<bool>* cancel);

/// Change in the readings of one channel due to an effect of its sensor.
struct SensorChange {
  std::string key;             ///< key of the effect
  std::vector<double> change;  ///< shape (samples), unit of the channel
};

/// Returns the changes in the readings of one channel due to each effect of its sensor, at the size
/// that follows from prior and records. In a score, they are the uncertainty of the measured side
/// in addition to noise.
///
/// @param acting     from considered_in()
/// @param simulated  simulated values of the channel at `time_s`
std::vector<SensorChange> sensor_changes(datasets::Channel channel,
                                         const std::vector<Effect>& acting,
                                         const EffectCovariance& effects,
                                         std::span<const double> simulated,
                                         std::span<const double> time_s);

}  // namespace rigcal::calib
