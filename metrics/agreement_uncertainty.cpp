#include "metrics/agreement_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "metrics/distributions.hpp"
#include "metrics/metric_table.hpp"
#include "metrics/significance.hpp"

namespace rigcal::metrics {
namespace {

/// Number of repeats with a value at each sample, shape (n).
std::vector<double> counts_of(const std::vector<std::vector<double>>& deviations, std::size_t n) {
  std::vector<double> counts(n, 0.0);
  for (const auto& own : deviations)
    for (std::size_t i = 0; i < n; ++i)
      if (!std::isnan(own[i])) counts[i] += 1.0;
  return counts;
}

/// Mean of the other repeats; if no other repeat has the sample, the mean of all.
std::vector<double> mean_without(std::span<const double> mean, const std::vector<double>& own,
                                 const std::vector<double>& counts) {
  std::vector<double> others(mean.begin(), mean.end());
  for (std::size_t i = 0; i < others.size(); ++i)
    if (!std::isnan(own[i]) && counts[i] > 1.0) others[i] -= own[i] / (counts[i] - 1.0);
  return others;
}

bool all_zero(const std::vector<std::vector<double>>& deviations) {
  return std::all_of(deviations.begin(), deviations.end(), [](const auto& own) {
    return std::all_of(own.begin(), own.end(), [](double d) { return !(std::abs(d) > 0.0); });
  });
}

double jackknife_variance(const std::vector<Agreement>& without, double Agreement::*score) {
  const auto repeats = static_cast<double>(without.size());
  double sum = 0.0;
  for (const Agreement& each : without) sum += each.*score;
  double squares = 0.0;
  for (const Agreement& each : without)
    squares += (each.*score - sum / repeats) * (each.*score - sum / repeats);
  return squares * (repeats - 1.0) / repeats;
}

/// Scores after a cause has changed the mean by one standard uncertainty. Each shape of the change
/// has two items, one for each direction; the last shape may lack the second direction. Empty if
/// the cause does not act.
using Changed = std::vector<Agreement>;

/// Largest change in a score that a cause makes.
double largest_change(const Changed& cause, const Agreement& found, double Agreement::*score) {
  double change = 0.0;
  for (const Agreement& each : cause)
    change = std::max(change, std::abs(each.*score - found.*score));
  return change;
}

/// Effects of the sensor's uncertainty on the scores.
struct ChangedBySensor {
  Changed by_gain, by_offset;
  std::vector<Changed> by_others;  ///< one per item of MeasuredMean::changes

  template <typename Visit>
  void visit(const Visit& each) const {
    each(by_gain);
    each(by_offset);
    for (const Changed& cause : by_others) each(cause);
  }
};

ChangedBySensor changed_by_sensor(const MeasuredMean& measured, std::span<const double> simulated) {
  const auto score = [&](double gain, double offset) {
    std::vector<double> changed(measured.mean.begin(), measured.mean.end());
    for (double& y : changed) y = gain * y + offset;
    return agreement(changed, simulated);
  };
  ChangedBySensor result;
  if (const double sd = measured.gain_sd; sd > 0.0)
    result.by_gain = {score(1.0 + sd, 0.0), score(1.0 - sd, 0.0)};
  if (const double sd = measured.offset_sd; sd > 0.0) {
    result.by_offset = {score(1.0, sd), score(1.0, -sd)};
    // The offset may also change from one end of the range to the other. rho2 and R, which are
    // insensitive to a constant, respond to this.
    const auto [low, high] = std::minmax_element(measured.mean.begin(), measured.mean.end());
    const double middle = 0.5 * (*low + *high);
    const double share = sd / (0.5 * (*high - *low));
    result.by_offset.push_back(score(1.0 + share, -share * middle));
    if (share < 1.0) result.by_offset.push_back(score(1.0 - share, share * middle));
  }
  for (const std::vector<double>& change : measured.changes) {
    Changed& both = result.by_others.emplace_back();
    for (const double sign : {1.0, -1.0}) {
      std::vector<double> changed(measured.mean.begin(), measured.mean.end());
      for (std::size_t i = 0; i < changed.size(); ++i) changed[i] += sign * change[i];
      both.push_back(agreement(changed, simulated));
    }
  }
  return result;
}

/// Largest noise in the mean, estimated from the largest deviation of a repeat from the mean.
///
/// R repeats have R - 1 independent deviations of the same distribution as the noise in the mean,
/// apart from a factor. The noise thus exceeds the largest of them in 1 / R of cases. If there are
/// fewer than five repeats, the estimate is raised to what five would show: the largest of m values
/// grows by the variance over the largest value for every factor of e in m (Gumbel).
double largest_noise(const MeasuredMean& measured) {
  constexpr double kFreedomOfFive = 4.0;
  double largest = 0.0;
  double squares = 0.0;
  double count = 0.0;
  for (const auto& own : measured.deviations) {
    for (const double d : own) {
      if (std::isnan(d)) continue;
      largest = std::max(largest, std::abs(d));
      squares += d * d;
      count += 1.0;
    }
  }
  const double freedom = static_cast<double>(measured.deviations.size()) - 1.0;
  const double lacking = std::max(0.0, std::log(kFreedomOfFive / freedom));
  return (largest + lacking * squares / count / largest) / std::sqrt(freedom);
}

/// Half width of the 95 % interval of a cause, in standard uncertainties.
double sensor_factor() { return normal_quantile(0.975); }

/// How far the square of an error could fall if the sensor were not off by a cause. The square is a
/// parabola of the cause, of which three points are known; the cause is within its 95 % interval.
template <typename ErrorOf>
double square_by_cause(const Changed& cause, const Agreement& found, const ErrorOf& error_of) {
  const auto square = [&](const Agreement& each) { return std::pow(error_of(each), 2); };
  const double factor = sensor_factor();
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < cause.size(); i += 2) {
    const double more = square(cause[i]) - square(found);
    const double less = square(cause[i + 1]) - square(found);
    const double slope = 0.5 * std::abs(more - less);
    const double curvature = 0.5 * (more + less);
    const double at = curvature > 0.0 ? std::min(factor, 0.5 * slope / curvature) : factor;
    most = std::max(most, slope * at - curvature * at * at);
  }
  return most;
}

/// How far the largest error could fall if the sensor were not off by a cause, to first order.
double maximum_by_cause(const Changed& cause) {
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < cause.size(); i += 2)
    most = std::max(most, std::abs(cause[i].maximum_error - cause[i + 1].maximum_error));
  return 0.5 * sensor_factor() * most;
}

