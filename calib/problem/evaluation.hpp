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

/// Contribution of one condition at a point of the unit box.
struct ConditionEvaluation {
  model::SimulationStatus status = model::SimulationStatus::ok;
  double failed_at_s = 0.0;
  std::string reason;  ///< explains a failure; empty otherwise
  /// R factor of [J r], shape (acting unknowns + 1)^2: J in unit-box coordinates, r weighted.
  Eigen::MatrixXd r_factor;
  std::vector<double> rms;  ///< root mean square of simulated minus measured per channel, SI
  long steps = 0;

  bool ok() const { return status == model::SimulationStatus::ok; }
  /// Half the sum of squares.
  double cost() const { return 0.5 * r_factor.col(r_factor.cols() - 1).squaredNorm(); }
};

/// Weighted residuals of one condition and their Jacobian, with all rows.
struct ConditionRows {
  Eigen::MatrixXd jacobian;  ///< shape (channels * samples that count, acting unknowns)
  Eigen::VectorXd residual;
};

/// Samples of a condition that count, [begin, end) of its `rows`, and the index in the record of
/// the first simulated time.
struct RowRange {
  std::size_t begin = 0;
  std::size_t end = 0;
  std::size_t first_sample = 0;
};

/// [J r] of one channel over a range, after the chain rule to the coordinates of the unknowns,
/// weights and loss.
///
/// @param slopes      shape (columns of the run's sensitivities): d value / d coordinate
/// @param square_sum  increased by the sum of squares of simulated minus measured, SI
Eigen::MatrixXd weighted_rows(const ProblemCondition& condition, std::size_t channel,
                              const RowRange& range, const model::Simulation& run,
                              const Eigen::VectorXd& slopes, const datasets::FitSettings& settings,
                              double& square_sum);

/// d value / d z for the unknowns that act in a condition, in their order.
Eigen::VectorXd acting_slopes(const Problem& problem, std::size_t condition,
                              std::span<const double> z);

/// Options for simulating a condition: the campaign's method and limits, with the given tolerance.
model::SimulationOptions simulation_options(const Problem& problem, std::size_t condition,
                                            double tolerance, const std::atomic<bool>* cancel);

/// Simulates one condition. The residual is (simulated - measured) / sd, followed by the loss.
/// Never throws for a point that cannot be simulated. Without derivatives, the R factor has only
/// the column of residuals.
///
/// @param z     shape (unknowns), in the unit box
/// @param rows  if not null, receives all rows
ConditionEvaluation evaluate_condition(const Problem& problem, std::size_t condition,
                                       std::span<const double> z, const std::atomic<bool>* cancel,
                                       ConditionRows* rows = nullptr,
                                       const Fidelity& fidelity = Fidelity::full);

/// The simulation for evaluate_condition(). It depends on the measurements only if they drive the
/// model, so it can be reused for other measurements of the outputs.
model::Simulation simulate_condition(const Problem& problem, std::size_t condition,
                                     std::span<const double> z, const std::atomic<bool>* cancel,
                                     const Fidelity& fidelity = Fidelity::full);

/// Evaluates a simulation, with results bit-identical to evaluate_condition().
/// @param run  simulation at `z` with this fidelity
ConditionEvaluation evaluate_run(const Problem& problem, std::size_t condition,
                                 std::span<const double> z, const model::Simulation& run,
                                 ConditionRows* rows = nullptr,
                                 const Fidelity& fidelity = Fidelity::full);

/// All conditions at one point.
struct Evaluation {
  std::vector<double> z;
  std::vector<ConditionEvaluation> conditions;
  double cost = 0.0;   ///< half the sum of squares, including the priors
  bool ok = false;     ///< every condition could be simulated
  double share = 1.0;  ///< fraction of the samples in windows that were evaluated
  std::shared_ptr<std::vector<ConditionRows>> rows;  ///< rows of each condition, if they were kept
};

/// Options for evaluating a point.
struct EvaluationOptions {
  Fidelity fidelity = Fidelity::full;
  const std::atomic<bool>* cancel = nullptr;
  bool rows = false;  ///< whether to keep the rows
  /// If not null, the simulations at that point, which are used instead of new ones.
  const std::vector<model::Simulation>* runs = nullptr;
};

/// Evaluates every condition at z, in parallel.
Evaluation evaluate_at(const Problem& problem, std::span<const double> z, int threads,
                       const EvaluationOptions& options = {});

/// The linear system of all conditions and priors. Its shared component has one row more than
/// unknowns.
///
/// @param evaluation  a successful evaluation
Linearisation linearise(const Problem& problem, const Evaluation& evaluation);

}  // namespace rigcal::calib
