#pragma once

#include <atomic>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/parameter_map.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "model/simulate.hpp"

namespace rigcal::calib {

/// Fidelity of one simulation: tolerance, horizon, with or without sensitivities.
struct Fidelity {
  bool derivatives = true;
  bool exact = false;  ///< as exact as the noise requires, else to within about a standard error
  /// Length of each record that is used, counted from the first sample in a window; for a sine or
  /// square at most the first period. Infinite: all samples.
  double horizon_s = std::numeric_limits<double>::infinity();

  static const Fidelity cost;  ///< the cost of a start
  static const Fidelity coarse;
  static const Fidelity full;
  static constexpr Fidelity first(double length_s) { return {true, false, length_s}; }

  bool whole() const { return horizon_s == std::numeric_limits<double>::infinity(); }
  friend bool operator==(const Fidelity&, const Fidelity&) = default;
};

inline constexpr Fidelity Fidelity::cost{false, false};
inline constexpr Fidelity Fidelity::coarse{true, false};
inline constexpr Fidelity Fidelity::full{true, true};

/// One recorded channel that the model is compared with.
struct ProblemChannel {
  datasets::Channel channel = datasets::Channel::position;
  std::vector<double> measured;  ///< SI, samples that count
  double sd = 0.0;               ///< divisor of the residuals, SI
  bool sd_known = false;         ///< false: estimated from the residual of the fit
  double peak_to_peak = 0.0;     ///< peak-to-peak of `measured`
};

/// One condition with everything that its simulation needs. Borrows the campaign and the record.
struct ProblemCondition {
  const datasets::Condition* condition = nullptr;
  const datasets::Record* record = nullptr;
  model::Rig rig;
  model::ParameterValues values;  ///< values of everything that is not an unknown
  model::SimulationInputs inputs;
  std::vector<ProblemChannel> channels;
  std::vector<model::Output> outputs;  ///< outputs of the channels
  std::vector<std::size_t> rows;       ///< samples that count (inside the windows)
  std::vector<int> free;               ///< table indices of the acting unknowns
  std::size_t first_period_rows = 0;   ///< number of `rows` that are in the first period
  long max_steps = 0;                  ///< budget of one simulation
  /// Tolerance of a recorded drive, as measured (measured_tolerance.hpp); 0: it was not.
  double measured_tolerance = 0.0;

  /// Number of `rows` within the horizon of a fidelity.
  std::size_t rows_at(const Fidelity& fidelity) const;
  /// Sample times up to the last that counts.
  std::span<const double> fit_times(const Fidelity& fidelity = Fidelity::full) const {
    return std::span(record->time_s).first(rows[rows_at(fidelity) - 1] + 1);
  }
};

/// The problem to solve: conditions with records, inputs and weights, and the unknowns.
struct Problem {
  const datasets::Campaign* campaign = nullptr;
  ParameterMap map;
  std::vector<ProblemCondition> conditions;
  double tolerance = 0.0;  ///< tolerance of the simulations: the smallest that a condition requires
  bool tolerance_fixed = false;  ///< the campaign fixes it

  /// Tolerance of the simulations of a condition: the measured one, else as much above the least as
  /// its noise is, in shares of the motion, where that is known of all.
  double tolerance_of(std::size_t condition, const Fidelity& fidelity = Fidelity::full) const;
  /// Tolerance far from an optimum.
  double coarse_tolerance() const;
  /// Options of a simulation at the smallest tolerance, with the campaign's method and time limit.
  model::SimulationOptions simulation_options(const std::atomic<bool>* cancel = nullptr) const;
  /// Options of a simulation whose derivatives tell how uncertain something is: a thousandth of
  /// their size is nothing there.
  model::SimulationOptions derivative_options(std::size_t condition) const;
  /// Fraction of all residuals within the horizon of a fidelity.
  double share_at(const Fidelity& fidelity) const;
  /// Whether some record is longer than one period of its drive.
  bool repeats_itself() const;
  /// Fidelity at which start values are evaluated: their derivatives are of use only where the
  /// optimiser begins with whole records.
  Fidelity of_starts() const { return repeats_itself() ? Fidelity::cost : Fidelity::coarse; }
  /// Number of weighted residuals, priors included.
  long residual_count() const;
  bool has_estimated_sd() const;
  /// The least standard deviation that may be estimated for a channel, SI.
  double least_sd(const ProblemChannel& channel) const;
  /// RMS of the weighted residuals below which errors of the simulation dominate: 1 if the noise of
  /// a channel is known, else the limit of least_sd().
  double least_noise() const;
  /// Values of all parameters in a condition at unit-box coordinates z.
  model::ParameterValues values_at(std::size_t condition, std::span<const double> z) const;
  /// SI values of the unknowns.
  std::vector<double> to_physical(std::span<const double> z) const;
  /// Unit-box coordinates of the start values.
  std::vector<double> start() const;
  /// Row of the parameter table of an unknown.
  const model::ParameterSpec& spec(std::size_t unknown) const;
  /// "mass_kg", "leakage_coefficient (leak level 33 %)".
  std::string name(std::size_t unknown) const;
};

/// Channels of a record that count as outputs: recorded, role output, and listed in [fit] outputs
/// if that is given.
std::vector<datasets::Channel> output_channels(const datasets::Campaign& campaign,
                                               const datasets::Record& record);

/// Samples of a record inside the windows of the condition, or those found from the record; all if
/// there are none.
std::vector<std::size_t> samples_that_count(const datasets::Condition& condition,
                                            const datasets::Record& record);

/// Smallest tolerance that the noise of the channels requires, between 1e-8 and 1e-6.
///
/// @param estimated  also count channels of estimated noise
double tolerance_from_noise(const std::vector<ProblemCondition>& conditions, bool estimated);

/// Sets up the problem of some conditions.
///
/// @param records        found by their `condition`
/// @param nuisance_only  true: only nuisance parameters are unknown
/// @param fitted         values of an earlier fit that hold in place of the rig's; may be null
/// @throws InputError    a record is missing or has no output channel, no sample counts, a channel
///                       that is constant and of unknown noise everywhere, a fitted level is
///                       missing
Problem make_problem(const datasets::Campaign& campaign,
                     const std::vector<datasets::Record>& records,
                     const std::vector<const datasets::Condition*>& conditions, bool nuisance_only,
                     const std::vector<datasets::FittedValue>* fitted);

}  // namespace rigcal::calib
