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
    Eigen::VectorXd residual;  ///< kept until complete() has computed gradient and J^T J
    /// Kept as long as `residual`; columns: the acting unknowns, then the effects.
    Eigen::MatrixXd jacobian;
  };
  /// Computes the sum of squares and everything else that a single simulation with derivatives with
  /// respect to the unknowns provides.
  Part squares_at(std::size_t condition, const std::vector<Effect>& effects,
                  std::span<const double> z, const Eigen::VectorXd& sizes) const;
  /// Simulates the derivatives with respect to the effects, and computes gradient and J^T J.
  void complete(std::size_t condition, const std::vector<Effect>& effects,
                std::span<const double> z, const Eigen::VectorXd& sizes, Part& part) const;
  Part priors_at(std::span<const double> z, Eigen::Index unknowns) const;

  const Problem& problem_;
  const std::vector<ScoreRows>& scores_;
  int threads_;
  const std::atomic<bool>* cancel_;
  std::vector<Eigen::VectorXd> base_;  ///< weighted outputs at z without effects
};

}  // namespace rigcal::calib
