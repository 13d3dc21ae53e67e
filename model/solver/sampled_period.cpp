#include "model/solver/sampled_period.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "model/signal/same_instant.hpp"

namespace rigcal::model {
namespace {

/// Largest number of drive periods to try. With a drive at 3 Hz and samples at 1 kHz, the samples
/// repeat after three periods.
constexpr int kMostPeriods = 20;

bool constant(const std::optional<Signal>& signal) { return !signal || signal->period_s() == 0.0; }

}  // namespace

std::optional<SampledPeriod> sampled_period(const SimulationInputs& inputs,
                                            std::span<const double> times_s, bool reversible,
                                            std::optional<double> tick_s) {
  const std::optional<double> period_s = inputs.drive.period_s();
  if (!period_s || *period_s == 0.0 || !constant(inputs.external_load) ||
      !constant(inputs.supply_pressure_pa) || !constant(inputs.tank_pressure_pa) ||
      !constant(inputs.base_acceleration_m_per_s2) || !constant(inputs.oil_temperature_k) ||
      inputs.spool_error)
    return std::nullopt;
  const double same_s = same_instant_s(times_s);
  const Eigen::Map<const Eigen::ArrayXd> times(times_s.data(), std::ssize(times_s));
  const bool by_halves = reversible && inputs.drive.reverses();
  for (int halves = by_halves ? 1 : 2; halves <= 2 * kMostPeriods; halves += by_halves ? 1 : 2) {
    const double duration_s = 0.5 * halves * *period_s;
    const auto next =
        std::lower_bound(times_s.begin(), times_s.end(), times_s.front() + duration_s - same_s);
    if (next == times_s.end()) return std::nullopt;
    if (tick_s && std::abs(std::remainder(duration_s, *tick_s)) > same_s) continue;
    const auto samples = next - times_s.begin();
    const Eigen::Index later = times.size() - samples;
    const auto excess = (times.tail(later) - times.head(later) - duration_s).abs();
    // Checks the last difference first, because it usually decides.
    if (excess(later - 1) <= same_s && excess.maxCoeff() <= same_s)
      return SampledPeriod{duration_s, static_cast<std::size_t>(samples), halves % 2 == 1};
  }
  return std::nullopt;
}

}  // namespace rigcal::model
