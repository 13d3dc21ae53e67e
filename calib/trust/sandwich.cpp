#include "calib/trust/sandwich.hpp"

#include <cmath>
#include <limits>

#include "common/parallel.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using metrics::Autoregression;
/// Rows are contiguous in memory, because the recursions run from sample to sample.
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Two-sided integral of the squared Parzen kernel.
constexpr double kParzenSquare = 0.539285;

struct ChannelRows {
  RowMajor jacobian;
  VectorXd residual;

  Index samples() const { return residual.size(); }
};

ChannelRows channel_rows(const ScoreRows& rows, Index channel) {
  const Index samples = rows.residual.size() / rows.channels;
  const Index first = channel * samples;
  RowMajor jacobian = rows.narrow.rows() > 0
                          ? RowMajor(rows.narrow.middleRows(first, samples).cast<double>())
                          : RowMajor(rows.jacobian.middleRows(first, samples));
  return {std::move(jacobian), rows.residual.segment(first, samples)};
}

/// Computes L^T J: y[t] = x[t] + sum_k phi[k] y[t + 1 + k].
RowMajor backwards(const Autoregression& noise, RowMajor rows) {
  const auto order = static_cast<Index>(noise.phi.size());
  for (Index t = rows.rows() - 1; t >= 0; --t) {
    for (Index k = 0; k < order && t + 1 + k < rows.rows(); ++k)
      rows.row(t) += noise.phi[static_cast<std::size_t>(k)] * rows.row(t + 1 + k);
  }
  return rows;
}

/// Computes L J: y[t] = x[t] + sum_k phi[k] y[t - 1 - k].
RowMajor forwards(const Autoregression& noise, RowMajor rows) {
  const auto order = static_cast<Index>(noise.phi.size());
  for (Index t = 0; t < rows.rows(); ++t) {
    for (Index k = 0; k < order && k < t; ++k)
      rows.row(t) += noise.phi[static_cast<std::size_t>(k)] * rows.row(t - 1 - k);
  }
  return rows;
}

/// Computes L^-1 x: u[t] = x[t] - sum_k phi[k] x[t - 1 - k].
RowMajor whitened(const Autoregression& noise, RowMajor rows) {
  const auto order = static_cast<Index>(noise.phi.size());
  for (Index t = rows.rows() - 1; t >= 0; --t) {
    for (Index k = 0; k < order && k < t; ++k)
      rows.row(t) -= noise.phi[static_cast<std::size_t>(k)] * rows.row(t - 1 - k);
  }
  return rows;
}

/// Computes sum_t a[t] . b[t + lag].
double lagged(const RowMajor& a, const RowMajor& b, Index lag) {
  return a.topRows(a.rows() - lag).cwiseProduct(b.bottomRows(b.rows() - lag)).sum();
}

/// Returns the bias that the fit causes in the autocovariances of the residuals, where `noise` is
/// their model and `total` is the covariance of the whole score.
std::vector<double> bias(const ChannelRows& rows, const Autoregression& noise,
                         const MatrixXd& total, Index lags) {
  const RowMajor& Q = rows.jacobian;
  RowMajor sigma_q = forwards(noise, backwards(noise, Q));
  sigma_q *= noise.variance;
  const RowMajor q_total = Q * total;
  std::vector<double> result;
  for (Index h = 0; h <= lags; ++h) {
    const double removed = lagged(Q, sigma_q, h) + lagged(sigma_q, Q, h) - lagged(q_total, Q, h);
    result.push_back(removed / static_cast<double>(rows.samples()));
  }
  return result;
}

/// Returns the covariance of the score of one channel, where `noise` is the model of its residuals.
MatrixXd expected(const ChannelRows& rows, const Autoregression& noise) {
  const RowMajor filtered = backwards(noise, rows.jacobian);
  MatrixXd lower = MatrixXd::Zero(filtered.cols(), filtered.cols());
  lower.selfadjointView<Eigen::Lower>().rankUpdate(filtered.transpose(), noise.variance);
  return lower.selfadjointView<Eigen::Lower>();
}

/// Noise of one channel, before the correction for the part that the fit removed.
struct ChannelNoise {
  std::size_t condition = 0;
  Index channel = 0;
  std::vector<double> gamma;
  Autoregression noise;
  MatrixXd expected;  ///< covariance of the channel's score, as returned by expected()
};

std::vector<ChannelNoise> channels_of(const std::vector<ScoreRows>& rows) {
  std::vector<ChannelNoise> channels;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (Index k = 0; k < rows[i].channels; ++k) channels.push_back({i, k, {}, {}, {}});
  }
  return channels;
}

/// Sums in the order of the channels rather than in the order in which threads finish, so that the
/// result is reproducible.
ArrowMatrix total_of(const ArrowMatrix& priors, const std::vector<ChannelNoise>& channels) {
  ArrowMatrix total = priors;
  for (const ChannelNoise& each : channels) total.add(each.condition, each.expected);
  return total;
}

