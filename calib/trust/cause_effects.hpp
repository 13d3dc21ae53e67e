#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calib/problem/problem.hpp"

namespace rigcal::calib {

/// What the parameters by which repeats may differ do to the outputs of every condition: supply
/// pressure and bulk modulus, as far as the plant has them and the campaign does not declare that
/// they differ. A condition is simulated once, when it is first asked for: whether a cause is
/// likely, and whether noise could look like it, are questions to the same simulation.
class CauseEffects {
 public:
  /// Borrows both.
  CauseEffects(const Problem& problem, std::span<const double> z);

  const Problem& problem() const { return problem_; }
  /// Their keys.
  const std::vector<std::string>& causes() const { return causes_; }
  /// Of each cause in a condition, SI.
  std::vector<double> values(std::size_t condition) const;
  /// Change of the weighted outputs per SI unit, shape (channels * samples that count, causes);
  /// empty where the condition cannot be simulated.
  const Eigen::MatrixXd& of(std::size_t condition);
  /// What recorded inputs explain of the deviations of the repeats (repeat_inputs.hpp).
  Eigen::MatrixXd explained_by_inputs(std::size_t condition) const;

 private:
  const Problem& problem_;
  std::span<const double> z_;
  std::vector<int> indices_;  ///< rows of the plant's table
  std::vector<std::string> causes_;
  std::vector<std::optional<Eigen::MatrixXd>> effects_;  ///< of the conditions asked for so far
};

}  // namespace rigcal::calib
