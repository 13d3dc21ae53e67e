#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Effects on the outputs of every condition of the parameters that may differ between repeats:
/// supply pressure and bulk modulus, if the plant has them and the campaign does not declare them.
/// A condition is simulated once, at the first request; the simulation answers both whether a cause
/// is likely and whether noise could look like it.
class CauseEffects {
 public:
  /// Borrows both.
  CauseEffects(const Problem& problem, std::span<const double> z);

  const Problem& problem() const { return problem_; }
  /// Their keys.
  const std::vector<std::string>& causes() const { return causes_; }
  /// Values of the causes in a condition, SI.
  std::vector<double> values(std::size_t condition) const;
  /// Change of the weighted outputs per SI unit, shape (channels * samples that count, causes);
  /// empty where the condition cannot be simulated.
  const Eigen::MatrixXd& of(std::size_t condition);
  /// Part of the repeats' deviations that recorded inputs explain (repeat_inputs.hpp).
  Eigen::MatrixXd explained_by_inputs(std::size_t condition) const;

 private:
  const Problem& problem_;
  std::span<const double> z_;
  std::vector<int> indices_;  ///< rows of the plant's table
  std::vector<std::string> causes_;
  std::vector<std::optional<Eigen::MatrixXd>> effects_;  ///< for the conditions requested so far
};

}  // namespace rigcal::calib
