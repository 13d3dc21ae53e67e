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
#include "calib/result/estimate_spread.hpp"
#include "calib/trust/prediction_band.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/prepare/single_repeats.hpp"
#include "diagnosis/leak/leak_curve.hpp"
#include "diagnosis/leak/leak_memo.hpp"
#include "diagnosis/leak/leak_scan.hpp"

namespace rigcal::diagnosis {

/// Rig parameters from an earlier fit.
struct RigFit {
  std::vector<datasets::FittedValue> values;  ///< fitted values, without nuisance parameters
  std::vector<int> indices;                   ///< table rows of rig values that have an error
  /// Covariance of the errors of these values and of the effects, SI, shape (indices + effects)^2.
  Eigen::MatrixXd covariance;
  /// Small effects that the fit considered, with their sizes according to priors and records. Their
  /// `moves` refer to the values above.
  calib::EffectSpread effects = {};

  /// Takes over the effects from a fit. An effect is correlated with the change of a value for
  /// which the fit has mistaken it.
  void consider(const calib::EstimateSpread& spread);
};

/// How the effects considered by a fit change a record of a condition and the share that leaks,
/// close to a given leak and per unit of size.
struct LeakEffects {
  calib::EffectChanges healthy;  ///< without a leak
  calib::EffectChanges by_leak;  ///< additional change per unit of the coefficient
  Eigen::VectorXd share;         ///< change of the share per unit of the coefficient
};

/// Returns the rig parameters from a fit in this process.
RigFit rig_fit_of(const calib::Fit& fit);

/// The campaign as seen by a diagnosis. The leakage coefficient is unknown in every condition, with
/// a lower bound of 0. Whatever the campaign or a fit states about it is ignored. Other nuisance
/// parameters (offsets) remain unknown.
struct LeakProblem {
  datasets::Campaign campaign;
  std::vector<datasets::FittedValue> values;  ///< values of the rig
  int leak = 0;                               ///< table row of the leakage coefficient
  const std::atomic<bool>* cancel = nullptr;  ///< ends the simulations when it becomes true
  /// Quantities that differ between days; empty if none do.
  std::vector<calib::DayQuantity> day_quantities;

