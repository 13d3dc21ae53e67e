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

/// Posterior of the unknowns of a problem.
///
/// Likelihood: the weighted residuals r of the fit are normal. In the directions that move the
/// estimates, the columns of G = J R at the optimum, their covariance is S, that by which the fit
/// computes its errors: autocorrelated residuals, repeats that differ and stated uncertainties of
/// known values widen the posterior as they widen the intervals. In all other directions they are
/// white with the variance kappa, the mean of S, at least 1 and at least the reduced chi-square. So
///
///     -2 log L = q^T S^-1 q + (r^T r - q^T q) / kappa,  q = G^T r,
///
/// which is r^T r where the noise is white and known. Near the optimum it has the curvature of the
/// fit's covariance, and further away the shape that the simulations give it.
///
/// Prior: uniform between the bounds in the fit's own scale, the coordinate z of the unit box. An
/// unknown with `prior` and `prior_sd` has that normal distribution, cut off at its bounds.
///
/// Coordinates of the sampler: y = log(z / (1 - z)), in which the density has the factor z (1 - z)
/// of each unknown.
class PosteriorDensity {
 public:
  /// Borrows the problem.
  ///
  /// @param optimum     an evaluation that is ok, with its rows
  /// @param found       the uncertainty of the fit there
  /// @param parameters  of the unknowns, in their order: which error their intervals rest on
  /// @param cancel      ends simulations; what follows has no density
  PosteriorDensity(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
                   const std::vector<FittedParameter>& parameters,
                   const std::atomic<bool>* cancel = nullptr);

  LogDensity at(const Eigen::VectorXd& y) const { return evaluate(y, Fidelity::full); }
  /// The logarithm alone, by simulations without sensitivities.
  double value(const Eigen::VectorXd& y) const { return evaluate(y, {false, true}).value; }

  /// A point to begin at: the optimum, or one standard error inside where that is nearer to a
  /// bound.
  const Eigen::VectorXd& centre() const { return centre_; }
  std::vector<double> to_unit(const Eigen::VectorXd& y) const;
  Eigen::VectorXd from_unit(std::span<const double> z) const;
  /// Covariance of a normal distribution near this one: curvature at the optimum, priors and
  /// transform included.
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Variance of the residuals outside the directions that move the estimates.
  double noise() const { return kappa_; }

 private:
  /// @param fidelity  without derivatives there is no gradient
  LogDensity evaluate(const Eigen::VectorXd& y, const Fidelity& fidelity) const;

  struct Directions {
    Eigen::MatrixXd jacobian;  ///< rows at the optimum, shape (residuals, acting unknowns)
    Eigen::MatrixXd root;      ///< R of the acting unknowns, shape (acting, directions)
  };

  const Problem& problem_;
  const std::atomic<bool>* cancel_;
  std::vector<Directions> conditions_;
  Eigen::MatrixXd root_;       ///< R, shape (unknowns, directions)
  Eigen::VectorXd prior_row_;  ///< d residual / d z of the priors at the optimum; 0: none
  Eigen::MatrixXd weight_;     ///< S^-1 - 1 / kappa
  double kappa_ = 1.0;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd covariance_;
};

}  // namespace rigcal::calib
