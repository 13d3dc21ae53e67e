#include "calib/posterior/density.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Limits for the distance from a bound at which the sampler may start, as fractions of the box. At
/// the bound itself, the sampler's coordinates would be infinite.
constexpr double kLeastDistance = 1e-6;
constexpr double kMostDistance = 0.25;
/// Minimum eigenvalue of the covariance of the score, relative to the mean eigenvalue.
constexpr double kLeastEigenvalue = 1e-6;

double logistic(double y) {
  // Neither branch overflows, and a very small z keeps its full precision.
  return y >= 0.0 ? 1.0 / (1.0 + std::exp(-y)) : std::exp(y) / (1.0 + std::exp(y));
}

double log_logistic(double y) {
  return y >= 0.0 ? -std::log1p(std::exp(-y)) : y - std::log1p(std::exp(y));
}

/// Returns R for all unknowns and all directions as a dense matrix.
MatrixXd dense_root(const ArrowRoot& root, std::size_t conditions) {
  MatrixXd all = MatrixXd::Zero(root.unknowns(), root.directions());
  for (Index j = 0; j < root.unknowns(); ++j) {
    const int whose = root.condition_of(j);
    if (whose < 0) {
      all.row(j).tail(root.shared().cols()) = root.shared().row(root.row_of(j));
    } else if (static_cast<std::size_t>(whose) < conditions) {
      const auto i = static_cast<std::size_t>(whose);
      all(j, root.directions(i)) = root.row(j, i).transpose();
    }
  }
  return all;
}

/// Returns S in the directions of the root. It is the covariance of the score estimated from the
/// residuals, or that for white noise, scaled so that each unknown has the error reported by the
/// fit.
MatrixXd score_contributions(const Problem& problem, const Evaluation& optimum,
                             const Uncertainty& found,
                             const std::vector<FittedParameter>& parameters, const MatrixXd& root,
                             const VectorXd& prior_row) {
  const Index directions = root.cols();
  const bool robust =
      !found.scatter.empty() &&
      std::any_of(parameters.begin(), parameters.end(), [](const FittedParameter& each) {
        return each.ci95_from == IntervalSource::robust_standard_error;
      });
  MatrixXd covariance = MatrixXd::Zero(directions, directions);
  if (robust) {
    for (std::size_t i = 0; i < found.scatter.size(); ++i) {
      const std::vector<Index> own = found.root.directions(i);
      covariance(own, own) += found.scatter[i].covariance;
    }
    const MatrixXd priors = root.transpose() * prior_row.asDiagonal();
    covariance += priors * priors.transpose();
  } else {
    covariance.diagonal().setConstant(std::max(1.0, found.reduced_chi_square));
  }
  // The error that the fit reports for an unknown may come from the repeats, or may include the
  // uncertainty of known values.
  VectorXd stretch = VectorXd::Ones(root.rows());
  for (Index j = 0; j < root.rows(); ++j) {
    const auto u = static_cast<std::size_t>(j);
    const bool by_residuals = parameters[u].ci95_from == IntervalSource::robust_standard_error;
    const auto& error = by_residuals ? found.robust_standard_error[u] : found.standard_error[u];
    const double variance = root.row(j) * covariance * root.row(j).transpose();
    const double slope = std::abs(problem.map.slope(static_cast<int>(j), optimum.z[u]));
    if (error && variance > 0.0 && slope > 0.0 && *error > 0.0)
      stretch(j) = *error / slope / std::sqrt(variance);
  }
  if (((stretch.array() - 1.0).abs() > 1e-9).any()) {
    const Eigen::CompleteOrthogonalDecomposition<MatrixXd> inverse(root);
    const MatrixXd stretched = inverse.solve(MatrixXd(stretch.asDiagonal() * root));
    covariance = MatrixXd(stretched * covariance * stretched.transpose());
  }
  return covariance;
}

/// Returns the inverse of a covariance whose eigenvalues have a minimum.
MatrixXd information_of(const MatrixXd& covariance) {
  const MatrixXd symmetric = 0.5 * (covariance + covariance.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(symmetric);
  if (symmetric.size() == 0) return symmetric;
  const double least = kLeastEigenvalue * std::max(solver.eigenvalues().mean(), 1e-300);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(least).cwiseInverse().asDiagonal() *
         solver.eigenvectors().transpose();
}

}  // namespace

