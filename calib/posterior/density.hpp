#pragma once

#include <Eigen/Core>
#include <atomic>
#include <span>
#include <vector>

#include "calib/posterior/nuts.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Posterior density of the unknowns of a problem.
///
/// Likelihood: the weighted residuals r of the fit are normal. In the directions that affect the
/// estimates, which are the columns of G = J R at the optimum, their covariance is the matrix S
/// from which the fit computes its errors. Autocorrelated residuals, differences between repeats
/// and stated uncertainties of known values thus widen the posterior in the same way as the
/// intervals. In all other directions the residuals are white with variance kappa, which is the
/// mean of S, but at least 1 and at least the reduced chi-square. Hence
///
///     -2 log L = q^T S^-1 q + (r^T r - q^T q) / kappa,  q = G^T r,
///
/// which equals r^T r if the noise is white and known. Close to the optimum the curvature of the
/// likelihood matches the covariance of the fit; further away the simulations determine its shape.
///
/// Prior: uniform between the bounds on the scale that the fit uses, the coordinate z of the unit
/// box. An unknown with `prior` and `prior_sd` has that normal distribution, truncated at its
/// bounds.
///
/// Coordinates of the sampler: y = log(z / (1 - z)). In these coordinates the density has a factor
/// z (1 - z) for each unknown.
class PosteriorDensity {
 public:
  /// Borrows the problem.
  ///
  /// @param optimum     an evaluation with status ok, with its rows
  /// @param found       uncertainty of the fit at the optimum
  /// @param parameters  parameters of the unknowns, in the same order; they specify on which error
  ///                    each interval is based
  /// @param cancel      set to true to stop simulations; from then on the density is zero
  ///                    everywhere
  PosteriorDensity(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
                   const std::vector<FittedParameter>& parameters,
                   const std::atomic<bool>* cancel = nullptr);

  LogDensity at(const Eigen::VectorXd& y) const { return evaluate(y, Fidelity::full); }
  /// Returns only the logarithm of the density, from simulations without sensitivities.
  double value(const Eigen::VectorXd& y) const { return evaluate(y, {false, true}).value; }

  /// Returns the start point. It is the optimum, or if the optimum is less than one standard error
  /// from a bound, a point that is one standard error away from the bound.
  const Eigen::VectorXd& centre() const { return centre_; }
  std::vector<double> to_unit(const Eigen::VectorXd& y) const;
  Eigen::VectorXd from_unit(std::span<const double> z) const;
  /// Returns the covariance of a normal approximation, from the curvature at the optimum including
  /// the priors and the transform.
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Returns the variance of the residuals in directions that do not affect the estimates.
  double noise() const { return kappa_; }

 private:
  /// @param fidelity  without derivatives, the result has no gradient
  LogDensity evaluate(const Eigen::VectorXd& y, const Fidelity& fidelity) const;

  struct Directions {
    /// Rows of the Jacobian at the optimum, shape (residuals, acting unknowns).
    Eigen::MatrixXd jacobian;
    Eigen::MatrixXd root;  ///< rows of R for the acting unknowns, shape (acting, directions)
  };

  const Problem& problem_;
  const std::atomic<bool>* cancel_;
  std::vector<Directions> conditions_;
  Eigen::MatrixXd root_;       ///< R, shape (unknowns, directions)
  Eigen::VectorXd prior_row_;  ///< d residual / d z of the priors at the optimum; 0 without a prior
  Eigen::MatrixXd weight_;     ///< S^-1 - 1 / kappa
  double kappa_ = 1.0;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd covariance_;
};

}  // namespace rigcal::calib
