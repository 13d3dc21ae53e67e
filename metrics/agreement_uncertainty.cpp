#include "metrics/agreement_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "metrics/distributions.hpp"
#include "metrics/metric_table.hpp"

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

/// Largest noise in the mean, estimated from the largest deviation of a repeat from the mean.
double largest_noise(const MeasuredMean& measured) {
  double largest = 0.0;
  for (const auto& own : measured.deviations)
    for (const double d : own)
      if (!std::isnan(d)) largest = std::max(largest, std::abs(d));
  return largest / std::sqrt(static_cast<double>(measured.deviations.size()) - 1.0);
}

/// Half width of the two-sided interval: the one without bias, combined with how much the noise in
/// the mean has worsened the score.
///
/// @param noise   largest noise in the mean
/// @param half    half width of the interval without bias
/// @param factor  factor on the standard uncertainty that `half` contains
double half_with_bias(const std::vector<Agreement>& without, const Agreement& found,
                      double Agreement::*score, double noise, double half, double factor) {
  const auto repeats = static_cast<double>(without.size());
  double away = -(found.*score);
  for (const Agreement& each : without) away += each.*score / repeats;
  away = std::abs(away);
  if (score == &Agreement::maximum_error) return std::hypot(half, noise);
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
    const double error = factor * std::sqrt(squares * (repeats - 1.0) / repeats);
    const double bias = std::max(0.0, (mean - square) * (repeats - 1.0));
    return std::max(half, error_of(found) - std::sqrt(std::max(0.0, square - bias - error)));
  }
  return half + away * (repeats - 1.0);
}

/// Scores after the sensor's uncertainty has changed the mean, with one list per cause.
using Changed = std::vector<std::vector<Agreement>>;

Changed changed_by_sensor(const MeasuredMean& measured, std::span<const double> simulated) {
  const auto score = [&](double gain, double offset) {
    std::vector<double> changed(measured.mean.begin(), measured.mean.end());
    for (double& y : changed) y = gain * y + offset;
    return agreement(changed, simulated);
  };
  Changed result;
  if (const double sd = measured.gain_sd; sd > 0.0)
    result.push_back({score(1.0 + sd, 0.0), score(1.0 - sd, 0.0)});
  if (const double sd = measured.offset_sd; sd > 0.0) {
    result.push_back({score(1.0, sd), score(1.0, -sd)});
    // The offset may also change from one end of the range to the other. rho2 and R, which are
    // insensitive to a constant, respond to this.
    const auto [low, high] = std::minmax_element(measured.mean.begin(), measured.mean.end());
    const double middle = 0.5 * (*low + *high);
    const double share = sd / (0.5 * (*high - *low));
    result.back().push_back(score(1.0 + share, -share * middle));
    if (share < 1.0) result.back().push_back(score(1.0 - share, share * middle));
  }
  for (const std::vector<double>& change : measured.changes) {
    std::vector<Agreement>& both = result.emplace_back();
    for (const double sign : {1.0, -1.0}) {
      std::vector<double> changed(measured.mean.begin(), measured.mean.end());
      for (std::size_t i = 0; i < changed.size(); ++i) changed[i] += sign * change[i];
      both.push_back(agreement(changed, simulated));
    }
  }
  return result;
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
  const Changed changed = changed_by_sensor(measured, simulated);
  const double freedom = static_cast<double>(deviations.size()) - 1.0;
  ScoreUncertainty result;
  for (const MetricSpec& metric : kMetrics) {
    const auto score = metric.value;
    const double by_repeats = jackknife_variance(without, score);
    double variance = by_repeats;
    for (const std::vector<Agreement>& cause : changed) {
      double change = 0.0;
      for (const Agreement& each : cause)
        change = std::max(change, std::abs(each.*score - found.*score));
      variance += change * change;
    }
    const double share = variance > 0.0 ? by_repeats / variance : 1.0;
    const double factor =
        share > 0.0 ? student_t_quantile(0.975, freedom / (share * share)) : normal_quantile(0.975);
    const double half = factor * std::sqrt(variance);
    result.one_sided.*score = half;
    result.two_sided.*score =
        half_with_bias(without, found, score, largest_noise(measured), half, factor);
  }
  return result;
}

}  // namespace rigcal::metrics
