#include "diagnosis/signal_errors.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/residual_rms.hpp"

namespace rigcal::diagnosis {
namespace {

double power(double x) { return x * x; }

}  // namespace

SignalErrors signal_errors(const std::vector<std::vector<const LeakFit*>>& singles,
                           const std::vector<const LeakFit*>& healthy) {
  SignalErrors errors;
  double squares = 0.0;
  for (const auto& members : singles) {
    if (members.size() < 2) continue;
    double mean = 0.0;
    for (const LeakFit* each : members) mean += each->coefficient;
    mean /= static_cast<double>(members.size());
    for (const LeakFit* each : members)
      squares += power((each->coefficient - mean) * each->effect_m);
    errors.repeat_freedom += static_cast<int>(members.size()) - 1;
  }
  if (errors.repeat_freedom > 0) errors.repeat_m = std::sqrt(squares / errors.repeat_freedom);
  double sum = 0.0;
  for (const LeakFit* each : healthy) sum += power(each->coefficient * each->effect_m);
  if (!healthy.empty()) errors.healthy_m = std::sqrt(sum / static_cast<double>(healthy.size()));
  return errors;
}

double unexplained_share(const LeakFit& fit, double healthy_m) {
  const double left = structured_rms(fit.misfit_rms_m, fit.noise_rms_m);
  if (left <= std::max(2.0 * healthy_m, fit.noise_rms_m)) return 0.0;
  const double beyond = power(left) - power(healthy_m);
  const double explained = power(fit.parity_rms_m) - power(fit.misfit_rms_m);
  return beyond / (beyond + std::max(0.0, explained));
}

}  // namespace rigcal::diagnosis
