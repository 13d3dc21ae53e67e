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

/// Largest number of unknowns for a refit, because its matrices are dense.
inline constexpr std::size_t kMostRefitted = 64;

/// Minimum of a problem with some effects as additional unknowns.
struct Refit {
  std::vector<double> z;
  Eigen::VectorXd sizes;       ///< effects, as multiples of their plausible sizes
  Eigen::MatrixXd covariance;  ///< (J^T J)^-1; unknowns in the unit box, then effects
  double squares = 0.0;        ///< sum of the squared weighted residuals and priors
  /// That sum with each condition predicted from the others to first order; absent if there is only
  /// one condition.
  std::optional<double> held_out;
};

/// Estimates the unknowns again together with some effects, by Gauss-Newton steps. The
/// sensitivities are those of the model with the effects. An effect that cannot be negative ends at
/// zero if the records push it below.
///
/// With recorded drives a step may take several samples of the drive, so each simulation is dear
/// (docs/decisions/0053). There the sensitivities are kept while the steps lower the squares as
/// promised, and the last step, which promises less than one variance, is not simulated.
class Refitter {
 public:
  /// @param scores  residuals of the fit at z
  Refitter(const Problem& problem, std::span<const double> z, const std::vector<ScoreRows>& scores,
           int threads, const std::atomic<bool>* cancel);

  /// @param start  start values of the unknowns
  /// @param sizes  start values of the effects, as multiples of their plausible sizes
  /// @return       std::nullopt if a simulation fails or no minimum is found
  std::optional<Refit> fit(const std::vector<Effect>& effects, std::vector<double> start,
                           Eigen::VectorXd sizes) const;

 private:
  /// Sum of squares, gradient and J^T J of one condition.
  struct Part {
    bool ok = false;
    double squares = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd normal;
    Eigen::VectorXd residual;  ///< until project() has made gradient and J^T J of it
    Eigen::MatrixXd jacobian;  ///< likewise; columns: the acting unknowns, then the effects
    Eigen::MatrixXf kept;      ///< the same for later steps, in seven digits; recorded drives only

    /// Change of the sum of squares after a step, if the residual is linear in it.
    double linear_change(const Eigen::VectorXd& step) const {
      return 2.0 * gradient.dot(step) + step.dot(normal * step);
    }
    /// Goes on to where a step leads, likewise.
    void take(const Eigen::VectorXd& step) {
      squares += linear_change(step);
      gradient += normal * step;
    }
  };
  /// The squares. If no drive is recorded, also the derivatives by the unknowns, from the same
  /// simulation.
  Part squares_at(std::size_t condition, const std::vector<Effect>& effects,
                  std::span<const double> z, const Eigen::VectorXd& sizes) const;
  /// Simulates the derivatives that squares_at() leaves out.
  void derive(std::size_t condition, const std::vector<Effect>& effects, std::span<const double> z,
              const Eigen::VectorXd& sizes, Part& part) const;
  /// Makes gradient and J^T J.
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
