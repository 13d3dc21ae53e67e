#pragma once

#include <Eigen/Core>
#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/fit.hpp"
#include "calib/problem/day_effects.hpp"
#include "calib/result/estimate_covariance.hpp"
#include "calib/trust/prediction_band.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/record/healthy_effects.hpp"
#include "diagnosis/record/leak_curve.hpp"
#include "diagnosis/record/leak_memo.hpp"
#include "diagnosis/record/leak_scan.hpp"

namespace rigcal::diagnosis {

/// Rig parameters from an earlier fit.
struct RigFit {
  std::vector<datasets::FittedValue> values;  ///< fitted values, without nuisance parameters
  std::vector<int> indices;                   ///< table rows of the rig values that have an error
  /// Covariance of the errors of these values and of the effects, SI, shape (indices + effects)^2.
  Eigen::MatrixXd covariance;
  /// Small effects that the fit considered, with the sizes that follow from priors and records.
  /// Their `moves` refer to the values above.
  calib::EffectCovariance effects = {};

  /// Adds the effects from a fit. An effect is correlated with the change in a value for which the
  /// fit has mistaken it.
  ///
  /// @param law  law of the leak that is diagnosed. Its own parameter is not an effect
  void consider(const calib::EstimateCovariance& estimates,
                datasets::LeakLaw law = datasets::LeakLaw::orifice);
  /// Returns the standard error of a result that changes by `moves`, shape: rows of `covariance`.
  double error(const Eigen::VectorXd& moves) const;
  /// Returns the contributions to that error: one for all values of the rig together, and one for
  /// each effect, including its action through these values.
  std::vector<calib::BudgetLine> contributions(const Eigen::VectorXd& moves) const;
};

/// How the effects that a fit considered change a record of a condition and its leak share, close
/// to a given leak. All changes are per unit of the effect's size.
struct LeakEffects {
  calib::EffectChanges healthy;  ///< changes in a record without a leak
  calib::EffectChanges by_leak;  ///< additional changes per unit of the coefficient
  Eigen::VectorXd share;         ///< changes in the share per unit of the coefficient
};

/// The campaign in the form that a diagnosis needs. The leakage coefficient is unknown in every
/// condition, with a lower bound of 0, and anything that the campaign or a fit states about it is
/// ignored. Other nuisance parameters (offsets) remain unknown.
///
/// "Coefficient" here and below is the parameter of the campaign's leak law
/// (DiagnosisSettings::leak_law): of a laminar leak it is the conductance [m3/(s Pa)].
struct LeakProblem {
  datasets::Campaign campaign;
  std::vector<datasets::FittedValue> values;  ///< values of the rig
  int leak = 0;  ///< table row of the leakage coefficient, or of the conductance of a laminar leak
  const std::atomic<bool>* cancel = nullptr;  ///< becomes true to end the simulations
  /// Quantities that differ between days; may be empty.
  std::vector<calib::DayQuantity> day_quantities;

