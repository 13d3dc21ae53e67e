#pragma once

#include <Eigen/Core>
#include <atomic>
#include <optional>
#include <span>
#include <vector>

#include "calib/posterior/nuts.hpp"
#include "calib/problem/evaluation.hpp"
#include "calib/result/estimate_covariance.hpp"
#include "calib/result/fitted_parameter.hpp"
#include "calib/trust/uncertainty.hpp"

namespace rigcal::calib {

/// Distribution of the sizes of the effects if the outputs are linear in the unknowns and q is
/// kept. The log density is slope^T e - e^T precision e / 2. The density is zero where a one-sided
/// size is negative.
struct SizesBeside {
  Eigen::MatrixXd precision;
  Eigen::VectorXd slope;
  Eigen::VectorXd mean;
  std::vector<bool> one_sided;
};

/// Posterior density of the unknowns of a problem, and of the sizes of the small effects that its
/// model leaves out.
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
/// The effects are linear about the optimum, as for the intervals (consider_effects()): sizes e add
/// C e to q. They also change p = Q^T r by F e, in directions beside the estimates in which the
/// noise has the covariance W. With effects,
///
///     -2 log L = q^T S^-1 q + p^T W^-1 p + (r^T r - q0^T q0 - p0^T p0) / kappa,
///
/// where q0 and p0 are q and p without effects. A stated prior counts in q, not in p, as in the
/// intervals.
///
/// Prior: uniform between the bounds on the scale that the fit uses, the coordinate z of the unit
/// box. An unknown with `prior` and `prior_sd` has that normal distribution, truncated at its
/// bounds. The size of an effect, in units of its plausible size, is N(0, 1), truncated at zero for
/// an effect that cannot be negative.
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
  /// @param effects     the effects, borrowed; null if the model counts as exact
  /// @param cancel      set to true to stop simulations; from then on the density is zero
  ///                    everywhere
  PosteriorDensity(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
                   const std::vector<FittedParameter>& parameters,
                   const std::atomic<bool>* cancel = nullptr,
                   const EffectLikelihood* effects = nullptr);

  /// Returns the density of the unknowns and effects at a point, and its gradient with respect to
  /// y.
  ///
  /// @param e  sizes of the effects, as multiples of their plausible sizes; empty if the model
  ///           counts as exact
  LogDensity at(const Eigen::VectorXd& y, const Eigen::VectorXd& e = Eigen::VectorXd()) const {
    return evaluate(y, e, Fidelity::full);
  }
  /// Returns only the logarithm of the density, from simulations without sensitivities.
  double value(const Eigen::VectorXd& y, const Eigen::VectorXd& e = Eigen::VectorXd()) const {
    return evaluate(y, e, {false, true}).value;
  }

  /// Returns the start point. It is the optimum, corrected for the mean sizes of the effects. If it
  /// is less than one standard error from a bound, it is one standard error away from the bound.
  const Eigen::VectorXd& centre() const { return centre_; }
  /// Returns the unknowns of a point, in the unit box.
  std::vector<double> to_unit(const Eigen::VectorXd& y) const;
  Eigen::VectorXd from_unit(std::span<const double> z) const;
  /// Returns the point at which the unknowns make room for other sizes of the effects, so that q
  /// stays the same if the outputs are linear in the unknowns. Returns std::nullopt beyond a bound.
  std::optional<Eigen::VectorXd> moved(const Eigen::VectorXd& y, const Eigen::VectorXd& from,
                                       const Eigen::VectorXd& to) const;
  /// Returns log(z (1 - z)), summed over the unknowns.
  double log_volume(const Eigen::VectorXd& y) const;
  const SizesBeside& sizes_beside() const { return sizes_; }
  /// Returns by how much effects of these sizes change the weighted outputs of a condition, shape
  /// (channels * samples that count).
  Eigen::VectorXd changes(std::size_t condition, const Eigen::VectorXd& e) const;
  /// Returns the covariance of a normal approximation for given sizes of the effects, from the
  /// curvature at the optimum including the priors and the transform.
  const Eigen::MatrixXd& covariance() const { return covariance_; }
  /// Returns the variance of the residuals in directions that do not affect the estimates.
  double noise() const { return kappa_; }

 private:
  void find_centre(const Evaluation& optimum, const Eigen::MatrixXd& scores);
  /// @param fidelity  without derivatives, the result has no gradient
  LogDensity evaluate(const Eigen::VectorXd& y, const Eigen::VectorXd& e,
                      const Fidelity& fidelity) const;

  struct Directions {
    /// Rows of the Jacobian at the optimum, shape (residuals, acting unknowns).
    Eigen::MatrixXd jacobian;
    Eigen::MatrixXd root;  ///< rows of R for the acting unknowns, shape (acting, directions)
  };

  const Problem& problem_;
  const std::atomic<bool>* cancel_;
  const EffectLikelihood* effects_;
  std::vector<Directions> conditions_;
  Eigen::MatrixXd root_;       ///< R, shape (unknowns, directions)
  Eigen::VectorXd prior_row_;  ///< d residual / d z of the priors at the optimum; 0 without a prior
  Eigen::MatrixXd information_;  ///< S^-1
  Eigen::MatrixXd beside_;       ///< W^-1
  SizesBeside sizes_;
  double kappa_ = 1.0;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd covariance_;
};

}  // namespace rigcal::calib