/// Fits autoregressions to the residuals of all channels, corrected for the part that the fit
/// removed. The rows of a channel are extracted twice, because keeping all of them would determine
/// the peak memory use of a fit.
std::vector<ChannelNoise> noise_models(const std::vector<ScoreRows>& rows,
                                       const ArrowMatrix& priors, int threads) {
  std::vector<ChannelNoise> channels = channels_of(rows);
  parallel_for(channels.size(), threads, [&](std::size_t i) {
    ChannelNoise& each = channels[i];
    const ChannelRows own = channel_rows(rows[each.condition], each.channel);
    const auto samples = static_cast<std::size_t>(own.samples());
    const int lags = std::min<int>(kMostLags, static_cast<int>(samples / 10));
    each.gamma = metrics::autocovariance({own.residual.data(), samples}, lags);
    each.noise = metrics::fit_autoregression(each.gamma, static_cast<double>(samples));
    each.expected = expected(own, each.noise);
    each.gamma.resize(each.noise.phi.size() + 1);
  });
  const ArrowMatrix total = total_of(priors, channels);
  parallel_for(channels.size(), threads, [&](std::size_t i) {
    ChannelNoise& each = channels[i];
    const ChannelRows own = channel_rows(rows[each.condition], each.channel);
    std::vector<double>& gamma = each.gamma;
    const auto removed =
        bias(own, each.noise, total.of(each.condition), static_cast<Index>(gamma.size()) - 1);
    // If the correction exceeds half of the total, the fit has left too little for an estimate of
    // the noise.
    if (removed.front() < 0.5 * (gamma.front() + removed.front())) {
      for (std::size_t h = 0; h < gamma.size(); ++h) gamma[h] += removed[h];
      // Far from an optimum the residuals are not the noise that the correction assumes.
      if (!metrics::is_autocovariance(gamma)) return;
      each.noise = metrics::fit_autoregression(gamma, static_cast<double>(own.samples()));
      each.expected = expected(own, each.noise);
    }
  });
  return channels;
}

/// Returns Andrews' bandwidth for the Parzen kernel, 2.6614 (alpha(2) n)^(1/5), with alpha(2) from
/// a first-order autoregression of every component (Econometrica 59, 1991, eqs. 6.2 and 6.4).
double bandwidth(const RowMajor& scores) {
  // Limit from Andrews and Monahan (Econometrica 60, 1992). At 1 the bandwidth would be infinite.
  constexpr double kMostCorrelation = 0.97;
  double above = 0.0;
  double below = 0.0;
  const Index n = scores.rows();
  if (n <= 2) return 0.0;
  VectorXd squares = VectorXd::Zero(scores.cols());
  VectorXd products = squares;
  for (Index t = 0; t + 1 < n; ++t) {
    squares += scores.row(t).cwiseAbs2().transpose();
    products += scores.row(t).cwiseProduct(scores.row(t + 1)).transpose();
  }
  for (Index j = 0; j < scores.cols(); ++j) {
    if (!(squares(j) > 0.0)) continue;
    const double rho = std::clamp(products(j) / squares(j), -kMostCorrelation, kMostCorrelation);
    // Components are scaled by their own size, so that no component dominates.
    above += 4.0 * rho * rho / std::pow(1.0 - rho, 8.0) * std::pow(1.0 - rho * rho, 2.0);
    below += std::pow(1.0 - rho * rho, 2.0) / std::pow(1.0 - rho, 4.0);
  }
  if (!(below > 0.0)) return 0.0;
  return 2.6614 * std::pow(above / below * static_cast<double>(n), 0.2);
}

double parzen(double x) {
  if (x >= 1.0) return 0.0;
  return x <= 0.5 ? 1.0 - 6.0 * x * x * (1.0 - x) : 2.0 * std::pow(1.0 - x, 3.0);
}

/// Passes the rows S_t of an array in blocks, together with S_t / 2 + sum_h k(h / width) S_(t + h),
/// where k is the Parzen kernel. Summing over the lags before multiplying takes one product in all
/// instead of one per lag.
///
/// @param f  f(rows, sums), both of the same shape
template <typename F>
void for_each_kernel_sum(const RowMajor& rows, double width, F f) {
  constexpr Index kBlock = 128;  // a block stays in the cache over all lags
  const Index n = rows.rows();
  const Index columns = rows.cols();
  const Eigen::Map<const Eigen::ArrayXd> all(rows.data(), rows.size());
  for (Index first = 0; first < n; first += kBlock) {
    const Index count = std::min(kBlock, n - first);
    RowMajor sums = 0.5 * rows.middleRows(first, count);
    Eigen::Map<Eigen::ArrayXd> flat(sums.data(), sums.size());
    for (Index h = 1; static_cast<double>(h) < width && first + h < n; ++h) {
      const Index later = std::min(count, n - first - h) * columns;
      flat.head(later) +=
          parzen(static_cast<double>(h) / width) * all.segment((first + h) * columns, later);
    }
    f(rows.middleRows(first, count), sums);
  }
}

