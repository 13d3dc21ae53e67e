#include "metrics/fundamental.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "metrics/moments.hpp"

namespace rigcal::metrics {
namespace {

using Vector3 = Eigen::Matrix<Extended, 3, 1>;
using Matrix3 = Eigen::Matrix<Extended, 3, 3>;

void check(std::span<const double> time_s, std::span<const double> signal, std::string_view name,
           double frequency_hz) {
  if (time_s.size() != signal.size())
    throw std::invalid_argument(fmt::format(
        "fundamental: {} sample times and {} samples of the {} signal, expected as many",
        time_s.size(), signal.size(), name));
  if (signal.size() < 4)
    throw std::invalid_argument(fmt::format(
        "fundamental: the {} signal has {} samples, expected at least 4", name, signal.size()));
  if (!std::isfinite(frequency_hz) || frequency_hz <= 0.0)
    throw std::invalid_argument(fmt::format(
        "fundamental: the frequency is {} Hz, expected a positive finite one", frequency_hz));
  require_increasing(time_s, "fundamental");
}

/// Index of the first sample in the whole periods at the end of the record.
std::size_t window_begin(std::span<const double> time_s, double frequency_hz) {
  const double last = time_s.back();
  const double span = last - time_s.front();
  const double mean_step = span / static_cast<double>(time_s.size() - 1);
  // Times read from a file are rounded, so a sample within a thousandth of a step of the limit
  // counts as on it.
  const double slack = 1e-3 * mean_step;
  const double covered_periods = (span + mean_step + slack) * frequency_hz;
  if (covered_periods < 1.0)
    throw std::invalid_argument(
        fmt::format("fundamental: the record covers {} s, expected at least one period of {} s",
                    span + mean_step, 1.0 / frequency_hz));
  double periods = std::floor(covered_periods);
  if (periods >= 3.0) periods -= 1.0;
  const double begin = last - periods / frequency_hz + slack;
  return static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), begin) -
                                  time_s.begin());
}

/// Returns sin, cos and 1 at time t. Removes whole turns first, so that multiplying by 2 pi does
/// not round them.
Vector3 regressors(double time_s, double frequency_hz) {
  const Extended turns = wide(time_s) * wide(frequency_hz);
  const auto angle =
      static_cast<double>(2.0L * std::numbers::pi_v<Extended> * (turns - std::floor(turns)));
  return {wide(std::sin(angle)), wide(std::cos(angle)), 1.0L};
}

/// Quantities that depend only on the times, so that all signals of one record share them.
struct Basis {
  std::vector<Vector3> rows;
  Matrix3 normal = Matrix3::Zero();
  Vector3 eigenvalues;

  Basis(std::span<const double> time_s, double frequency_hz) {
    rows.reserve(time_s.size());
    for (const double t : time_s) {
      rows.push_back(regressors(t, frequency_hz));
      normal += rows.back() * rows.back().transpose();
    }
    eigenvalues =
        Eigen::SelfAdjointEigenSolver<Matrix3>(normal, Eigen::EigenvaluesOnly).eigenvalues();
  }
};

/// @param basis  for the same times and frequency; if empty, it is computed when needed
Fundamental fit(std::span<const double> time_s, std::span<const double> signal,
                std::string_view name, double frequency_hz, std::optional<Basis>& basis) {
  check(time_s, signal, name, frequency_hz);
  const Range range = finite_range(signal, "fundamental", name);
  const std::size_t begin = window_begin(time_s, frequency_hz);
  const std::size_t n = signal.size() - begin;
  if (n < 4)
    throw std::invalid_argument(
        fmt::format("fundamental: {} samples of the {} signal are in whole periods of {} s, "
                    "expected at least 4",
                    n, name, 1.0 / frequency_hz));
  if (range.constant()) return {};

  if (!basis) basis.emplace(time_s.subspan(begin), frequency_hz);
  Vector3 right = Vector3::Zero();
  for (std::size_t i = 0; i < n; ++i) {
    // The offset belongs to c, but it would cost precision in a and b.
    right += basis->rows[i] * (wide(signal[begin + i]) - wide(signal[begin]));
  }
  if (basis->eigenvalues[0] < 1e-9L * basis->eigenvalues[2])
    throw std::invalid_argument(
        fmt::format("fundamental: the {} samples of the {} signal in whole periods of {} s cannot "
                    "separate this frequency from an offset, expected more per period",
                    n, name, 1.0 / frequency_hz));
  const Vector3 solution = basis->normal.ldlt().solve(right);
  const Extended amplitude = std::hypot(solution[0], solution[1]);
  // Such an amplitude is only rounding, but its phase would look real.
  if (amplitude < 1e-12L * range.peak_to_peak()) return {};
  return {.amplitude = to_double(amplitude, "fundamental"),
          .phase_rad = static_cast<double>(std::atan2(solution[1], solution[0]))};
}

Fundamental existing_fundamental(std::span<const double> time_s, std::span<const double> signal,
                                 std::string_view name, double frequency_hz,
                                 std::optional<Basis>& basis) {
  const Fundamental result = fit(time_s, signal, name, frequency_hz, basis);
  if (result.amplitude == 0.0)
    throw std::domain_error(fmt::format(
        "fundamental: the {} signal has no component at {} Hz, so that neither gain nor "
        "phase exists",
        name, frequency_hz));
  return result;
}

}  // namespace

Fundamental fundamental(std::span<const double> time_s, std::span<const double> signal,
                        double frequency_hz) {
  std::optional<Basis> basis;
  return fit(time_s, signal, "given", frequency_hz, basis);
}

FundamentalComparison compare_fundamentals(std::span<const double> time_s,
                                           std::span<const double> measured,
                                           std::span<const double> simulated, double frequency_hz) {
  std::optional<Basis> basis;
  const Fundamental from = existing_fundamental(time_s, measured, "measured", frequency_hz, basis);
  const Fundamental to = existing_fundamental(time_s, simulated, "simulated", frequency_hz, basis);
  const double phase_rad = std::remainder(to.phase_rad - from.phase_rad, 2.0 * std::numbers::pi);
  double phase_deg = phase_rad * 180.0 / std::numbers::pi;
  if (phase_deg <= -180.0) phase_deg = 180.0;
  return {.gain_ratio = to_double(wide(to.amplitude) / wide(from.amplitude), "fundamental"),
          .phase_deg = phase_deg,
          .delay_s = -phase_deg / (360.0 * frequency_hz)};
}

}  // namespace rigcal::metrics
