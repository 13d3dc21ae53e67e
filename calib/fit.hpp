#pragma once

#include <Eigen/Core>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calib/aspect.hpp"
#include "calib/parameter_map.hpp"
#include "datasets/campaign.hpp"
#include "datasets/record.hpp"
#include "metrics/agreement.hpp"
#include "metrics/noise_floor.hpp"
#include "metrics/residual_tests.hpp"

namespace rigcal::calib {

struct Checkpoint;  // checkpoint.hpp

/// What an earlier fit, whose values are validated, tells of itself.
struct Origin {
  std::set<std::string> estimated_from;  ///< conditions whose records it was fitted to
  Aspect parameters;                     ///< as it judged them
};

/// What a fit needs beside the campaign and its records.
struct FitOptions {
  int starts = 1;            ///< 1: the campaign's start values; more: latin hypercube around them
  int further_starts = 0;    ///< of the latin hypercube, where the only start finds no minimum
  std::uint64_t seed = 1;    ///< of the latin hypercube
  int threads = 1;           ///< results are the same bits for any number
  int max_iterations = 200;  ///< per start
  std::optional<long> max_evaluations;  ///< of all residuals, of the whole job; then: `stopped`
  std::optional<double> max_seconds;    ///< of the whole job; then: status `stopped`
  double function_tolerance = 1e-10;    ///< |d cost| / cost of Ceres
  double gradient_tolerance = 1e-10;
  double parameter_tolerance = 1e-9;
  int bootstrap = 0;                   ///< replicates, each fitted from the optimum; 0: none
  bool profiles = false;               ///< profile likelihood of every unknown that is no nuisance
  bool cross_validate = false;         ///< leave one condition out after the other
  const Checkpoint* resume = nullptr;  ///< goes on from there
  std::function<void(const Checkpoint&)> checkpoint;  ///< told after every start that is finished
  const std::atomic<bool>* cancel = nullptr;          ///< ends the fit with the best so far
  /// Told of every iteration: start (from 1), iteration, cost, relative change of cost, seconds.
  std::function<void(int, int, double, double, double)> progress;
  /// Told of what is made beside the fit: "replicates of the bootstrap", how many are done, of how
  /// many. From any thread.
  std::function<void(const char*, int, int)> beside;

