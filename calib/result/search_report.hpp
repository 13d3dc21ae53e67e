#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "common/describe.hpp"
#include "model/simulate.hpp"

// Report on the search: its starts, their end points, and simulations that failed.

namespace rigcal::calib {

enum class FitStatus {
  converged,
  stopped,  ///< a limit on iterations or time, or a signal, ended the fit; the result is the best
            ///< so far
  failed,   ///< no start gave a usable result
};
RIGCAL_NAMES(FitStatus, converged, stopped, failed)

/// Stage at which a job was stopped.
enum class StoppedIn { starts, validation, bootstrap, profiles, posterior, cross_validation };
RIGCAL_NAMES(StoppedIn, starts, validation, bootstrap, profiles, posterior, cross_validation)

/// One start of a multi-start fit.
struct StartReport {
  int number = 1;                        ///< counted from 1
  std::vector<double> start_values;      ///< in the order of the unknowns, SI
  std::vector<double> end_values;        ///< same order; empty if the end point cannot be simulated
  double initial_cost = kNone;           ///< NaN if the start cannot be simulated
  double final_cost = kNone;             ///< NaN if the end point cannot be simulated
  int iterations = 0;                    ///< sum over all stages
  FitStatus status = FitStatus::failed;  ///< how the search ended
  std::string message;                   ///< how the search ended, in words
  RIGCAL_DESCRIBE(number, status, message, start_values, end_values, initial_cost, final_cost,
                  iterations)

  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
};

/// Further starts that a fit with a single start evaluated with coarse simulations.
struct FurtherStarts {
  int looked_at = 0;
  /// Starts that led to a lower cost than the campaign's start, and were then searched fully.
  int followed = 0;
  /// Starts that led to the same cost as the result, to within the error of coarse simulations.
  int as_low = 0;
};

/// Converged starts that ended at the same point.
struct Basin {
  double cost = 0.0;           ///< lowest cost of its starts
  std::vector<int> starts;     ///< start numbers, sorted by cost
  std::vector<double> values;  ///< end point of the best start, SI
  RIGCAL_DESCRIBE(cost, starts, values)
};

/// A simulation that failed during the fit. All failures are counted, but only the first few of
/// each kind are kept.
struct SimulationFailure {
  std::string condition;     ///< id of the condition
  Keyed<double> parameters;  ///< names and SI values of the unknowns
  double time_s = 0.0;       ///< time of the failure in the record
  std::string reason;        ///< why it failed, in words
  model::SimulationStatus status = model::SimulationStatus::ok;
  int start = 1;  ///< number of the start
  RIGCAL_DESCRIBE(condition, start, time_s, reason, parameters)
};

}  // namespace rigcal::calib
