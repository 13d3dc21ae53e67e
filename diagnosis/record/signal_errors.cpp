#include "diagnosis/record/signal_errors.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/record/residual_rms.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

/// Returns true if a variance with `freedom` degrees of freedom exceeds the variance of white noise
/// by so much that the ratio is in the upper quartile of chi-square. Callers then use this
/// variance, and otherwise the variance of the noise. At this level, choosing between two variances
/// keeps the coverage of an interval close to 95 % for any true ratio (Bancroft and Han,
/// International Statistical Review 45, 1977).
bool exceeds_noise(double variance, double noise_variance, double freedom) {
  constexpr double kUpperQuartile = 0.25;  // as in calib/trust/between_repeats.cpp
  if (!(variance > noise_variance)) return false;
  if (!(noise_variance > 0.0)) return true;
  return metrics::chi_squared_exceedance(freedom * variance / noise_variance, freedom) <
         kUpperQuartile;
}

double power(double x) { return x * x; }

/// Returns true if the variances of all records together exceed those of white noise.
bool has_misfit(const std::vector<const LeakFit*>& records) {
  double ratios = 0.0;
  double freedom = 0.0;
  for (const LeakFit* fit : records) {
    if (!(fit->white_se > 0.0)) continue;
    ratios += fit->cluster_freedom * power(fit->cluster_se / fit->white_se);
    freedom += fit->cluster_freedom;
  }
  return freedom == 0.0 || exceeds_noise(ratios / freedom, 1.0, freedom);
}

void set_residual_ratio(const std::vector<const LeakFit*>& records, SignalErrors& errors) {
  double ratios = 0.0;
  double squares = 0.0;  // squared ratios over their degrees of freedom
  double count = 0.0;
  for (const LeakFit* fit : records) {
    if (!(fit->white_se > 0.0)) continue;
    const bool coloured = is_coloured(*fit, errors);
    const double ratio = coloured ? power(fit->cluster_se / fit->white_se) : 1.0;
    ratios += ratio;
    squares += power(ratio) / (coloured ? fit->cluster_freedom : metrics::kManyDegrees);
    ++count;
  }
  if (count == 0.0) return;
  errors.residual_ratio = ratios / count;
  errors.residual_freedom = power(ratios) / (count * squares);
}

}  // namespace

bool is_coloured(const LeakFit& fit, const SignalErrors& errors) {
  return errors.misfit &&
         exceeds_noise(power(fit.cluster_se), power(fit.white_se), fit.cluster_freedom);
}

SignalErrors signal_errors(const std::vector<std::vector<SingleFit>>& singles,
                           const std::vector<const LeakFit*>& healthy,
                           const std::vector<const LeakFit*>& averages) {
  SignalErrors errors;
  std::vector<const LeakFit*> records = averages;
  double squares = 0.0;
  double noise = 0.0;  // expected from noise, for the same degrees of freedom
  for (const auto& members : singles) {
    if (members.size() < 2) continue;
    double mean = 0.0;
    for (const SingleFit& each : members) mean += each.fit->coefficient;
    mean /= static_cast<double>(members.size());
    const double freedom_of_each = 1.0 - 1.0 / static_cast<double>(members.size());
    for (const auto& [fit, corrected_by] : members) {
      // The distance of x from the mean of r others is (r + 1) / r times its distance from the mean
      // of all r + 1.
      const double spread = corrected_by > 0 ? corrected_by / (corrected_by + 1.0) : 1.0;
      squares += power(spread * (fit->coefficient - mean) * fit->effect_m);
      noise += freedom_of_each * power(fit->noise_se * fit->effect_m);
      records.push_back(fit);
    }
    errors.repeat_freedom += static_cast<int>(members.size()) - 1;
  }
  if (errors.repeat_freedom > 0) {
    errors.repeat_m = std::sqrt(squares / errors.repeat_freedom);
    errors.repeat_noise_m = std::sqrt(noise / errors.repeat_freedom);
  }
  double sum = 0.0;
  for (const LeakFit* each : healthy) sum += power(each->coefficient * each->effect_m);
  if (!healthy.empty()) errors.healthy_m = std::sqrt(sum / static_cast<double>(healthy.size()));
  errors.misfit = has_misfit(records);
  set_residual_ratio(averages.empty() ? records : averages, errors);
  return errors;
}

void separate_noise(const std::vector<SignalErrors*>& signals) {
  double ratios = 0.0;
  double freedom = 0.0;
  for (const SignalErrors* each : signals) {
    if (!each->repeat_m || !(each->repeat_noise_m > 0.0)) continue;
    ratios += each->repeat_freedom * power(*each->repeat_m / each->repeat_noise_m);
    freedom += each->repeat_freedom;
  }
  const bool any = freedom == 0.0 || exceeds_noise(ratios / freedom, 1.0, freedom);
  for (SignalErrors* each : signals) {
    if (!each->repeat_m) continue;
    const double all = power(*each->repeat_m);
    const double noise = power(each->repeat_noise_m);
    const bool differ = any && exceeds_noise(all, noise, each->repeat_freedom);
    each->between_m = differ ? std::sqrt(all - noise) : 0.0;
  }
}

double unexplained_share(const LeakFit& fit, double healthy_m) {
  const double left = structured_rms(fit.misfit_rms_m, fit.noise_rms_m);
  if (left <= std::max(2.0 * healthy_m, fit.noise_rms_m)) return 0.0;
  const double beyond = power(left) - power(healthy_m);
  const double explained = power(fit.parity_rms_m) - power(fit.misfit_rms_m);
  return beyond / (beyond + std::max(0.0, explained));
}

}  // namespace rigcal::diagnosis