PosteriorDensity::PosteriorDensity(const Problem& problem, const Evaluation& optimum,
                                   const Uncertainty& found,
                                   const std::vector<FittedParameter>& parameters,
                                   const std::atomic<bool>* cancel, const EffectLikelihood* effects)
    : problem_(problem), cancel_(cancel), effects_(effects) {
  const auto unknowns = static_cast<Index>(optimum.z.size());
  root_ = dense_root(found.root, problem.conditions.size());
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const std::vector<int>& acting = problem.map.acting(i);
    conditions_.push_back({(*optimum.rows)[i].jacobian, root_(acting, Eigen::all)});
  }
  prior_row_.resize(unknowns);
  for (Index j = 0; j < unknowns; ++j)
    prior_row_(j) =
        problem.map.prior_slope(static_cast<int>(j), optimum.z[static_cast<std::size_t>(j)]);

  const MatrixXd scores =
      score_contributions(problem, optimum, found, parameters, root_, prior_row_);
  const Index directions = root_.cols();
  kappa_ = std::max({1.0, found.reduced_chi_square,
                     directions > 0 ? scores.trace() / static_cast<double>(directions) : 1.0});
  information_ = information_of(scores);
  if (effects != nullptr) {
    beside_ = information_of(effects->covariance);
    const Index count = effects->felt.cols();
    VectorXd score = VectorXd::Zero(effects->felt.rows());  // Q^T r at the optimum
    for (std::size_t i = 0; i < problem.conditions.size(); ++i)
      score += effects->beside[i].cast<double>().transpose() * (*optimum.rows)[i].residual;
    sizes_ = {
        MatrixXd::Identity(count, count) + effects->felt.transpose() * beside_ * effects->felt,
        -effects->felt.transpose() * (beside_ * score), effects->mean, effects->one_sided};
  }
  find_centre(optimum, scores);
}

void PosteriorDensity::find_centre(const Evaluation& optimum, const MatrixXd& scores) {
  const Index unknowns = root_.rows();
  VectorXd shift = VectorXd::Zero(unknowns);
  if (effects_ != nullptr) shift = -root_ * (effects_->taken * effects_->mean);
  // In the unit box the precision is R^-T S^-1 R^-1 in the directions that the records determine.
  // The transform adds terms that keep the other coordinates finite.
  const MatrixXd inverse = Eigen::CompleteOrthogonalDecomposition<MatrixXd>(root_).pseudoInverse();
  const MatrixXd precision = inverse.transpose() * information_ * inverse;
  VectorXd slope(unknowns);
  std::vector<double> begin;
  for (Index j = 0; j < unknowns; ++j) {
    const double variance = root_.row(j) * scores * root_.row(j).transpose();
    const double error = std::sqrt(std::max(0.0, variance));
    const double inside = std::clamp(error, kLeastDistance, kMostDistance);
    const double z =
        std::clamp(optimum.z[static_cast<std::size_t>(j)] + shift(j), inside, 1.0 - inside);
    slope(j) = z * (1.0 - z);
    begin.push_back(z);
  }
  centre_ = from_unit(begin);
  MatrixXd curvature = slope.asDiagonal() * precision * slope.asDiagonal();
  // An unknown that the records do not determine has a logistic distribution, whose variance is
  // pi^2 / 3.
  curvature.diagonal().array() += 3.0 / (M_PI * M_PI);
  covariance_ = Eigen::LLT<MatrixXd>(curvature).solve(MatrixXd::Identity(unknowns, unknowns));
  covariance_ = MatrixXd(0.5 * (covariance_ + covariance_.transpose()));
}

std::vector<double> PosteriorDensity::to_unit(const VectorXd& y) const {
  std::vector<double> z;
  for (const double each : y) z.push_back(logistic(each));
  return z;
}

VectorXd PosteriorDensity::from_unit(std::span<const double> z) const {
  VectorXd y(static_cast<Index>(z.size()));
  for (Index j = 0; j < y.size(); ++j) {
    const double inside =
        std::clamp(z[static_cast<std::size_t>(j)], kLeastDistance, 1.0 - kLeastDistance);
    y(j) = std::log(inside / (1.0 - inside));
  }
  return y;
}

std::optional<VectorXd> PosteriorDensity::moved(const VectorXd& y, const VectorXd& from,
                                                const VectorXd& to) const {
  const VectorXd by = root_ * (effects_->taken * (from - to));
  std::vector<double> z = to_unit(y);
  for (std::size_t j = 0; j < z.size(); ++j) {
    z[j] += by(static_cast<Index>(j));
    if (!(z[j] > kLeastDistance && z[j] < 1.0 - kLeastDistance)) return std::nullopt;
  }
  return from_unit(z);
}

double PosteriorDensity::log_volume(const VectorXd& y) const {
  double sum = 0.0;
  for (const double each : y) sum += log_logistic(each) + log_logistic(-each);
  return sum;
}

VectorXd PosteriorDensity::changes(std::size_t condition, const VectorXd& e) const {
  const Directions& own = conditions_[condition];
  const VectorXd beside = effects_->felt * e;
  return own.jacobian * (own.root * (effects_->taken * e)) +
         effects_->beside[condition].cast<double>() * beside;
}

