#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// Computes how parameters that may differ between repeats affect the outputs of every condition.
/// These are supply pressure and bulk modulus, if the plant has them and the campaign does not
/// declare them. Each condition is simulated only once, on the first request. The result is used
/// both to find likely causes and to test whether noise could look like one.
class CauseEffects {
 public:
  /// Borrows both arguments.
  CauseEffects(const Problem& problem, std::span<const double> z);

  const Problem& problem() const { return problem_; }
  /// Keys of the parameters.
  const std::vector<std::string>& causes() const { return causes_; }
  /// Returns the values of the causes in a condition, SI.
  std::vector<double> values(std::size_t condition) const;
  /// Returns the change in the weighted outputs per SI unit, shape (channels * scored samples,
  /// causes). Empty if the condition cannot be simulated.
  const Eigen::MatrixXd& of(std::size_t condition);
  /// Returns the component of the repeats' deviations that recorded inputs explain
  /// (repeat_inputs.hpp).
  Eigen::MatrixXd explained_by_inputs(std::size_t condition) const;

 private:
  const Problem& problem_;
  std::span<const double> z_;
  std::vector<int> indices_;  ///< rows of the plant's parameter table
  std::vector<std::string> causes_;
  /// One for each condition; absent until requested.
  std::vector<std::optional<Eigen::MatrixXd>> effects_;
};

}  // namespace rigcal::calib
