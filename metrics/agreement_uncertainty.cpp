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

/// Mean of the other repeats; that of all where no other has the sample.
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

/// Scores after changes of the mean by the sensor's uncertainty; one list per cause.
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
    // An offset may also change from one end of the range to the other: rho2 and R are blind to a
    // constant.
    const auto [low, high] = std::minmax_element(measured.mean.begin(), measured.mean.end());
    const double middle = 0.5 * (*low + *high);
    const double share = sd / (0.5 * (*high - *low));
    result.back().push_back(score(1.0 + share, -share * middle));
    if (share < 1.0) result.back().push_back(score(1.0 - share, share * middle));
  }
  return result;
}

}  // namespace

std::optional<Agreement> agreement_uncertainty(const MeasuredMean& measured,
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
  Agreement result;
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
    result.*score = factor * std::sqrt(variance);
  }
  return result;
}

}  // namespace rigcal::metrics
