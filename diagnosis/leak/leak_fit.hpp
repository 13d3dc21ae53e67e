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

/// Rig parameters of an earlier fit.
struct RigFit {
  std::vector<datasets::FittedValue> values;  ///< fitted ones, without nuisance
  std::vector<int> indices;  ///< table rows of fitted values of scope rig that have an error
  /// Covariance of the errors of these values and of the effects, SI, shape (indices + effects)^2.
  Eigen::MatrixXd covariance;
  /// Small effects that the fit considered, with the size by prior and records; moves: of the
  /// values above.
  calib::EffectSpread effects = {};

  /// Takes over the effects of a fit: what the fit has mistaken for a change of a value, and the
  /// effect itself, go together.
  void consider(const calib::EstimateSpread& spread);
};

/// What the effects that a fit considered do to a record of a condition and to the share that
/// leaks, about a leak, per unit of size.
struct LeakEffects {
  calib::EffectChanges healthy;  ///< without a leak
  calib::EffectChanges by_leak;  ///< more of them per unit of the coefficient
  Eigen::VectorXd share;         ///< change of the share per unit of the coefficient
};

/// The same from a fit in this process.
RigFit rig_fit_of(const calib::Fit& fit);

/// The campaign as a diagnosis sees it: the leakage coefficient is unknown in every condition, with
/// 0 as its lower bound, and whatever the campaign or a fit knows of it is left out. Other nuisance
/// parameters (offsets) stay unknown.
struct LeakProblem {
  datasets::Campaign campaign;
  std::vector<datasets::FittedValue> values;  ///< values of the rig
  int leak = 0;                               ///< table row of the leakage coefficient
  const std::atomic<bool>* cancel = nullptr;  ///< ends the simulations when it becomes true
  /// What differs between days; empty: nothing.
  std::vector<calib::DayQuantity> day_quantities;

  LeakProblem(const datasets::Campaign& original, const RigFit& rig);
  /// The same with another upper bound of the coefficient.
  LeakProblem up_to(double coefficient) const;
  /// The same for records that are each the mean of `repeats` and were corrected by the mean of
  /// `reference` healthy repeats: differences between repeats (ParameterSetting::between_repeats)
  /// occur in both.
  LeakProblem corrected_by(int reference, int repeats) const;
};

/// The leak that explains one record best.
struct LeakFit {
  std::string failure;  ///< why there is none, in words; empty if there is one
  /// Least-squares estimate. If a leak of 0 fits best, it is the linear continuation below zero, so
  /// that the distribution about 0 is not cut off.
  double coefficient = 0.0;
  /// Its standard errors from the residuals, with their degrees of freedom (see fit_leak()): by
  /// clusters of samples, and as white noise.
  double cluster_se = 0.0;
  int cluster_freedom = 1;
  double white_se = 0.0;
  int white_freedom = 1;
  double noise_se = 0.0;  ///< the part of white_se that is the record's own, not its reference's
  double rig_se = 0.0;    ///< from the uncertainty of the rig's parameters
  /// Change of the coefficient per unit of error of each of the rig's parameters, then of each
  /// effect, shape (RigFit::covariance).
  Eigen::VectorXd rig_moves;
  /// Change of the coefficient by each day quantity, per standard deviation between days; empty
  /// where there are none.
  Eigen::VectorXd day_effects;
  double day_rms_m = 0.0;     ///< rms change of position by all of them together [m]
  double effect_m = 0.0;      ///< rms change of position per unit of the coefficient [m]
  double parity_rms_m = 0.0;  ///< record (corrected, if it was) minus healthy model
  double misfit_rms_m = 0.0;  ///< record minus leaking model
  double noise_rms_m = 0.0;   ///< part of it that is new in each sample
  bool ok() const { return failure.empty(); }
};

/// Simulations of a condition with sensitivities, with its leak and without. The one without is the
/// same for all records whose drive, state and other values are the same.
struct LeakRuns {
  model::ParameterValues values;  ///< with the leak
  std::vector<int> free;          ///< table rows of the sensitivities
  model::Simulation leaking;
  model::Simulation healthy;  ///< without the sensitivities by days, which are the last of `free`
  std::vector<double> time_s;
  /// Means of the channels that drive the model.
  std::map<datasets::Channel, std::vector<double>> driving;
  model::InitialState initial = model::InitialState::rest;
};

