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

/// Fidelity of one simulation: tolerance, horizon, and whether it computes sensitivities.
struct Fidelity {
  bool derivatives = true;
  bool exact =
      false;  ///< as exact as the noise requires; otherwise to within about a standard error
  /// Length of the part of each record that is used, counted from the first sample in a window. For
  /// a sine or square wave it is limited to the first period. Infinite: all samples.
  double horizon_s = std::numeric_limits<double>::infinity();

  static const Fidelity cost;  ///< for the cost of a start
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
  std::vector<double> measured;  ///< samples that count, SI
  double sd = 0.0;               ///< divisor of the residuals, SI
  bool sd_known = false;         ///< false: estimated from the residual of the fit
  double peak_to_peak = 0.0;     ///< peak-to-peak of `measured`
};

/// One condition with everything that its simulation needs. The campaign and the record are not
/// owned.
struct ProblemCondition {
  const datasets::Condition* condition = nullptr;
  const datasets::Record* record = nullptr;
  model::Rig rig;
  model::ParameterValues values;  ///< values of all parameters that are not unknowns
  model::SimulationInputs inputs;
  std::vector<ProblemChannel> channels;
  std::vector<model::Output> outputs;  ///< outputs of the channels
  std::vector<std::size_t> rows;       ///< samples that count (inside the windows)
  std::vector<int> free;               ///< table indices of the acting unknowns
  std::size_t first_period_rows = 0;   ///< number of `rows` within the first period
  long max_steps = 0;                  ///< step budget of one simulation
  /// Tolerance at which the errors of a recorded drive are harmless, as measured
  /// (measured_tolerance.hpp), whatever its derivatives ask for; 0: it was not measured.
  double measured_tolerance = 0.0;

  /// Number of `rows` within the horizon of a fidelity.
  std::size_t rows_at(const Fidelity& fidelity) const;
  /// Sample times up to the last sample that counts.
  std::span<const double> fit_times(const Fidelity& fidelity = Fidelity::full) const {
    return std::span(record->time_s).first(rows[rows_at(fidelity) - 1] + 1);
  }
};

/// The problem to solve: conditions with records, inputs and weights, and the unknowns.
struct Problem {
  const datasets::Campaign* campaign = nullptr;
  ParameterMap map;
  std::vector<ProblemCondition> conditions;
  double tolerance = 0.0;        ///< simulation tolerance: the smallest that any condition requires
  bool tolerance_fixed = false;  ///< the campaign fixes it

  /// Simulation tolerance for a condition. the measured one, else If the relative noise of all
  /// conditions is known, the tolerance exceeds the smallest one in proportion to the relative
  /// noise of the condition.
  double tolerance_of(std::size_t condition, const Fidelity& fidelity = Fidelity::full) const;
  /// Tolerance far from an optimum.
  double coarse_tolerance() const;
  /// Simulation options with the smallest tolerance and the campaign's method and time limit.
  model::SimulationOptions simulation_options(const std::atomic<bool>* cancel = nullptr) const;
  /// Simulation options for derivatives that only serve to compute an uncertainty, for which errors
  /// of a thousandth do not matter.
  model::SimulationOptions derivative_options(std::size_t condition) const;
  /// Fraction of all residuals within the horizon of a fidelity.
  double share_at(const Fidelity& fidelity) const;
  /// Whether some record is longer than one period of its drive.
  bool repeats_itself() const;
  /// Fidelity at which start values are evaluated. Derivatives are useful only if the optimiser
  /// begins with whole records.
  Fidelity of_starts() const { return repeats_itself() ? Fidelity::cost : Fidelity::coarse; }
  /// Number of weighted residuals, including priors.
  long residual_count() const;
  bool has_estimated_sd() const;
  /// Lower limit for the estimated standard deviation of a channel, SI.
  double least_sd(const ProblemChannel& channel) const;
  /// RMS of the weighted residuals below which simulation errors dominate: 1 if the noise of a
  /// channel is known, else the limit from least_sd().
  double least_noise() const;
  /// Values of all parameters in a condition at unit-box coordinates z.
  model::ParameterValues values_at(std::size_t condition, std::span<const double> z) const;
  /// SI values of the unknowns.
  std::vector<double> to_physical(std::span<const double> z) const;
  /// Unit-box coordinates of the start values.
  std::vector<double> start() const;
  /// Row of the parameter table of an unknown.
  const model::ParameterSpec& spec(std::size_t unknown) const;
  /// Name of an unknown: "mass_kg", "leakage_coefficient (leak level 33 %)".
  std::string name(std::size_t unknown) const;
};

/// Output channels of a record: recorded, with the role output, and listed in [fit] outputs if that
/// is given.
std::vector<datasets::Channel> output_channels(const datasets::Campaign& campaign,
                                               const datasets::Record& record);

/// Samples of a record that are inside the windows of the condition, or inside those detected in
/// the record; all samples if there are no windows.
std::vector<std::size_t> samples_that_count(const datasets::Condition& condition,
                                            const datasets::Record& record);

/// Smallest tolerance that the noise of the channels requires, between 1e-8 and 1e-6.
///
/// @param estimated  whether to include channels whose noise is estimated
double tolerance_from_noise(const std::vector<ProblemCondition>& conditions, bool estimated);

/// Sets up the problem of some conditions.
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

}  // namespace rigcal::calib
