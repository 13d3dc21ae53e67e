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
  std::vector<std::string> names;
  Eigen::MatrixXd matrix;  ///< shape (names)^2
  RIGCAL_DESCRIBE(names, matrix)
};

/// The replicates of a bootstrap. Their spread is in the parameters.
struct BootstrapRun {
  int replicates = 0;   ///< number of replicates that converged
  std::string message;  ///< how the replicates were drawn, and any problem
  RIGCAL_DESCRIBE(replicates, message)
};

/// Everything that a fit found.
struct Fit {
  FitStatus status = FitStatus::failed;
  StoppedIn stopped_in = StoppedIn::nothing;
  std::string message;  ///< why the fit stopped, and what is unreliable, in words
  double cost = 0.0;    ///< half the sum of squared weighted residuals, priors included
  long residual_count = 0;
  double reduced_chi_square = 0.0;  ///< 2 cost / (residuals - rank); about 1 if there is only noise
  long evaluations = 0;             ///< number of evaluations of all residuals
  double wall_seconds = 0.0;
  double tolerance = 0.0;  ///< tolerance of the simulations
  /// Effective number according to the noise model; 0 if unknown.
  double independent_residuals = 0.0;
  double aic = 0.0,
         bic = 0.0;  ///< from the independent residuals, for comparing models within a campaign
  std::vector<FittedParameter> parameters;
  LackOfFitTests lack_of_fit;
  std::optional<BetweenRepeats> between_repeats;  ///< absent if there are no single repeats
  /// Small effects that the model omits; absent if they were not examined.
  std::optional<Considered> considered;
  std::vector<StabilityCheck> stability;  ///< comparison with the validation records
  std::string interval_advice;            ///< which interval to believe, and why
  std::vector<std::string> combinations;  ///< parameter combinations that the records determine
  Correlation correlation;  ///< correlation of the unknowns that have a standard error
  int rank = 0;             ///< rank of the scaled Jacobian at the optimum
  std::vector<double> singular_values;
  std::vector<StartReport> starts;
  int best_start = 0;
  std::optional<FurtherStarts> further_starts;  ///< absent if no further starts were evaluated
  std::vector<Basin> basins;                    ///< sorted by cost
  std::optional<BootstrapRun> bootstrap;        ///< absent if not requested
  std::optional<Posterior> posterior;           ///< absent if not requested
  std::vector<HeldOut> cross_validation;
  std::string agreement;  ///< how well the starts agree, in words; empty for a single start
  std::vector<SimulationFailure> failures;
  long failure_count = 0;
  std::vector<std::string> warnings;
  std::vector<ConditionScore> conditions;  ///< `fit` and `validate` conditions in campaign order
  Assessment assessment;
  std::optional<Verdict> verdict;  ///< follows from the assessment

  /// Returns true if the result may be used, that is, if the fit converged and every parameter is
  /// finite.
  bool usable() const;
  /// Returns true if the search converged, even if a later stage was stopped.
  bool has_converged() const;
};

}  // namespace rigcal::calib