/// Half width of the two-sided interval: the one without bias, combined with how much the noise in
/// the mean, and the error of the sensor, have worsened the score.
///
/// Only the repeats determine the bias, whatever else makes the score uncertain. The factor of its
/// error is therefore that of their own degrees of freedom.
///
/// @param noise  largest noise in the mean
/// @param half   half width of the interval without bias
double half_with_bias(const std::vector<Agreement>& without, const Agreement& found,
                      const ChangedBySensor& changed, double Agreement::*score, double noise,
                      double half) {
  const auto repeats = static_cast<double>(without.size());
  const double factor_of_repeats = student_t_quantile(0.975, repeats - 1.0);
  if (score == &Agreement::maximum_error) {
    double by_sensor = 0.0;
    changed.visit([&](const Changed& cause) { by_sensor += maximum_by_cause(cause); });
    return std::max(std::hypot(half, noise), noise + by_sensor);
  }
  const bool fit_percent = score == &Agreement::nrmse_fit_percent;
  if (score == &Agreement::rmse || score == &Agreement::absolute_error_percent || fit_percent) {
    // Squared errors have a bias in 1/R. A fit in percent is 100 minus such an error.
    const auto error_of = [&](const Agreement& each) {
      return fit_percent ? 100.0 - each.*score : each.*score;
    };
    double mean = 0.0;
    for (const Agreement& each : without) mean += std::pow(error_of(each), 2) / repeats;
    double squares = 0.0;
    for (const Agreement& each : without)
      squares += std::pow(std::pow(error_of(each), 2) - mean, 2);
    const double square = std::pow(error_of(found), 2);
    const double error = factor_of_repeats * std::sqrt(squares * (repeats - 1.0) / repeats);
    double bias = std::max(0.0, (mean - square) * (repeats - 1.0));
    changed.visit([&](const Changed& cause) { bias += square_by_cause(cause, found, error_of); });
    return std::max(half, error_of(found) - std::sqrt(std::max(0.0, square - bias - error)));
  }
  double away = -(found.*score);
  for (const Agreement& each : without) away += each.*score / repeats;
  const double by_repeats = factor_of_repeats * std::sqrt(jackknife_variance(without, score));
  return std::max(half, by_repeats) + std::abs(away) * (repeats - 1.0);
}

}  // namespace

std::optional<ScoreUncertainty> agreement_uncertainty(const MeasuredMean& measured,
                                                      std::span<const double> simulated) {
  const Agreement found = agreement(measured.mean, simulated);
  const auto& deviations = measured.deviations;
  if (deviations.size() < 2 || all_zero(deviations)) return std::nullopt;
  const std::vector<double> counts = counts_of(deviations, measured.mean.size());
  std::vector<Agreement> without;
  try {
    for (const auto& own : deviations)
      without.push_back(agreement(mean_without(measured.mean, own, counts), simulated));
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
  const ChangedBySensor changed = changed_by_sensor(measured, simulated);
  const double noise = largest_noise(measured);
  const double freedom = static_cast<double>(deviations.size()) - 1.0;
  ScoreUncertainty result;
  ScoreContributions& parts = result.contributions;
  parts.changes.resize(changed.by_others.size());
  for (const MetricSpec& metric : kMetrics) {
    const auto score = metric.value;
    const double by_repeats = jackknife_variance(without, score);
    double variance = by_repeats;
    const auto add = [&](const Changed& cause, Agreement& part) {
      const double change = largest_change(cause, found, score);
      variance += change * change;
      part.*score = change;
    };
    add(changed.by_gain, parts.gain);
    add(changed.by_offset, parts.offset);
    for (std::size_t i = 0; i < parts.changes.size(); ++i)
      add(changed.by_others[i], parts.changes[i]);
    const double share = variance > 0.0 ? by_repeats / variance : 1.0;
    const double degrees = share > 0.0 ? freedom / (share * share) : kManyDegrees;
    const double factor = share > 0.0 ? student_t_quantile(0.975, degrees) : normal_quantile(0.975);
    const double half = factor * std::sqrt(variance);
    const double both = half_with_bias(without, found, changed, score, noise, half);
    result.one_sided.*score = half;
    result.two_sided.*score = both;
    parts.repeats.*score = std::sqrt(by_repeats);
    parts.noise_left.*score = std::sqrt(std::max(0.0, both * both - half * half)) / factor;
    parts.degrees_of_freedom.*score = std::min(degrees, kManyDegrees);
    parts.coverage_factor.*score = factor;
  }
  return result;
}

}  // namespace rigcal::metrics
