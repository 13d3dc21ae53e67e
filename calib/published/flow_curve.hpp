#pragma once

#include <functional>
#include <map>
#include <vector>

#include "calib/published/periodic_flow.hpp"

namespace rigcal::calib {

/// Mean flows of one rig under one drive as a function of the leakage coefficient. Every
/// coefficient is simulated once; each simulation starts with the number of periods and samples
/// that the one before needed.
class FlowCurve {
 public:
  using Quantity = std::function<double(const PeriodicFlow&)>;

  /// @param values  the rig's; the leakage coefficient in them does not count
  FlowCurve(PeriodicDrive drive, model::ParameterValues values, PeriodicOptions options)
      : drive_(std::move(drive)), values_(std::move(values)), options_(options) {}

  /// @throws NoResultError  it cannot be simulated, or is not periodic in time: says where and why
  const PeriodicFlow& at(double coefficient);

  /// d ln share / d ln coefficient, by sensitivities.
  ///
  /// @throws NoResultError  as at()
  double log_slope(double coefficient) const;

  /// d ln share / d parameter, by sensitivities: of the coefficient, then of `parameters` (rows of
  /// the parameter table, SI). Shape (1 + parameters).
  ///
  /// @throws NoResultError  as at()
  Eigen::VectorXd share_slopes(double coefficient, std::span<const int> parameters) const;

  /// Simulates a grid of coefficients, equidistant in their logarithm.
  void scan(double lowest, double highest, int per_decade);

  /// All coefficients among those simulated so far between which `quantity` passes `target`,
  /// found to 1e-4 of themselves, in increasing order. Where the quantity is flat near the target
  /// the scan is made finer first, so that a plateau does not hide a pair of roots.
  ///
  /// @param quantity  positive
  std::vector<double> roots(const Quantity& quantity, double target);

  /// Every coefficient simulated so far with its flows, increasing.
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

}  // namespace rigcal::calib
