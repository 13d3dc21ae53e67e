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
  parameter,   ///< it adds to a parameter: an optional term, a volume
  sampling,    ///< the controller acts at ticks; the parameter is their period
  supply_sag,  ///< the supply pressure falls with the flow taken from it
  valve_play,  ///< the spool moves only after the signal has taken up the play
  bow,         ///< nonlinearity of the motion sensor, quadratic in the reading
  wave,        ///< nonlinearity of the motion sensor, one sine wave over the range
  hysteresis,  ///< play of the motion sensor
};

/// Smallest secant as a multiple of the plausible size. A smaller one would be lost in the
/// tolerance of the simulation.
inline constexpr double kLeastSecant = 0.02;

/// One effect that may act in a problem, with its plausible size.
struct Effect {
  EffectKind kind = EffectKind::parameter;
  int index = -1;       ///< row of the parameter table; -1: no parameter describes it
  double range = 0.0;   ///< range of the sensor, or the flow, to which the size refers, SI
  double middle = 0.0;  ///< reading at the middle of the sensor's range
  /// Whether the secant depends on the size at which it is computed: friction, overlap, play.
  bool curved = false;
  double secant = 1.0;  ///< size at which the secant is computed, over the plausible size
  ConsideredEffect about;

  /// Whether the effect changes the reading of the motion sensor rather than the motion itself.
  bool is_of_sensor() const {
    return kind == EffectKind::bow || kind == EffectKind::wave || kind == EffectKind::hysteresis;
  }
};

/// Effects that the model of a problem omits: rows of the catalogue whose parameter is neither free
/// nor given, whose channel is compared, and whose size can be derived from the rig
/// (docs/uncertainty.md). Effects that the campaign leaves out are excluded.
///
/// @param z  the optimum, at which the sizes are computed
std::vector<Effect> effects_of(const Problem& problem, std::span<const double> z);

/// Keys of the catalogue that the campaign leaves out.
std::vector<std::string> left_out_effects(const Problem& problem, std::span<const double> z);

/// The channel whose sensor a key refers to, for example "pressure_a_lag"; std::nullopt if it does
/// not refer to a sensor.
std::optional<datasets::Channel> sensor_channel(std::string_view key);

/// Change of a reading due to an error of the motion sensor of the given size.
Eigen::VectorXd reading_error(const Effect& effect, const Eigen::VectorXd& reading, double size);

/// Change of the weighted outputs of one condition due to each effect, per plausible size. It is a
/// secant, because a term that cannot be negative has no derivative at zero, and a lag of zero
/// cannot be simulated. Shape (channels * samples that count, effects). If an effect cannot be
/// simulated, its column is NaN.
Eigen::MatrixXd effect_rows(const Problem& problem, std::size_t condition,
                            std::span<const double> z, const std::vector<Effect>& effects,
                            const std::atomic<bool>* cancel);

/// Changes of each channel in SI due to each effect, per plausible size, at any parameter values
/// and times. One matrix per channel, shape (times, effects); NaN as in effect_rows().
///
/// @param further  outputs to append after the channels
std::vector<Eigen::MatrixXd> effect_changes(const Problem& problem, std::size_t condition,
                                            const model::ParameterValues& values,
                                            std::span<const double> times_s,
                                            const std::vector<Effect>& effects,
                                            const std::atomic<bool>* cancel,
                                            std::span<const model::Output> further = {});

/// Weighted outputs of one condition with some effects active.
struct OutputsWith {
  Eigen::VectorXd
      outputs;  ///< shape (channels * samples that count); empty if the simulation failed
  Eigen::MatrixXd
      jacobian;  ///< with respect to the acting unknowns, SI; has no columns if not requested
  /// By the effects that are of a sensor, in plausible sizes, other columns zero; likewise.
  Eigen::MatrixXd by_sensor;
  bool ok() const { return outputs.size() > 0; }
};
enum class Derivatives { none, of_unknowns };

/// Finite-difference step of an effect, as a multiple of its plausible size.
inline constexpr double kEffectStep = 0.1;

/// Weighted outputs of one condition with all effects active at once. The derivatives neglect the
/// dependence of motion sensor errors, supply sag and valve play on the unknowns, and treat the
/// controller as continuous.
///
/// @param sizes  sizes of the effects, as multiples of their plausible sizes
OutputsWith outputs_with(const Problem& problem, std::size_t condition, std::span<const double> z,
                         const std::vector<Effect>& effects, const Eigen::VectorXd& sizes,
                         Derivatives derivatives, const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