LogDensity PosteriorDensity::evaluate(const VectorXd& y, const VectorXd& e,
                                      const Fidelity& fidelity) const {
  const std::vector<double> z = to_unit(y);
  const Index unknowns = y.size();
  VectorXd p = VectorXd::Zero(beside_.cols());
  MatrixXd p_slopes = MatrixXd::Zero(beside_.cols(), unknowns);  // d p / d z
  VectorXd q = VectorXd::Zero(root_.cols());
  MatrixXd slopes = MatrixXd::Zero(root_.cols(), unknowns);  // d q / d z
  VectorXd gradient = VectorXd::Zero(unknowns);              // J^T r
  double square = 0.0;
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    const ProblemCondition& condition = problem_.conditions[i];
    const model::Simulation run = simulate_condition(problem_, i, z, cancel_, fidelity);
    if (!run.ok()) return {};
    const std::vector<int>& acting = problem_.map.acting(i);
    const VectorXd box_slopes = fidelity.derivatives ? acting_slopes(problem_, i, z) : VectorXd();
    const Index free = box_slopes.size();
    const auto columns = static_cast<Index>(acting.size());
    const auto samples = condition.rows.size();
    VectorXd projected = VectorXd::Zero(columns);
    MatrixXd projected_slopes = MatrixXd::Zero(columns, columns);
    VectorXd own_gradient = VectorXd::Zero(columns);
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      double unused = 0.0;
      constexpr std::size_t kBlock = 512;  // small enough to stay in the cache
      for (std::size_t begin = 0; begin < samples; begin += kBlock) {
        const std::size_t end = std::min(begin + kBlock, samples);
        const MatrixXd weighted = weighted_rows(condition, k, {begin, end}, run, box_slopes,
                                                problem_.campaign->fit, unused);
        const auto before = conditions_[i].jacobian.middleRows(
            static_cast<Index>(k * samples + begin), weighted.rows());
        const auto residual = weighted.col(free);
        projected.noalias() += before.transpose() * residual;
        square += residual.squaredNorm();
        MatrixXd along;  // in the directions beside the estimates
        if (effects_ != nullptr) {
          along = effects_->beside[i]
                      .middleRows(static_cast<Index>(k * samples + begin), weighted.rows())
                      .cast<double>()
                      .transpose() *
                  weighted;
          p += along.col(free);
        }
        if (!fidelity.derivatives) continue;
        for (Index a = 0; a < columns && effects_ != nullptr; ++a)
          p_slopes.col(acting[static_cast<std::size_t>(a)]) += along.col(a);
        projected_slopes.noalias() += before.transpose() * weighted.leftCols(columns);
        own_gradient.noalias() += weighted.leftCols(columns).transpose() * residual;
      }
    }
    q.noalias() += conditions_[i].root.transpose() * projected;
    const MatrixXd turned = conditions_[i].root.transpose() * projected_slopes;
    for (Index a = 0; a < columns; ++a) {
      slopes.col(acting[static_cast<std::size_t>(a)]) += turned.col(a);
      gradient(acting[static_cast<std::size_t>(a)]) += own_gradient(a);
    }
  }
  double log_prior = 0.0;
  VectorXd prior_gradient = VectorXd::Zero(unknowns);
  for (Index j = 0; j < unknowns; ++j) {
    const auto u = static_cast<std::size_t>(j);
    const int unknown = static_cast<int>(j);
    if (!problem_.map.unknowns()[u].prior) continue;
    const double residual = problem_.map.prior_residual(unknown, z[u]);
    const double slope = problem_.map.prior_slope(unknown, z[u]);
    q.noalias() += root_.row(j).transpose() * (prior_row_(j) * residual);
    slopes.col(j).noalias() += root_.row(j).transpose() * (prior_row_(j) * slope);
    gradient(j) += slope * residual;
    square += residual * residual;
    // The prior is normal in the value: d value / d z is constant, or proportional to the value if
    // z is logarithmic.
    const double box_slope = problem_.map.slope(unknown, z[u]);
    log_prior += std::log(box_slope);
    prior_gradient(j) =
        std::log(problem_.map.slope(unknown, 1.0) / problem_.map.slope(unknown, 0.0));
  }
  LogDensity result;
  const double white = (square - q.squaredNorm() - p.squaredNorm()) / kappa_;
  gradient -= slopes.transpose() * q + p_slopes.transpose() * p;  // the white part alone
  if (effects_ != nullptr) {
    q += effects_->taken * e;
    p += effects_->felt * e;
  }
  const VectorXd weighted_q = information_ * q;
  const VectorXd weighted_p = beside_ * p;
  result.value =
      -0.5 * (q.dot(weighted_q) + p.dot(weighted_p) + white + e.squaredNorm()) + log_prior;
  result.gradient = prior_gradient - (slopes.transpose() * weighted_q +
                                      p_slopes.transpose() * weighted_p + gradient / kappa_);
  for (Index j = 0; j < unknowns; ++j) {
    const double inside = z[static_cast<std::size_t>(j)];
    const double above = logistic(-y(j));
    result.gradient(j) = result.gradient(j) * inside * above + above - inside;
  }
  result.value += log_volume(y);
  if (!result.gradient.allFinite()) return {};
  return result;
}

}  // namespace rigcal::calib
