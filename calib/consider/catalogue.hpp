#pragma once

#include <Eigen/Core>
#include <atomic>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/problem/problem.hpp"
#include "calib/result/considered.hpp"

namespace rigcal::calib {

/// How an effect enters a simulation.
enum class EffectKind {
  parameter,   ///< adds to a parameter, such as an optional term or a volume
  sampling,    ///< the controller acts only at ticks, and the parameter is their period
  supply_sag,  ///< the supply pressure falls with the flow taken from it
  valve_play,  ///< the spool moves only after the signal has taken up the play
  underlap,    ///< near null the spool opens twice as far as its signal
  loop_gain,   ///< gain of the sensor whose reading is both recorded and fed back to the controller
  bow,         ///< nonlinearity of the motion sensor that is quadratic in the reading
  wave,        ///< nonlinearity of the motion sensor in the form of one sine wave over the range
  hysteresis,  ///< play of the motion sensor
};

/// Minimum size for a secant, as a multiple of the plausible size. The effect of a smaller one
/// would be lost in the tolerance of the simulation.
inline constexpr double kLeastSecant = 0.02;

/// One effect that may act in a problem, with its plausible size.
struct Effect {
  EffectKind kind = EffectKind::parameter;
  int index = -1;       ///< row of the parameter table; -1 if no parameter describes the effect
  double sign = 1.0;    ///< -1 if the effect lowers its parameter
  double range = 0.0;   ///< range of the sensor, or the flow, that the size refers to, SI
  double middle = 0.0;  ///< reading at the middle of the sensor's range
  /// True if the secant depends on the size at which it is computed, as for friction, overlap and
  /// play.
  bool curved = false;
  /// Size at which the secant is computed, as a multiple of the plausible size.
  double secant = 1.0;
  /// True if the secant is to the point at which the estimates have followed the effect.
  bool followed = false;
  ConsideredEffect about;

  /// Returns true if the effect changes the reading of the motion sensor rather than the motion
  /// itself.
  bool is_of_sensor() const {
    return kind == EffectKind::bow || kind == EffectKind::wave || kind == EffectKind::hysteresis;
  }
  /// Returns true if the effect is an error of the spool that follows from a simulation without it.
  bool is_of_spool() const {
    return kind == EffectKind::valve_play || kind == EffectKind::underlap;
  }
};

/// Returns the effects that the model of a problem omits: rows of the catalogue whose parameter is
/// neither free nor given, whose channel is compared, and whose size can be derived from the rig
/// (docs/uncertainty.md). Effects that the campaign excludes are left out.
///
/// @param z  the optimum, at which the sizes are computed
std::vector<Effect> effects_of(const Problem& problem, std::span<const double> z);

/// Returns the keys of the catalogue that the campaign excludes.
std::vector<std::string> left_out_effects(const Problem& problem, std::span<const double> z);

/// Returns the channel whose sensor a key such as "pressure_a_lag" refers to, or std::nullopt if
/// the key does not refer to a sensor.
std::optional<datasets::Channel> sensor_channel(std::string_view key);

/// Returns the change in a reading due to an error of the motion sensor with the given size.
Eigen::VectorXd reading_error(const Effect& effect, const Eigen::VectorXd& reading, double size);

/// Returns the change in the weighted outputs of one condition due to each effect, per plausible
/// size. The change is a secant, because a term that cannot be negative has no derivative at zero,
/// and a lag of zero cannot be simulated. Shape (channels * samples that count, effects). If an
/// effect cannot be simulated, its column is NaN.
Eigen::MatrixXd effect_rows(const Problem& problem, std::size_t condition,
                            std::span<const double> z, const std::vector<Effect>& effects,
                            const std::atomic<bool>* cancel);

/// Returns the change in each channel due to each effect, SI per plausible size, at any parameter
/// values and times. There is one matrix per channel, of shape (times, effects), with columns of
/// NaN as in effect_rows().
///
/// @param further  outputs to append after the channels
std::vector<Eigen::MatrixXd> effect_changes(const Problem& problem, std::size_t condition,
                                            const model::ParameterValues& values,
                                            std::span<const double> times_s,
                                            const std::vector<Effect>& effects,
                                            const std::atomic<bool>* cancel,
                                            std::span<const model::Output> further = {});

/// Weighted outputs of one condition when some effects are active.
struct OutputsWith {
  Eigen::VectorXd
      outputs;  ///< shape (channels * samples that count); empty if the simulation failed
  Eigen::MatrixXd jacobian;  ///< derivatives with respect to the acting unknowns, SI; without
                             ///< columns if not requested
  /// Derivatives with respect to each effect, per plausible size. They are computed only for the
  /// effects of a sensor; other columns are zero. Without columns if not requested.
  Eigen::MatrixXd by_sensor;
  bool ok() const { return outputs.size() > 0; }
};
enum class Derivatives { none, of_unknowns };

/// Finite-difference step for the size of an effect, as a multiple of its plausible size.
inline constexpr double kEffectStep = 0.1;

/// Returns the weighted outputs of one condition with all effects active at once. The derivatives
/// neglect how motion sensor errors, supply sag and valve play depend on the unknowns, and treat
/// the controller as continuous and its gains as those of an exact sensor.
///
/// @param sizes  sizes of the effects, as multiples of their plausible sizes
OutputsWith outputs_with(const Problem& problem, std::size_t condition, std::span<const double> z,
                         const std::vector<Effect>& effects, const Eigen::VectorXd& sizes,
                         Derivatives derivatives, const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
