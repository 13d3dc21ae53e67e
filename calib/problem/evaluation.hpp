#pragma once

#include <Eigen/Core>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Contribution of one condition to the evaluation of a point in the unit box.
struct ConditionEvaluation {
  model::SimulationStatus status = model::SimulationStatus::ok;
  double failed_at_s = 0.0;
  std::string reason;  ///< explains a failure; empty otherwise
  /// R factor of [J r], with J in unit-box coordinates and weighted r. Shape (acting unknowns +
  /// 1)^2.
  Eigen::MatrixXd r_factor;
  std::vector<double> rms;  ///< root mean square of simulated minus measured for each channel, SI
  long steps = 0;

  bool ok() const { return status == model::SimulationStatus::ok; }
  /// Half the sum of squared weighted residuals.
  double cost() const { return 0.5 * r_factor.col(r_factor.cols() - 1).squaredNorm(); }
};

/// All rows of the weighted residuals of one condition and of their Jacobian.
struct ConditionRows {
  Eigen::MatrixXd jacobian;  ///< shape (channels * samples that count, acting unknowns)
  Eigen::VectorXd residual;
};

/// A range of the samples that count in a condition, [begin, end) in its `rows`.
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Returns [J r] for one channel over a range. J is the derivative with respect to the coordinates
/// of the unknowns; weights and loss have been applied.
///
/// @param slopes      shape (columns of the run's sensitivities): d value / d coordinate
/// @param square_sum  increased by the sum of squares of simulated minus measured, SI
Eigen::MatrixXd weighted_rows(const ProblemCondition& condition, std::size_t channel,
                              const RowRange& range, const model::Simulation& run,
                              const Eigen::VectorXd& slopes, const datasets::FitSettings& settings,
                              double& square_sum);

/// Returns d value / d z for each unknown that acts in a condition, in their order.
Eigen::VectorXd acting_slopes(const Problem& problem, std::size_t condition,
                              std::span<const double> z);

/// Returns the options for simulating a condition: the campaign's method and limits, with the given
/// tolerance.
model::SimulationOptions simulation_options(const Problem& problem, std::size_t condition,
                                            double tolerance, const std::atomic<bool>* cancel);

/// Simulates one condition. The residual is (simulated - measured) / sd, to which the loss is then
/// applied. Does not throw if the point cannot be simulated. Without derivatives, the R factor
/// contains only the column of residuals.
///
/// @param z     shape (unknowns), in the unit box
/// @param rows  if not null, receives all rows
ConditionEvaluation evaluate_condition(const Problem& problem, std::size_t condition,
                                       std::span<const double> z, const std::atomic<bool>* cancel,
                                       ConditionRows* rows = nullptr,
                                       const Fidelity& fidelity = Fidelity::full);

/// Runs the simulation for evaluate_condition(). The result depends on the measurements only if
/// they drive the model, so it can be reused for other measurements of the outputs.
model::Simulation simulate_condition(const Problem& problem, std::size_t condition,
                                     std::span<const double> z, const std::atomic<bool>* cancel,
                                     const Fidelity& fidelity = Fidelity::full);

/// Evaluates an existing simulation. The result is bit-identical to that of evaluate_condition().
/// @param run  simulation at `z` with this fidelity
ConditionEvaluation evaluate_run(const Problem& problem, std::size_t condition,
                                 std::span<const double> z, const model::Simulation& run,
                                 ConditionRows* rows = nullptr,
                                 const Fidelity& fidelity = Fidelity::full);

/// Evaluation of all conditions at one point.
struct Evaluation {
  std::vector<double> z;
  std::vector<ConditionEvaluation> conditions;
  double cost = 0.0;   ///< half the sum of squares, including the priors
  bool ok = false;     ///< true if every condition could be simulated
  double share = 1.0;  ///< fraction of the samples inside the windows that was evaluated
  std::shared_ptr<std::vector<ConditionRows>> rows;  ///< rows of each condition, if they were kept
};

/// Options for evaluating a point.
struct EvaluationOptions {
  Fidelity fidelity = Fidelity::full;
  const std::atomic<bool>* cancel = nullptr;
  bool rows = false;  ///< whether to keep the rows
  /// Existing simulations at the point, which are used instead of new ones; may be null.
  const std::vector<model::Simulation>* runs = nullptr;
};

/// Evaluates every condition at z, in parallel.
Evaluation evaluate_at(const Problem& problem, std::span<const double> z, int threads,
                       const EvaluationOptions& options = {});

/// Returns the linear system for all conditions and priors. Its shared component has one more row
/// than it has unknowns.
///
/// @param evaluation  a successful evaluation
Linearisation linearise(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
