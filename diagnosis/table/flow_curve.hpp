#pragma once

#include <functional>
#include <map>
#include <vector>

#include "diagnosis/table/periodic_flow.hpp"

namespace rigcal::diagnosis {

/// Mean flows of one rig under one drive as a function of the leakage coefficient. Each coefficient
/// is simulated only once, and each simulation starts with the numbers of periods and samples that
/// the previous one needed.
class FlowCurve {
 public:
  using Quantity = std::function<double(const PeriodicFlow&)>;

  /// @param values  values of the rig; their leakage coefficient is ignored
  FlowCurve(PeriodicDrive drive, model::ParameterValues values, PeriodicOptions options)
      : drive_(std::move(drive)), values_(std::move(values)), options_(options) {}

  /// @throws NoResultError  if the coefficient cannot be simulated or the run does not become
  ///                        periodic; states where and why
  const PeriodicFlow& at(double coefficient);

  /// Returns d ln share / d ln coefficient, from sensitivities.
  ///
  /// @throws NoResultError  as for at()
  double log_slope(double coefficient) const;

  /// Returns d ln share / d parameter from sensitivities, first for the coefficient, then for
  /// `parameters` (rows of the parameter table), SI. Shape (1 + parameters).
  ///
  /// @throws NoResultError  as for at()
  Eigen::VectorXd share_slopes(double coefficient, std::span<const int> parameters) const;

  /// Simulates a grid of coefficients that is equidistant on a logarithmic scale.
  void scan(double lowest, double highest, int per_decade);

  /// Finds all coefficients in the simulated range at which `quantity` equals `target`, in
  /// increasing order and with a relative accuracy of 1e-4. If the quantity is nearly constant
  /// close to the target, the scan is refined first, so that a plateau cannot hide a pair of roots.
  ///
  /// @param quantity  must be positive
  std::vector<double> roots(const Quantity& quantity, double target);

  /// Returns every coefficient simulated so far with its flows, in increasing order.
  const std::map<double, PeriodicFlow>& simulated() const { return known_; }
  const PeriodicDrive& drive() const { return drive_; }

 private:
  PeriodicFlow simulate(double coefficient, std::span<const int> free) const;
  const PeriodicFlow* nearest(double coefficient) const;
  void polish(const Quantity& quantity, double target);

  PeriodicDrive drive_;
  model::ParameterValues values_;
  PeriodicOptions options_;
  std::map<double, PeriodicFlow> known_;
};

}  // namespace rigcal::diagnosis
