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
  parameter,   ///< it is added to a parameter: an optional term, a volume
  supply_sag,  ///< the supply falls with the flow that it feeds
  bow,         ///< nonlinearity of the sensor of the motion, in the square of the reading
  wave,        ///< the same, one wave over the range
  hysteresis,  ///< play of the sensor of the motion
};

/// Smallest secant as a multiple of the plausible size; a smaller one is lost in the tolerance of
/// the simulation.
inline constexpr double kLeastSecant = 0.02;

/// One effect that may act in a problem, with its plausible size.
struct Effect {
  EffectKind kind = EffectKind::parameter;
  int index = -1;       ///< row of the parameter table; -1: no parameter describes it
  double range = 0.0;   ///< range of the sensor or the flow to which the size relates, SI
  double middle = 0.0;  ///< reading at the middle of the sensor's range
  /// Whether its secant depends on the size at which it is taken: friction, overlap, play.
  bool curved = false;
  double secant = 1.0;  ///< size at which that is taken, over the plausible size
  ConsideredEffect about;

  /// Whether it changes the reading of the sensor of the motion, not the motion itself.
  bool is_of_sensor() const {
    return kind != EffectKind::parameter && kind != EffectKind::supply_sag;
  }
};

/// The effects that the model of a problem leaves out: rows of the catalogue whose parameter is
/// neither free nor given, whose channel is compared, and whose size follows from the rig
/// (docs/uncertainty.md). Those that the campaign leaves out are not among them.
///
/// @param z  the optimum: sizes follow from the values there
std::vector<Effect> effects_of(const Problem& problem, std::span<const double> z);

/// Those of the rows of the catalogue that the campaign leaves out.
std::vector<std::string> left_out_effects(const Problem& problem, std::span<const double> z);

/// The channel whose sensor a key names ("pressure_a_lag"); none if it names none.
std::optional<datasets::Channel> sensor_channel(std::string_view key);

/// Change of a reading if the sensor of the motion has an error of a given size.
Eigen::VectorXd reading_error(const Effect& effect, const Eigen::VectorXd& reading, double size);

/// Change of the weighted outputs of one condition by each effect, per plausible size. It is a
/// secant: a term that cannot be negative has no derivative at zero, where a lag cannot be
/// simulated. Shape (channels * samples that count, effects); a column that cannot be simulated is
/// NaN.
Eigen::MatrixXd effect_rows(const Problem& problem, std::size_t condition,
                            std::span<const double> z, const std::vector<Effect>& effects,
                            const std::atomic<bool>* cancel);

/// The same in SI for each channel, at any values of the parameters and any times; shape (times,
/// effects).
///
/// @param further  outputs that follow the channels
std::vector<Eigen::MatrixXd> effect_changes(const Problem& problem, std::size_t condition,
                                            const model::ParameterValues& values,
                                            std::span<const double> times_s,
                                            const std::vector<Effect>& effects,
                                            const std::atomic<bool>* cancel,
                                            std::span<const model::Output> further = {});

/// Weighted outputs of one condition with some effects.
struct OutputsWith {
  Eigen::VectorXd outputs;   ///< shape (channels * samples that count); empty: not simulated
  Eigen::MatrixXd jacobian;  ///< by the acting unknowns, SI; without columns if not asked for
  /// By the effects that are of a sensor, in plausible sizes, other columns zero; likewise.
  Eigen::MatrixXd by_sensor;
  bool ok() const { return outputs.size() > 0; }
};
enum class Derivatives { none, of_unknowns };

/// Step of the finite difference by an effect, as a multiple of its plausible size.
inline constexpr double kEffectStep = 0.1;

/// Weighted outputs of one condition with all effects at once. Derivatives take the errors of the
/// position sensor and the supply's fall as given.
///
/// @param sizes  of the effects over their plausible sizes
OutputsWith outputs_with(const Problem& problem, std::size_t condition, std::span<const double> z,
                         const std::vector<Effect>& effects, const Eigen::VectorXd& sizes,
                         Derivatives derivatives, const std::atomic<bool>* cancel);

}  // namespace rigcal::calib