  LeakProblem(const datasets::Campaign& original, const RigFit& rig);
  /// Returns this problem with another upper bound for the coefficient.
  LeakProblem up_to(double coefficient) const;
  /// Returns this problem for records that are means of `repeats` repeats and were corrected by the
  /// mean of `reference` healthy repeats. Differences between repeats
  /// (ParameterSetting::between_repeats) occur in both means.
  LeakProblem corrected_by(int reference, int repeats) const;
};

/// The leak that best explains one record.
struct LeakFit {
  std::string failure;  ///< why there is no estimate, in words; empty if there is one
  /// Least-squares estimate. If no leak fits best, the estimate is continued linearly below zero,
  /// so that its distribution around 0 is not cut off.
  double coefficient = 0.0;
  /// Standard errors of the coefficient estimated from the residuals, with their degrees of freedom
  /// (see fit_leak()): one from clusters of samples, and one for white noise.
  double cluster_se = 0.0;
  int cluster_freedom = 1;
  double white_se = 0.0;
  int white_freedom = 1;
  double noise_se = 0.0;  ///< component of white_se from the record itself, without its reference
  double rig_se = 0.0;    ///< error due to the uncertainty of the rig's parameters
  /// Change in the coefficient per unit of error in each of the rig's parameters, then in each
  /// effect. Shape: rows of RigFit::covariance.
  Eigen::VectorXd rig_moves;
  /// Change in the coefficient with each day quantity, per standard deviation between days. Empty
  /// if there are no such quantities.
  Eigen::VectorXd day_effects;
  double day_rms_m = 0.0;     ///< RMS change in position due to all day quantities together [m]
  double effect_m = 0.0;      ///< RMS change in position per unit of the coefficient [m]
  double parity_rms_m = 0.0;  ///< RMS of the (possibly corrected) record minus the healthy model
  double misfit_rms_m = 0.0;  ///< RMS of the record minus the leaking model
  double noise_rms_m = 0.0;   ///< component of misfit_rms_m that is independent in each sample
  bool ok() const { return failure.empty(); }
};

/// Simulations of a condition with sensitivities, with and without its leak. The simulation without
/// a leak is the same for all records with the same drive, initial state and other values.
struct LeakRuns {
  model::ParameterValues values;  ///< values with the leak
  std::vector<int> free;          ///< table rows of the parameters that the sensitivities are for
  model::Simulation leaking;
  model::Simulation healthy;  ///< without sensitivities to day quantities, which are last in `free`
  std::vector<double> time_s;
  /// Means of the recorded channels that drive the model.
  std::map<datasets::Channel, std::vector<double>> driving;
  model::InitialState initial = model::InitialState::rest;
};

/// Fits the leak and the nuisance parameters to one record. All other values are known.
///
/// Standard error: residuals are correlated in time, and model errors recur in every period, so
/// that they do not average out over the periods. The samples are therefore divided into ten
/// clusters according to their phase in the period, or into ten sections if a record has no period.
/// The scores in each cluster are summed over the whole record, and these sums are treated as
/// independent. The result is a cluster-robust sandwich estimate, which is correct for white noise
/// and allows for a recurring model error.
///
/// A second standard error treats the change in the residuals from sample to sample as white noise.
/// It is needed because an estimate from ten sums may be poor: if a square wave shows its leak in
/// only one or two of the clusters, their sums are almost zero at the least-squares solution.
///
/// Rig parameters: the coefficient changes by -(J^T J)^-1 J^T J_rig per unit of each.
///
/// @param reference  number of healthy repeats whose residual was subtracted from the record, or 0.
///                   If it is not 0, the rig's parameters act only through the effect of the leak
/// @param scan  scan of the same condition, which provides the start value; may be null
/// @param covered  times of the record that count, within the condition's windows
/// @param effects  effects in the same condition; null if there are none
/// @param healthy  simulations for another record of the condition, whose run without a leak is
///                 reused if possible. If it is empty, it receives the runs made here. May be null
LeakFit fit_leak(const LeakProblem& leak_problem, const RigFit& rig,
                 const datasets::Condition& condition, const datasets::Record& record,
                 const std::optional<datasets::TimeWindow>& covered, int reference,
                 const LeakScan* scan, const std::atomic<bool>* cancel,
                 const LeakEffects* effects = nullptr, std::optional<LeakRuns>* healthy = nullptr);

/// Simulates the effects in a condition, based on its average record, with and without a leak.
///
/// @param healthy  simulations without a leak that other conditions may have made
/// @return  null if the fit considered no effects, or if the condition cannot be simulated
std::shared_ptr<const LeakEffects> leak_effects_of(const LeakProblem& leak_problem,
                                                   const RigFit& rig,
                                                   const datasets::Condition& condition,
                                                   const datasets::Record& average,
                                                   const LeakScan& scan, HealthyEffects& healthy);

/// The record minus the healthy model, for each record and channel.
using Residuals = std::vector<std::map<datasets::Channel, std::vector<double>>>;

/// Returns the parity residuals (eq. 14) for records of one condition: each output channel minus
/// that of the healthy model under the same reference, with nuisance parameters at their start
/// values.
///
/// @param records  records on the time base of the average
/// @throws NoResultError  if the model cannot be simulated
Residuals healthy_residuals(const LeakProblem& leak_problem, const datasets::Condition& condition,
                            const datasets::Record& average,
                            const std::vector<const datasets::Record*>& records);

/// Returns the change in the healthy model's position with each day quantity, per standard
/// deviation, at the times of the average. Shape (samples, quantities).
///
/// @throws NoResultError  if the model cannot be simulated
Eigen::MatrixXd healthy_day_changes(const LeakProblem& leak_problem,
                                    const datasets::Condition& condition,
                                    const datasets::Record& average);

/// Scans a condition (scan_leaks()), using its average record.
LeakScan leak_scan_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                      const datasets::Record& average);

/// Returns the share as a function of the coefficient in one condition of the rig, around an
/// estimate.
///
/// @param coefficient  estimate for the record; may be negative
/// @param reach        half-width of the interval of interest, above 0
/// @param memo         cache of simulated leaks in the condition
/// @throws NoResultError  under the conditions of steady_leak()
LeakCurve leak_curve_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                        const datasets::Record& average, double coefficient, double reach,
                        LeakMemo& memo);

/// Returns one point of this curve, for a coefficient above 0. It costs a single leak of the memo.
LeakPoint leak_point_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                        const datasets::Record& average, double coefficient, double reach,
                        LeakMemo& memo);

/// Returns the change in the share per unit of error in each of the rig's parameters, then in each
/// effect, if the coefficient is refitted. It combines their direct action on the share with that
/// through the coefficient. Shape: rows of RigFit::covariance.
///
/// @param memo        leaks of the condition, with slopes by RigFit::indices
/// @param negligible  below this coefficient the leak is not simulated
/// @param effects     effects in the same condition; if null, effects act only through the
///                    coefficient
Eigen::VectorXd share_rig_moves(const LeakProblem& leak_problem, const RigFit& rig,
                                const datasets::Condition& condition,
                                const datasets::Record& average, const LeakFit& fit,
                                double share_slope, LeakMemo& memo, double negligible = 0.0,
                                const LeakEffects* effects = nullptr);

/// Returns the change in the share with each day quantity, per standard deviation between days,
/// both directly and through the coefficient, which changes by `day_effects`.
///
/// @param memo  leaks of the condition, with slopes by the rows of the day quantities
Eigen::VectorXd share_day_effects(const LeakProblem& leak_problem,
                                  const datasets::Condition& condition,
                                  const datasets::Record& average, const LeakFit& fit,
                                  double share_slope, LeakMemo& memo, double negligible = 0.0);

/// Returns the share of the servo flow that leaks in a condition for given values, such as known
/// true values.
double share_at(const datasets::Campaign& campaign, const datasets::Condition& condition,
                const datasets::Record& record, const std::vector<datasets::FittedValue>& values,
                const std::atomic<bool>* cancel = nullptr);

}  // namespace rigcal::diagnosis