MatrixXd kernel_covariance(const RowMajor& scores, double width) {
  MatrixXd half = MatrixXd::Zero(scores.cols(), scores.cols());
  for_each_kernel_sum(scores, width, [&](const auto& rows, const RowMajor& sums) {
    half.noalias() += rows.transpose() * sums;
  });
  return half + half.transpose();
}

/// Returns the diagonal of kernel_covariance().
VectorXd kernel_variances(const RowMajor& scores, double width) {
  VectorXd half = VectorXd::Zero(scores.cols());
  for_each_kernel_sum(scores, width, [&](const auto& rows, const RowMajor& sums) {
    for (Index t = 0; t < sums.rows(); ++t)
      half += rows.row(t).cwiseProduct(sums.row(t)).transpose();
  });
  return 2.0 * half;
}

/// Returns the products of rows with the combinations c (one per column). Those of the leading
/// combinations that are one direction each, in order, are the rows themselves.
RowMajor combined_rows(const RowMajor& rows, const MatrixXd& c) {
  const Index directions = c.rows();
  if (c.cols() <= directions ||
      !(c.leftCols(directions).array() == MatrixXd::Identity(directions, directions).array()).all())
    return rows * c;
  RowMajor result(rows.rows(), c.cols());
  result.leftCols(directions) = rows;
  result.rightCols(c.cols() - directions).noalias() = rows * c.rightCols(c.cols() - directions);
  return result;
}

/// Sums over the channels of a condition, each of shape (samples, directions or combinations).
/// Because records are long, at most these and two more such arrays are in memory at any time.
struct ChannelSums {
  RowMajor scores;   ///< contributions of the samples to the score
  RowMajor weights;  ///< variance of each combination of these contributions
  /// Covariance of the contributions with the error of each combination, divided by the standard
  /// error of the combination; empty if it is left out.
  RowMajor own;
  double independent_residuals = 0.0;
};

void add(RowMajor& sum, RowMajor term) {
  if (sum.size() == 0) {
    sum = std::move(term);
  } else {
    sum += term;
  }
}

ChannelSums sum_channels(const ScoreRows& rows, const std::vector<Autoregression>& noise,
                         const MatrixXd& total, const MatrixXd& combinations, OwnPart own_part) {
  const MatrixXd c = combinations.transpose();
  const MatrixXd total_c = total * c;
  const VectorXd variance = (c.transpose() * total_c).diagonal();
  const Eigen::ArrayXd per_error =
      variance.unaryExpr([](double each) { return each > 0.0 ? 1.0 / std::sqrt(each) : 0.0; });
  ChannelSums sums;
  for (Index k = 0; k < rows.channels; ++k) {
    const Autoregression& model = noise[static_cast<std::size_t>(k)];
    ChannelRows channel = channel_rows(rows, k);
    const VectorXd innovations = whitened(model, channel.residual).col(0);
    RowMajor filtered = backwards(model, channel.jacobian);
    RowMajor combined = combined_rows(filtered, c);
    filtered.array().colwise() *= innovations.array();
    add(sums.scores, std::move(filtered));
    if (own_part == OwnPart::computed) {
      RowMajor own = model.variance * combined;
      own.noalias() -= whitened(model, std::move(channel.jacobian)) * total_c;
      own.array() *= combined.array();
      own.array().rowwise() *= per_error.transpose();
      add(sums.own, std::move(own));
    }
    combined = model.variance * combined.cwiseAbs2();
    add(sums.weights, std::move(combined));
    sums.independent_residuals +=
        model.effective_samples(static_cast<double>(channel.residual.size()));
  }
  return sums;
}