  void validate() const;
};

enum class FitStatus {
  converged,
  stopped,  ///< a limit of iterations or time, or a signal: the best so far
  failed,   ///< no start gave a usable result
};
std::string_view to_string(FitStatus status);

enum class Identifiability {
  identified,
  weak,              ///< half width of the 95 % interval above 20 % of the value
  bounded,           ///< cannot be told from zero: the interval is all that is known
  not_identifiable,  ///< half width above 100 %, no interval, or an open profile
};
std::string_view to_string(Identifiability identifiability);

/// What an interval rests on.
enum class IntervalSource { none, standard_error, robust_standard_error };
std::string_view to_string(IntervalSource source);

/// One end of a profile: where the cost has risen by what a 95 % interval allows.
struct ProfileEnd {
  std::optional<double> value;  ///< absent: the cost stays below up to `reached`
  double reached = 0.0;         ///< value up to which the profile was followed
  bool lost = false;  ///< followed no further: no fit there, or the job was stopped; else open
};

/// Profile likelihood of one unknown: least cost of all others at fixed values of this one.
struct Profile {
  ProfileEnd low, high;
  std::vector<double> values;     ///< SI, ascending
  std::vector<double> rises;      ///< of 2 cost, in units of the threshold: 1 ends the interval
  bool lower_cost_found = false;  ///< the fit was not at the minimum
};

/// One parameter over bootstrap replicates.
struct BootstrapSpread {
  double standard_error = 0.0;
  double bias = 0.0;                 ///< mean of the replicates minus the estimate
  double freedom = 0.0;              ///< with which the spread is known
  std::pair<double, double> ci95{};  ///< percentiles, widened for the freedom
};

/// One parameter in the result: fitted or known.
struct FittedParameter {
  int index = 0;
  datasets::Scope scope = datasets::Scope::rig;
  std::string level;  ///< leak level or condition; empty for the rig
  double value = 0.0;
  double start = 0.0;
  double lower = 0.0;
  double upper = 0.0;
  bool fitted = false;
  bool nuisance = false;
  std::optional<double> standard_error;  ///< absent where the Jacobian does not determine it
  /// From the scatter of the residuals themselves: larger where they are correlated in time.
  std::optional<double> robust_standard_error;
  std::optional<std::pair<double, double>> ci95;
  IntervalSource interval = IntervalSource::none;  ///< of ci95
  std::optional<BootstrapSpread> bootstrap;
  std::optional<Profile> profile;
  bool at_bound = false;
  Identifiability identifiability = Identifiability::identified;
  std::string reason;  ///< in words: why no error, why weak, at which bound
};

/// Model error of one channel of one condition against its pure error (lack_of_fit.hpp).
struct LackOfFit : metrics::Judged {
  std::string condition;
  datasets::Channel channel = datasets::Channel::position;
  double ratio = 0.0;         ///< variance of the residual over that of the pure error
  double freedom = 0.0;       ///< effective degrees of freedom of the residual
  double pure_freedom = 0.0;  ///< and of the pure error; infinite where `sd` states it
  bool by_repeats = false;    ///< pure error from repeats; else from `sd`
  /// Probability of such a ratio, or a larger one, of noise alone. The outcome is that of all tests
  /// together.
  double p = 1.0;
};

/// How the repeats of the fitted conditions differ from one another (between_repeats.hpp).
struct BetweenRepeats {
  bool differ = false;  ///< by more than the residuals of their mean tell, at 5 %
  double p = 1.0;       ///< of the parameter that shows it most, times the number of parameters
  double ratio = 0.0;   ///< largest of error by the repeats over error by the residuals
  std::vector<std::string> parameters;  ///< whose interval rests on the repeats
  std::string cause;      ///< that would explain it: key of a parameter, or "start"; empty: none
  double cause_sd = 0.0;  ///< of the cause between repeats: relative, of the start in s
  double cause_explains = 0.0;  ///< share of how the repeats differ, 0 to 1
};

/// One start of a multi-start fit.
struct StartReport {
  int number = 1;
  std::vector<double> start_values;  ///< SI, order of the unknowns
  std::vector<double> end_values;
  double initial_cost = 0.0;
  double final_cost = 0.0;  ///< its last step may be predicted, not simulated
  int iterations = 0;
  FitStatus status = FitStatus::failed;
  std::string message;
};

/// Converged starts that ended at one point.
struct Basin {
  double cost = 0.0;           ///< least of its starts
  std::vector<int> starts;     ///< numbers, by cost
  std::vector<double> values;  ///< SI, of its best start
};

/// A condition that was left out of the fit and predicted by it.
struct HeldOut {
  std::string condition;
  std::string problem;  ///< why there is no prediction, in words; empty if there is one
  std::vector<std::pair<datasets::Channel, double>> rms;         ///< of the prediction, SI
  std::vector<std::pair<datasets::Channel, double>> fitted_rms;  ///< where it took part, SI
  double largest_shift = 0.0;  ///< of a parameter, in its error; 0 if none has one
  std::string shifted;         ///< that parameter
};

/// A simulation that failed during the fit (first few of each kind are kept, all are counted).
struct SimulationFailure {
  std::string condition;
  std::vector<std::pair<std::string, double>> parameters;  ///< names and SI values of the unknowns
  double time_s = 0.0;
  std::string reason;
  int start = 1;
};

/// Agreement of one channel in one condition.
struct ChannelScore {
  datasets::Channel channel = datasets::Channel::position;
  std::optional<metrics::Agreement> agreement;           ///< absent: see `problem`
  std::optional<metrics::NoiseFloor> noise_floor;        ///< absent where the noise is unknown
  std::optional<double> gain_ratio, phase_deg, delay_s;  ///< at the fundamental (sine, square)
  std::string problem;                                   ///< why a metric does not exist, in words
  /// Of measured minus simulated, over the longest stretch that counts; absent where it is too
  /// short, or constant.
  std::optional<metrics::ResidualTests> residual_tests;
  std::optional<LackOfFit> lack_of_fit;  ///< of a prediction; absent where the noise is unknown
};

enum class Verdict { pass, warn, fail };
std::string_view to_string(Verdict verdict);

/// One metric of one channel of a condition against its limit.
struct LimitCheck {
  datasets::Channel channel = datasets::Channel::position;
  std::string metric;
  std::optional<double> value;  ///< absent: it does not exist, see `words`
  std::optional<double> limit, warn;
  Verdict verdict = Verdict::pass;
  double used = 0.0;  ///< distance of the value from the ideal over that of the limit
  std::string words;  ///< why WARN or FAIL; empty for PASS
};

/// Score of one condition, and the series it was computed from.
struct ConditionScore {
  std::string id;
  datasets::Use use = datasets::Use::fit;
  std::vector<ChannelScore> channels;
  std::vector<LimitCheck> checks;          ///< of every limit that holds for a channel of it
  std::optional<Verdict> verdict;          ///< worst of the checks; absent without limits
  std::vector<std::string> reasons;        ///< of WARN and FAIL, in words
  std::vector<std::string> data_warnings;  ///< what is doubtful about the recording, in words
  std::string failure;                     ///< why it could not be simulated; empty if it could
  std::string not_scored;  ///< why it was not scored although it might be; empty if it was
  long samples = 0;        ///< that count (inside the windows)
  std::vector<double> time_s;
  /// measured mean and simulated value per output channel, whole record
  std::map<datasets::Channel, std::pair<std::vector<double>, std::vector<double>>> series;
  std::vector<double> drive;  ///< reference [m] or command [V] at time_s
  /// Simulated flows at time_s [m3/s]; empty if it could not be simulated.
  std::vector<double> servo_flow_m3_per_s, leakage_flow_m3_per_s;
  std::vector<bool> in_window;  ///< empty: all
};

/// What a job was at when it was stopped.
enum class StoppedIn { nothing, starts, validation, bootstrap, profiles, cross_validation };
std::string_view to_string(StoppedIn stage);

/// Everything that a fit found.
struct Fit {
  FitStatus status = FitStatus::failed;
  StoppedIn stopped_in = StoppedIn::nothing;
  std::string message;  ///< in words: why it stopped, what is not to be trusted
  double cost = 0.0;    ///< half the sum of squared weighted residuals, priors included
  long residual_count = 0;
  double reduced_chi_square = 0.0;  ///< 2 cost / (residuals - rank); about 1 if the noise is all
  long evaluations = 0;             ///< of all residuals
  double wall_seconds = 0.0;
  double tolerance = 0.0;              ///< of the simulations
  double independent_residuals = 0.0;  ///< what they are worth in the noise model; 0: not known
  double aic = 0.0,
         bic = 0.0;  ///< with the independent residuals; to compare models of one campaign
  std::vector<FittedParameter> parameters;
  std::vector<LackOfFit> lack_of_fit;  ///< channels of known noise
  std::optional<bool> misfit;          ///< significant lack of fit; absent: cannot be judged
  std::optional<BetweenRepeats> between_repeats;  ///< absent: no single repeats
  std::string interval_advice;                    ///< which interval to believe, and why
  std::vector<std::string> correlation_names;
  std::vector<std::string> combinations;  ///< what is fixed where single parameters are not
  Eigen::MatrixXd correlation;            ///< shape (unknowns that have a standard error)^2
  int rank = 0;                           ///< of the scaled Jacobian at the optimum
  std::vector<double> singular_values;
  std::vector<StartReport> starts;
  int best_start = 0;
  std::vector<Basin> basins;      ///< by cost
  int bootstrap_replicates = 0;   ///< that converged
  std::string bootstrap_message;  ///< how they were drawn, what went wrong
  std::vector<HeldOut> cross_validation;
  std::string agreement;  ///< of the starts, in words; empty for a single one
  std::vector<SimulationFailure> failures;
  long failure_count = 0;
  std::vector<std::string> warnings;
  std::vector<ConditionScore> conditions;  ///< fit and validate conditions, campaign order
  Assessment assessment;
  std::optional<Verdict> verdict;  ///< follows from the assessment

  /// A result that may be used: converged, every parameter finite.
  bool usable() const;
  /// The search converged, whatever was stopped after it.
  bool has_converged() const;
};

/// Calibrates the free parameters on the `fit` conditions by Ceres (analytic Jacobian, unit box)
/// and scores `fit` and `validate` conditions. Never throws for a fit that fails: see status.
///
/// @param records  of the fit and validate conditions, found by their `condition`
/// @throws InputError  nothing is free, no `fit` condition, a channel without any weight...
Fit fit(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
        const FitOptions& options);

/// Scores `fit` and `validate` conditions with given values; estimates nothing but nuisance
/// parameters (by the same machinery as fit()).
///
/// @param values  of an earlier fit, or empty: the campaign's own values
/// @param origin  of `values`; null: the campaign's `fit` conditions are taken for those that its
///                values were estimated from
/// @throws InputError  a leak level (or condition) that needs a value which `values` does not have
Fit validate(const datasets::Campaign& campaign, const std::vector<datasets::Record>& records,
             const std::vector<datasets::FittedValue>* values, const FitOptions& options,
             const Origin* origin = nullptr);

}  // namespace rigcal::calib
