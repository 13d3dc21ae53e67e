#pragma once

#include <Eigen/Core>
#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "calib/consider/catalogue.hpp"
#include "calib/problem/problem.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {

/// Maximum number of unknowns for a refit; it is limited because the matrices are dense.
inline constexpr std::size_t kMostRefitted = 64;

/// Minimum of a problem in which some effects are additional unknowns.
struct Refit {
  std::vector<double> z;
  Eigen::VectorXd sizes;  ///< effects, as multiples of their plausible sizes
  /// (J^T J)^-1 for the unknowns in the unit box, followed by the effects.
  Eigen::MatrixXd covariance;
  double squares = 0.0;  ///< sum of the squared weighted residuals and priors
  /// The same sum if each condition is predicted from the others, to first order. Absent if there
  /// is only one condition.
  std::optional<double> held_out;
};

/// Estimates the unknowns again, together with some effects, by Gauss-Newton steps. The
/// sensitivities are those of the model that includes the effects. An effect that cannot be
/// negative ends at zero if the records would make it negative.
///
/// With recorded drives simulations are expensive (docs/decisions/0053). The sensitivities are then
/// used again while the steps lower the squares as predicted, and a last step that is predicted to
/// gain less than one variance is not simulated.
class Refitter {
 public:
  /// @param scores  contain the residuals of the fit at z
  Refitter(const Problem& problem, std::span<const double> z, const std::vector<ScoreRows>& scores,
           int threads, const std::atomic<bool>* cancel);

  /// @param start  start values of the unknowns
  /// @param sizes  start values of the effects, as multiples of their plausible sizes
  /// @return       std::nullopt if a simulation fails or no minimum is found
  std::optional<Refit> fit(const std::vector<Effect>& effects, std::vector<double> start,
                           Eigen::VectorXd sizes) const;

 private:
  /// Sum of squares, gradient and J^T J for one condition.
  struct Part {
    bool ok = false;
    double squares = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd normal;
    Eigen::VectorXd residual;  ///< kept until project() has computed gradient and J^T J
    Eigen::MatrixXd jacobian;  ///< same rows; columns: acting unknowns, then effects
    Eigen::MatrixXf kept;      ///< for later steps, in seven digits; recorded drives only

    /// Returns the change of the sum of squares after a step, if the residuals are linear in it.
    double linear_change(const Eigen::VectorXd& step) const {
      return 2.0 * gradient.dot(step) + step.dot(normal * step);
    }
    /// Moves to the end of a step, under the same assumption.
    void take(const Eigen::VectorXd& step) {
      squares += linear_change(step);
      gradient += normal * step;
    }
  };
  /// Computes the sum of squares. If no drive is recorded, the same simulation gives the
  /// derivatives with respect to the unknowns, too.
  Part squares_at(std::size_t condition, const std::vector<Effect>& effects,
                  std::span<const double> z, const Eigen::VectorXd& sizes) const;
  /// Simulates the derivatives that squares_at() leaves out.
  void derive(std::size_t condition, const std::vector<Effect>& effects, std::span<const double> z,
              const Eigen::VectorXd& sizes, Part& part) const;
  /// Computes gradient and J^T J.
  void project(std::size_t condition, std::size_t unknowns, Eigen::Index effects, Part& part) const;
  Part priors_at(std::span<const double> z, Eigen::Index unknowns) const;

  const Problem& problem_;
  const std::vector<ScoreRows>& scores_;
  int threads_;
  const std::atomic<bool>* cancel_;
  bool recorded_;                      ///< a drive is recorded
  std::vector<Eigen::VectorXd> base_;  ///< weighted outputs at z without effects
};

}  // namespace rigcal::calib
