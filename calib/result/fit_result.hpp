#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "calib/result/aspect.hpp"
#include "calib/result/condition_score.hpp"
#include "calib/result/considered.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/result/model_error.hpp"
#include "calib/result/posterior.hpp"
#include "calib/result/search_report.hpp"
#include "common/describe.hpp"

namespace rigcal::calib {

/// Correlations of the estimates; NaN if unknown.
struct Correlation {
  std::vector<std::string> names;  ///< names of rows and columns
  Eigen::MatrixXd matrix;          ///< shape (names)^2
  RIGCAL_DESCRIBE(names, matrix)
};

/// The replicates of a bootstrap. Their spread is in the parameters.
struct BootstrapRun {
  int replicates = 0;   ///< number of replicates that converged
  std::string message;  ///< how the replicates were drawn, and any problem
  RIGCAL_DESCRIBE(replicates, message)
};

/// The estimates of a fit, and how far they can be trusted.
struct Findings {
  std::vector<FittedParameter> parameters;  ///< fitted and known parameters
  Correlation correlation;  ///< correlation of the unknowns that have a standard error
  int rank = 0;             ///< rank of the scaled Jacobian at the optimum
  /// Singular values of the scaled Jacobian at the optimum, shape (unknowns).
  std::vector<double> singular_values;
  /// Twice the cost divided by the degrees of freedom (residuals - rank): about 1 if the residual
  /// is only noise; absent if the rank is zero.
  std::optional<double> reduced_chi_square;
  /// Effective number according to the noise model; null if unknown.
  Omittable<std::optional<double>> independent_residuals = std::optional<double>();
  Later<std::string> interval_advice;  ///< which interval to use, and why
  Later<std::vector<std::string>>
      combinations;  ///< that the records determine better than the parameters
  /// Tests of the model error against the noise; absent if the noise is unknown.
  Later<std::optional<LackOfFitTests>> lack_of_fit = std::optional(LackOfFitTests());
  Later<std::optional<BetweenRepeats>> between_repeats;  ///< absent if there are no single repeats
  /// Small effects that the model omits; absent if they were not examined.
  Omittable<Considered> considered;
  Omittable<std::vector<StabilityCheck>> stability;  ///< comparison with the validation records
  Later<std::vector<Basin>> basins;                  ///< end points of the starts, sorted by cost
  /// How well the starts agree, in words; empty for a single start.
  Later<std::string> agreement;
  Omittable<BootstrapRun> bootstrap;                 ///< absent if not requested
  Omittable<Posterior> posterior;                    ///< absent if not requested
  Omittable<std::vector<HeldOut>> cross_validation;  ///< absent if not requested
  /// From the independent residuals, for comparing models within a campaign; absent if the rank is
  /// zero.
  Later<std::optional<double>> aic, bic;
  RIGCAL_DESCRIBE(parameters, correlation, rank, singular_values, reduced_chi_square,
                  independent_residuals, interval_advice, combinations, lack_of_fit,
                  between_repeats, considered, stability, basins, agreement, bootstrap, posterior,
                  cross_validation, aic, bic)
};

/// The starts of a search, and the simulations that failed in it.
struct SearchOutcome {
  std::vector<StartReport> starts;          ///< one report per start
  int best_start = 0;                       ///< number of the start that gave the result
  long failure_count = 0;                   ///< number of simulations that failed
  std::vector<SimulationFailure> failures;  ///< the first few of each kind
  RIGCAL_DESCRIBE(starts, best_start, failure_count, failures)
};

/// Everything that a fit found.
struct Fit : Findings, SearchOutcome {
  FitStatus status = FitStatus::failed;
  std::optional<StoppedIn> stopped_in;
  std::string message;        ///< why the fit stopped, and what is unreliable, in words
  double cost = 0.0;          ///< half the sum of squared weighted residuals, priors included
  long residual_count = 0;    ///< number of residuals
  long evaluations = 0;       ///< number of evaluations of all residuals
  double wall_seconds = 0.0;  ///< duration of the fit [s]
  double tolerance = 0.0;     ///< tolerance of the simulations
  std::optional<FurtherStarts> further_starts;  ///< absent if no further starts were evaluated
  std::vector<std::string> warnings;            ///< in words
  std::vector<ConditionScore> conditions;  ///< `fit` and `validate` conditions in campaign order
  Assessment assessment;                   ///< the four aspects that determine the verdict
  /// "PASS", "WARN" or "FAIL", from the assessment; absent if nothing was judged.
  std::optional<Verdict> verdict;

  /// Returns true if the result may be used, that is, if the fit converged and every parameter is
  /// finite.
  bool usable() const;
  /// Returns true if the search converged, even if a later stage was stopped.
  bool has_converged() const;
};

}  // namespace rigcal::calib
