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

/// With more unknowns nothing is refitted: the matrices are dense.
inline constexpr std::size_t kMostRefitted = 64;

/// Minimum of a problem with some effects as further unknowns.
struct Refit {
  std::vector<double> z;
  Eigen::VectorXd sizes;       ///< of the effects over their plausible sizes
  Eigen::MatrixXd covariance;  ///< (J^T J)^-1, unknowns in the unit box, then effects
  double squares = 0.0;        ///< sum of the squared weighted residuals and priors
  /// The same sum for each condition, predicted from the others to first order; absent with one
  /// condition.
  std::optional<double> held_out;
};

/// Estimates the unknowns again with some effects beside them, by Gauss-Newton steps whose
/// sensitivities are those of the model with the effects. An effect that cannot be negative ends at
/// zero where the records pull it below.
class Refitter {
 public:
  /// @param scores  residuals of the fit, at z
  Refitter(const Problem& problem, std::span<const double> z, const std::vector<ScoreRows>& scores,
           int threads, const std::atomic<bool>* cancel);

  /// @param start  of unknowns and sizes
  /// @return       nothing if a simulation fails or no minimum is found
  std::optional<Refit> fit(const std::vector<Effect>& effects, std::vector<double> start,
                           Eigen::VectorXd sizes) const;

 private:
  /// Squares, gradient and J^T J of one condition.
  struct Part {
    bool ok = false;
    double squares = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd normal;
    Eigen::VectorXd residual;  ///< until complete() has made gradient and J^T J of it
    Eigen::MatrixXd jacobian;  ///< likewise; columns: the acting unknowns, then the effects
  };
  /// The squares, and what a simulation with the derivatives by the unknowns gives besides.
  Part squares_at(std::size_t condition, const std::vector<Effect>& effects,
                  std::span<const double> z, const Eigen::VectorXd& sizes) const;
  /// Simulates the derivatives by the effects, and makes gradient and J^T J.
  void complete(std::size_t condition, const std::vector<Effect>& effects,
                std::span<const double> z, const Eigen::VectorXd& sizes, Part& part) const;
  Part priors_at(std::span<const double> z, Eigen::Index unknowns) const;

  const Problem& problem_;
  const std::vector<ScoreRows>& scores_;
  int threads_;
  const std::atomic<bool>* cancel_;
  std::vector<Eigen::VectorXd> base_;  ///< weighted outputs without effects, at z
};

}  // namespace rigcal::calib
