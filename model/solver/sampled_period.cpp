#include "model/solver/sampled_period.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "model/signal/same_instant.hpp"

namespace rigcal::model {
namespace {

/// Largest number of drive periods to try. With a drive at 3 Hz and samples at 1 kHz, the samples
/// repeat after three periods.
constexpr int kMostPeriods = 20;

constexpr double kAlways = -std::numeric_limits<double>::infinity();

bool constant(const std::optional<Signal>& signal) { return !signal || signal->period_s() == 0.0; }

/// Returns the time from which a signal has the same value `duration_s` later, or the opposite one;
/// std::nullopt if there is none.
std::optional<double> repeats_from(const std::optional<Signal>& signal, double duration_s,
                                   bool reversed, double same_s) {
  if (!signal || (constant(signal) && !reversed)) return kAlways;
  const std::optional<Repetition>& known = signal->repetition();
  if (!known) return std::nullopt;
  const double times = std::round(duration_s / known->period_s);
  if (times < 1.0 || std::abs(duration_s - times * known->period_s) > same_s) return std::nullopt;
  const bool odd = std::fmod(times, 2.0) == 1.0;
  if ((known->reversed && odd) != reversed) return std::nullopt;
  return known->from_s;
}

}  // namespace

std::optional<SampledPeriod> sampled_period(const SimulationInputs& inputs,
                                            std::span<const double> times_s, bool reversible,
                                            std::optional<double> tick_s) {
  const std::optional<double> period_s = inputs.drive.period_s();
  if (!period_s || *period_s == 0.0 || !constant(inputs.external_load) ||
      !constant(inputs.tank_pressure_pa) || !constant(inputs.base_acceleration_m_per_s2) ||
      !constant(inputs.oil_temperature_k))
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
    // Reversed inputs do not reverse the supply.
    const bool reversed = halves % 2 == 1;
    const auto supply = repeats_from(inputs.supply_pressure_pa, duration_s, false, same_s);
    const auto spool = repeats_from(inputs.spool_error, duration_s, reversed, same_s);
    if (!supply || !spool) continue;
    const auto samples = next - times_s.begin();
    const Eigen::Index later = times.size() - samples;
    const auto excess = (times.tail(later) - times.head(later) - duration_s).abs();
    // Checks the last difference first, because it usually decides.
    if (excess(later - 1) <= same_s && excess.maxCoeff() <= same_s)
      return SampledPeriod{duration_s, static_cast<std::size_t>(samples), reversed,
                           std::max(0.0, std::max(*supply, *spool) - times_s.front())};
  }
  return std::nullopt;
}

}  // namespace rigcal::model