ScoreContribution scatter_of(const ScoreRows& rows, std::vector<Autoregression> noise,
                             const MatrixXd& total, const MatrixXd& combinations,
                             OwnPart own_part) {
  ScoreContribution result;
  const auto [scores, weights, own, independent_residuals] =
      sum_channels(rows, noise, total, combinations, own_part);
  result.independent_residuals = independent_residuals;
  const double width = bandwidth(scores);
  result.covariance = kernel_covariance(scores, width);
  const bool whitening =
      std::any_of(noise.begin(), noise.end(), [](const auto& each) { return !each.phi.empty(); });
  result.freedom = VectorXd::Zero(combinations.rows());
  VectorXd own_variance;
  if (own_part == OwnPart::computed) {
    result.own = VectorXd::Zero(combinations.rows());
    own_variance = kernel_variances(own, width);
  }
  VectorXd sum = VectorXd::Zero(combinations.rows());
  VectorXd squares = sum;
  for (Index t = 0; t < weights.rows(); ++t) {
    sum += weights.row(t).transpose();
    squares += weights.row(t).cwiseAbs2().transpose();
  }
  for (Index j = 0; j < combinations.rows(); ++j) {
    if (!(squares(j) > 0.0)) continue;
    const VectorXd c = combinations.row(j).transpose();
    if (own_variance.size() > 0) {
      if (const double all = c.dot(total * c); all > 0.0) result.own(j) = own_variance(j) / all;
    }
    const double terms = sum(j) * sum(j) / squares(j);
    result.freedom(j) = 1.0 / (std::max(1.0, kParzenSquare * width) / terms +
                               (whitening ? 2.0 / result.independent_residuals : 0.0));
  }
  result.noise = std::move(noise);
  return result;
}

/// Returns the element of `own` for an unknown, or zero if the unknown belongs to another
/// condition.
double own_in(const ScoreContribution& scatter, const ArrowRoot& combinations, Index unknown,
              std::size_t condition) {
  const int whose = combinations.condition_of(unknown);
  if (scatter.own.size() == 0 || (whose >= 0 && whose != static_cast<int>(condition))) return 0.0;
  const Index row = combinations.row_of(unknown);
  return scatter.own(whose < 0 ? combinations.own_unknowns(condition) + row : row);
}

}  // namespace

void ScoreRows::make_narrow() {
  narrow = jacobian.cast<float>();
  jacobian.resize(0, 0);
}

MatrixXd ScoreRows::rows(Index first, Index count) const {
  if (narrow.rows() > 0) return narrow.middleRows(first, count).cast<double>();
  return jacobian.middleRows(first, count);
}

std::vector<ScoreContribution> score_contributions(const std::vector<ScoreRows>& rows,
                                                   const ArrowMatrix& priors,
                                                   const ArrowRoot& combinations, int threads,
                                                   OwnPart own) {
  std::vector<ChannelNoise> channels = noise_models(rows, priors, threads);
  const ArrowMatrix total = total_of(priors, channels);
  std::vector<std::vector<Autoregression>> noise(rows.size());
  for (ChannelNoise& each : channels) noise[each.condition].push_back(std::move(each.noise));
  std::vector<ScoreContribution> result(rows.size());
  parallel_for(rows.size(), threads, [&](std::size_t i) {
    result[i] = scatter_of(rows[i], std::move(noise[i]), total.of(i), combinations.rows(i), own);
  });
  return result;
}

double freedom_in(const ScoreContribution& scatter, const ArrowRoot& combinations, Index unknown,
                  std::size_t condition) {
  const int whose = combinations.condition_of(unknown);
  const Index row = combinations.row_of(unknown);
  if (whose == static_cast<int>(condition)) return scatter.freedom(row);
  const Index own = combinations.own_unknowns(condition);
  if (whose < 0) return scatter.freedom(own + row);
  double least = 0.0;
  for (Index j = own; j < scatter.freedom.size(); ++j) {
    const double each = scatter.freedom(j);
    if (each > 0.0 && (least == 0.0 || each < least)) least = each;
  }
  return least;
}

RobustVariance robust_variance(const std::vector<ScoreContribution>& scatter,
                               const ArrowMatrix& priors, const ArrowRoot& combinations,
                               Index unknown) {
  RobustVariance result;
  result.variance = combinations.quadratic(unknown, priors);
  std::vector<double> parts;
  for (std::size_t i = 0; i < scatter.size(); ++i) {
    const VectorXd c = combinations.row(unknown, i);
    parts.push_back(c.dot(scatter[i].covariance * c));
    result.variance += parts.back();
    result.own += own_in(scatter[i], combinations, unknown, i);
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < scatter.size(); ++i) {
    const double share = parts[i] / result.variance;
    const double freedom = freedom_in(scatter[i], combinations, unknown, i);
    if (freedom > 0.0 && share > 0.0) squares += share * share / freedom;
  }
  result.freedom = squares > 0.0 ? 1.0 / squares : std::numeric_limits<double>::infinity();
  return result;
}

double RobustVariance::quantile() const {
  constexpr double kMostOwn = 0.9;      // keeps the divisor away from zero
  constexpr double kMostFreedom = 1e9;  // above this, Student's t is practically normal
  const double share = std::clamp(own, 0.0, kMostOwn);
  const double rest = 1.0 - share;
  const double scatter = std::max(1.0 / freedom - share * share, 1.0 / kMostFreedom);
  const double t = student_t(rest * rest / scatter);
  return t / std::sqrt(rest + share * t * t);
}

double student_t(double freedom) {
  return metrics::student_t_quantile(0.975, std::max(freedom, 1.0));
}

}  // namespace rigcal::calib