  LeakProblem(const datasets::Campaign& original, const RigFit& rig);
  /// Returns this problem with another upper bound for the coefficient.
  LeakProblem up_to(double coefficient) const;
  /// Returns this problem for records that are each the mean of `repeats` and were corrected by the
  /// mean of `reference` healthy repeats. Differences between repeats
  /// (ParameterSetting::between_repeats) occur in both means.
  LeakProblem corrected_by(int reference, int repeats) const;
};

/// The leak that best explains one record.
struct LeakFit {
  std::string failure;  ///< why there is no estimate, in words; else empty
  /// Least-squares estimate. If a leak of 0 fits best, the estimate is continued linearly below
  /// zero, so that its distribution around 0 is not cut off.
  double coefficient = 0.0;
  /// Standard errors of the coefficient from the residuals, with their degrees of freedom (see
  /// fit_leak()): from clusters of samples, and for white noise.
  double cluster_se = 0.0;
  int cluster_freedom = 1;
  double white_se = 0.0;
  int white_freedom = 1;
  double noise_se = 0.0;  ///< part of white_se from the record itself, not its reference
  double rig_se = 0.0;    ///< from the uncertainty of the rig's parameters
  /// Change of the coefficient per unit of error in each of the rig's parameters, then in each
  /// effect, shape (RigFit::covariance).
  Eigen::VectorXd rig_moves;
  /// Change of the coefficient with each day quantity, per standard deviation between days; empty
  /// if there are none.
  Eigen::VectorXd day_effects;
  double day_rms_m = 0.0;     ///< rms change of position from all of these together [m]
  double effect_m = 0.0;      ///< rms change of position per unit of the coefficient [m]
  double parity_rms_m = 0.0;  ///< record (corrected, if it was) minus healthy model
  double misfit_rms_m = 0.0;  ///< record minus leaking model
  double noise_rms_m = 0.0;   ///< component of it that is independent in each sample
  bool ok() const { return failure.empty(); }
};

/// Simulations of a condition with sensitivities, with and without its leak. The simulation without
/// a leak is the same for all records with the same drive, initial state and other values.
struct LeakRuns {
  model::ParameterValues values;  ///< with the leak
  std::vector<int> free;          ///< table rows of the sensitivities
  model::Simulation leaking;
  model::Simulation healthy;  ///< without sensitivities to days, the last of `free`
  std::vector<double> time_s;
  /// Means of the channels that drive the model.
  std::map<datasets::Channel, std::vector<double>> driving;
  model::InitialState initial = model::InitialState::rest;
};

/// Fits the leak and the nuisance parameters to one record. Everything else is known.
///
/// Standard error: residuals are correlated in time, and model errors recur in every period, so
/// they do not average out over the periods. The samples are therefore divided into ten classes
/// according to their phase in the period, or into ten sections if a record has no period. The
/// scores in each class are summed over the whole record, and these sums are treated as
/// independent. The result is a sandwich estimate by clusters, which is correct for white noise and
/// allows for a recurring model error.
///
/// A second standard error treats the change of the residuals from sample to sample as white noise.
/// It is needed because ten sums give a poor estimate. If a square wave shows its leak in only one
/// or two of the classes, their sums are almost zero at the least-squares solution.
///
/// Rig parameters: C changes by -(J^T J)^-1 J^T J_rig per unit of each.
///
/// @param reference  number of healthy repeats whose residual was subtracted from the record; the
///                   rig's parameters then act only through the effect of the leak; 0: none
/// @param scan  scan of the same condition, which provides the start; may be null
/// @param covered  times of the record that count, within the condition's windows
/// @param effects  effects in the same condition; null: none
/// @param healthy  simulations for another record of the condition, whose run without a leak is
///                 reused if it is the same; if it is empty, the run made here is stored in it; may
///                 be null
LeakFit fit_leak(const LeakProblem& leak_problem, const RigFit& rig,
                 const datasets::Condition& condition, const datasets::Record& record,
                 const std::optional<datasets::TimeWindow>& covered, int reference,
                 const LeakScan* scan, const std::atomic<bool>* cancel,
                 const LeakEffects* effects = nullptr, std::optional<LeakRuns>* healthy = nullptr);

/// Simulates the effects in a condition, using its average with and without a leak.
///
/// @return  null if the fit considered no effects, or if the condition cannot be simulated
std::shared_ptr<const LeakEffects> leak_effects_of(const LeakProblem& leak_problem,
                                                   const RigFit& rig,
                                                   const datasets::Condition& condition,
                                                   const datasets::Record& average,
                                                   const LeakScan& scan);

/// For each record and channel: the record minus the healthy model.
using Residuals = std::vector<std::map<datasets::Channel, std::vector<double>>>;

/// Parity residuals (eq. 14) for records of one condition: each output channel minus that of the
/// healthy model under the same reference, with nuisance parameters at their start values.
///
/// @param records  on the time base of the average
/// @throws NoResultError  if the model cannot be simulated
Residuals healthy_residuals(const LeakProblem& leak_problem, const datasets::Condition& condition,
                            const datasets::Record& average,
                            const std::vector<const datasets::Record*>& records);

/// Change of the healthy model's position with each day quantity, per standard deviation, at the
/// times of the average, shape (samples, quantities).
///
/// @throws NoResultError  if the model cannot be simulated
Eigen::MatrixXd healthy_day_changes(const LeakProblem& leak_problem,
                                    const datasets::Condition& condition,
                                    const datasets::Record& average);

/// Scans a condition, using its average record.
LeakScan leak_scan_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                      const datasets::Record& average);

/// Share as a function of the coefficient in one condition of the rig, around an estimate.
///
/// @param coefficient  estimate for the record; may be negative
/// @param reach        half the width of the interval of interest, above 0
/// @param memo         cache of simulated leaks in the condition
/// @throws NoResultError  under the conditions of steady_leak()
LeakCurve leak_curve_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                        const datasets::Record& average, double coefficient, double reach,
                        LeakMemo& memo);

/// Standard error of the share from the rig's parameters, with the coefficient refitted. It
/// combines their direct effect on the share with their effect through the coefficient.
///
/// @param negligible  below this coefficient the leak is not simulated
/// @param effects     effects in the same condition; null: they act only through the coefficient
double share_rig_error(const LeakProblem& leak_problem, const RigFit& rig,
                       const datasets::Condition& condition, const datasets::Record& average,
                       const LeakFit& fit, double share_slope, double negligible = 0.0,
                       const LeakEffects* effects = nullptr);

/// Change of the share with each day quantity, per standard deviation between days: directly, and
/// through the coefficient, which changes by `day_effects`.
Eigen::VectorXd share_day_effects(const LeakProblem& leak_problem,
                                  const datasets::Condition& condition,
                                  const datasets::Record& average, const LeakFit& fit,
                                  double share_slope, double negligible = 0.0);

/// Share of the servo flow that leaks in a condition for given values, such as known true values.
double share_at(const datasets::Campaign& campaign, const datasets::Condition& condition,
                const datasets::Record& record, const std::vector<datasets::FittedValue>& values,
                const std::atomic<bool>* cancel = nullptr);

}  // namespace rigcal::diagnosis
