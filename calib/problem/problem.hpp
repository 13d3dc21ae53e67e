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

/// Fidelity of a simulation: its tolerance, its horizon, and whether it computes sensitivities.
struct Fidelity {
  bool derivatives = true;
  bool exact = false;  ///< as exact as the noise requires; if false, to about a standard error
  /// Duration of each record that is used, counted from the first sample in a window and limited to
  /// the first period of a sine or square wave. Infinite: all samples are used.
  double horizon_s = std::numeric_limits<double>::infinity();

  static const Fidelity cost;  ///< for evaluating the cost of a start
  static const Fidelity coarse;
  static const Fidelity full;
  static constexpr Fidelity first(double length_s) { return {true, false, length_s}; }

  bool whole() const { return horizon_s == std::numeric_limits<double>::infinity(); }
  friend bool operator==(const Fidelity&, const Fidelity&) = default;
};

inline constexpr Fidelity Fidelity::cost{false, false};
inline constexpr Fidelity Fidelity::coarse{true, false};
inline constexpr Fidelity Fidelity::full{true, true};

/// One recorded channel with which the model is compared.
struct ProblemChannel {
  datasets::Channel channel = datasets::Channel::position;
  std::vector<double> measured;  ///< values at the samples that count, SI
  double sd = 0.0;               ///< the residuals are divided by this value, SI
  bool sd_known = false;         ///< false if `sd` is estimated from the residual of the fit
  double peak_to_peak = 0.0;     ///< peak-to-peak value of `measured`
};

/// Step budget for simulating a record of which nothing is known but its number of samples.
inline long ample_steps(std::size_t samples) { return 1'000'000 + 50 * static_cast<long>(samples); }

/// One condition with everything that its simulation needs. It does not own the campaign and the
/// record.
struct ProblemCondition {
  const datasets::Condition* condition = nullptr;
  const datasets::Record* record = nullptr;
  model::Rig rig;
  model::ParameterValues values;  ///< values of all parameters that are not unknowns
  model::SimulationInputs inputs;
  std::vector<ProblemChannel> channels;
  std::vector<model::Output> outputs;  ///< the model's output for each channel
  std::vector<std::size_t> rows;       ///< indices of the samples that count (inside the windows)
  std::vector<int> free;               ///< table indices of the acting unknowns
  std::size_t first_period_rows = 0;   ///< number of `rows` within the first period
  long max_steps = 0;                  ///< step budget of one simulation
  /// Measured tolerance at which the errors of a recorded drive are harmless
  /// (measured_tolerance.hpp), without regard to its derivatives; 0 if none was measured.
  double measured_tolerance = 0.0;

  /// Number of `rows` within the horizon of a fidelity.
  std::size_t rows_at(const Fidelity& fidelity) const;
  /// Sample times up to the last sample that counts.
  std::span<const double> fit_times(const Fidelity& fidelity = Fidelity::full) const {
    return std::span(record->time_s).first(rows[rows_at(fidelity) - 1] + 1);
  }
};

/// The problem to solve: the conditions, with their records, inputs and weights, and the unknowns.
struct Problem {
  const datasets::Campaign* campaign = nullptr;
  ParameterMap map;
  std::vector<ProblemCondition> conditions;
  double tolerance = 0.0;        ///< simulation tolerance: the smallest that any condition requires
  bool tolerance_fixed = false;  ///< true if the campaign specifies the tolerance
  /// Ends the simulations that were given no flag of their own; may be null.
  const std::atomic<bool>* cancel = nullptr;

  /// Simulation tolerance for a condition: the measured tolerance if there is one. Otherwise, if
  /// the relative noise of all conditions is known, it exceeds the smallest tolerance in proportion
  /// to the relative noise of the condition.
  double tolerance_of(std::size_t condition, const Fidelity& fidelity = Fidelity::full) const;
  /// Simulation tolerance far from an optimum.
  double coarse_tolerance() const;
  /// Simulation options with the smallest tolerance and the campaign's method and time limit.
  ///
  /// @param own  flag that ends the simulation; if null, the problem's
  model::SimulationOptions simulation_options(const std::atomic<bool>* own = nullptr) const;
  /// Simulation options for derivatives that are only used to compute an uncertainty, where
  /// relative errors of a thousandth do not matter.
  model::SimulationOptions derivative_options(std::size_t condition) const;
  /// Fraction of all residuals within the horizon of a fidelity.
  double share_at(const Fidelity& fidelity) const;
  /// Returns true if any record is longer than one period of its drive.
  bool repeats_itself() const;
  /// Fidelity with which start values are evaluated. Derivatives are useful only if the optimiser
  /// begins with whole records.
  Fidelity of_starts() const { return repeats_itself() ? Fidelity::cost : Fidelity::coarse; }
  /// Mean sampling interval of the record that is sampled fastest; infinite without samples.
  double shortest_interval_s() const;
  /// Number of weighted residuals, including priors.
  long residual_count() const;
  bool has_estimated_sd() const;
  /// Lower limit for the estimated standard deviation of a channel, SI.
  double least_sd(const ProblemChannel& channel) const;
  /// RMS of the weighted residuals below which simulation errors dominate: 1 if the noise of a
  /// channel is known, otherwise the limit given by least_sd().
  double least_noise() const;
  /// Values of all parameters in a condition at the point z in the unit box.
  model::ParameterValues values_at(std::size_t condition, std::span<const double> z) const;
  /// SI values of the unknowns.
  std::vector<double> to_physical(std::span<const double> z) const;
  /// Unit-box coordinates of the start values.
  std::vector<double> start() const;
  /// Row of the parameter table for an unknown.
  const model::ParameterSpec& spec(std::size_t unknown) const;
  /// Name of an unknown: "mass_kg", "leakage_coefficient (leak level 33 %)".
  std::string name(std::size_t unknown) const;
};

/// Returns the output channels of a record: those that are recorded, have the role output, and are
/// listed in [fit] outputs if that key is given.
std::vector<datasets::Channel> output_channels(const datasets::Campaign& campaign,
                                               const datasets::Record& record);

/// Returns the samples of a record that are inside the windows of the condition, or inside windows
/// detected in the record. Returns all samples if there are no windows.
std::vector<std::size_t> samples_that_count(const datasets::Condition& condition,
                                            const datasets::Record& record);

/// Returns the smallest tolerance that the noise of any channel requires, between 1e-8 and 1e-6.
///
/// @param estimated  whether to include channels whose noise is estimated
double tolerance_from_noise(const std::vector<ProblemCondition>& conditions, bool estimated);

/// Sets up the problem for the given conditions.
///
/// @param records        records, identified by their `condition`
/// @param nuisance_only  true: only nuisance parameters are unknown
/// @param fitted         values of an earlier fit that replace those of the rig; may be null
/// @throws InputError    if a record is missing or has no output channel, no sample counts, a
///                       channel with unknown noise is constant everywhere, or a fitted level is
///                       missing
Problem make_problem(const datasets::Campaign& campaign,
                     const std::vector<datasets::Record>& records,
                     const std::vector<const datasets::Condition*>& conditions, bool nuisance_only,
                     const std::vector<datasets::FittedValue>* fitted);

/// Returns the standard deviation of a channel's averaged samples, SI, by which residuals are
/// divided. It comes from the repeats, or otherwise from the campaign's `sd`; NaN if there is
/// neither.
double known_sd(const datasets::Campaign& campaign, datasets::Channel channel,
                const datasets::Series& series);

}  // namespace rigcal::calib