/// Fits leak and nuisance parameters to one record; everything else is known.
///
/// Standard error: residuals are correlated in time, and model errors return in every period, so
/// that they do not average out over the periods. The samples are put into ten classes by their
/// phase in the period (into ten sections of a record without a period). The scores of each class
/// are summed over the whole record, and these sums count as independent. The result is a sandwich
/// by clusters, which is right for white noise and allows for a model error that repeats.
///
/// A second standard error takes the change of the residuals from sample to sample as white noise.
/// It is needed because ten sums are a poor estimate: if a square wave shows its leak in only one
/// or two of the classes, their sums nearly vanish at the least squares.
///
/// Rig parameters: C changes by -(J^T J)^-1 J^T J_rig per unit of each.
///
/// @param reference  number of healthy repeats whose residual was subtracted from the record; the
///                   rig's parameters then act only through the effect of the leak; 0: none
/// @param scan  of the same condition, gives the start; may be null
/// @param covered  times of the record that count, within the condition's windows
/// @param effects  of the same condition; null: none
/// @param healthy  of another record of the condition, whose simulation without a leak is taken if
///                 it is the same; null or none: it is made, and put there if there is none
LeakFit fit_leak(const LeakProblem& leak_problem, const RigFit& rig,
                 const datasets::Condition& condition, const datasets::Record& record,
                 const std::optional<datasets::TimeWindow>& covered, int reference,
                 const LeakScan* scan, const std::atomic<bool>* cancel,
                 const LeakEffects* effects = nullptr, std::optional<LeakRuns>* healthy = nullptr);

/// Effects in a condition, by simulations of the average with and without a leak.
///
/// @return  empty where the fit considered none, or where it cannot be simulated
std::shared_ptr<const LeakEffects> leak_effects_of(const LeakProblem& leak_problem,
                                                   const RigFit& rig,
                                                   const datasets::Condition& condition,
                                                   const datasets::Record& average,
                                                   const LeakScan& scan);

/// Per record and channel: record minus healthy model.
using Residuals = std::vector<std::map<datasets::Channel, std::vector<double>>>;

/// Parity residuals (eq. 14) of records of one condition: each output channel minus the healthy
/// model under the same reference, nuisance parameters at their start values.
///
/// @param records  on the time base of the average
/// @throws NoResultError  the model cannot be simulated
Residuals healthy_residuals(const LeakProblem& leak_problem, const datasets::Condition& condition,
                            const datasets::Record& average,
                            const std::vector<const datasets::Record*>& records);

/// Change of the healthy model's position by each day quantity, per standard deviation, at the
/// times of the average, shape (samples, quantities).
///
/// @throws NoResultError  the model cannot be simulated
Eigen::MatrixXd healthy_day_changes(const LeakProblem& leak_problem,
                                    const datasets::Condition& condition,
                                    const datasets::Record& average);

/// Scan of a condition by its average record.
LeakScan leak_scan_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                      const datasets::Record& average);

/// Share over the coefficient in one condition of the rig, about an estimate.
///
/// @param coefficient  estimate for the record; may be negative
/// @param reach        half the width of the interval of interest, above 0
/// @param memo         simulated leaks of the condition
/// @throws NoResultError  as steady_leak()
LeakCurve leak_curve_of(const LeakProblem& leak_problem, const datasets::Condition& condition,
                        const datasets::Record& average, double coefficient, double reach,
                        LeakMemo& memo);

/// Standard error of the share from the rig's parameters, with the coefficient fitted again. It
/// combines their direct effect on the share with their effect through the coefficient.
///
/// @param negligible  below this coefficient the leak is not simulated
/// @param effects     of the same condition; null: they act through the coefficient alone
double share_rig_error(const LeakProblem& leak_problem, const RigFit& rig,
                       const datasets::Condition& condition, const datasets::Record& average,
                       const LeakFit& fit, double share_slope, double negligible = 0.0,
                       const LeakEffects* effects = nullptr);

/// Change of the share by each day quantity, per standard deviation between days: by itself, and
/// with the coefficient, which moves by `day_effects`.
Eigen::VectorXd share_day_effects(const LeakProblem& leak_problem,
                                  const datasets::Condition& condition,
                                  const datasets::Record& average, const LeakFit& fit,
                                  double share_slope, double negligible = 0.0);

/// Share of the servo flow that leaks in a condition at given values: of a truth that is known.
double share_at(const datasets::Campaign& campaign, const datasets::Condition& condition,
                const datasets::Record& record, const std::vector<datasets::FittedValue>& values,
                const std::atomic<bool>* cancel = nullptr);

}  // namespace rigcal::diagnosis
