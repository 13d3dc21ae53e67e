#include "metrics/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "metrics/metric_table.hpp"
#include "metrics/moments.hpp"

namespace rigcal::metrics {
namespace {

static_assert(sizeof(Agreement) == kMetrics.size() * sizeof(double),
              "a member of Agreement has no row in the table, or a row no member");

/// Number of rows at the top of the table that agreement() computes together.
constexpr std::size_t kOfMoments = 7;
static_assert(kMetrics.size() >= kOfMoments && kMetrics[kOfMoments - 1].name == "maximum_error",
              "a separate metric must have its row below those that agreement() computes together");

using Signal = std::span<const double>;

/// Quantities from which all metrics are computed. Each metric is a formula of these, so that
/// agreement() and the separate functions cannot differ.
struct Moments {
  Range measured;
  Range simulated;
  Extended variance_measured = 0.0L;
  Extended variance_simulated = 0.0L;
  Extended variance_residual = 0.0L;
  Extended covariance = 0.0L;
  Extended mean_residual = 0.0L;
  Extended mean_absolute_residual = 0.0L;
  Extended mean_square_residual = 0.0L;
  Extended maximum_residual = 0.0L;
};

Moments moments(Signal measured, Signal simulated, std::string_view function) {
  if (measured.size() != simulated.size())
    throw std::invalid_argument(
        fmt::format("{}: the measured signal has {} samples and the simulated one {}, expected as "
                    "many",
                    function, measured.size(), simulated.size()));
  Moments m;
  m.measured = finite_range(measured, function, "measured");
  m.simulated = finite_range(simulated, function, "simulated");

  const std::size_t n = measured.size();
  const Centred y(measured);
  const Centred s(simulated);
  m.variance_measured = y.variance();
  m.variance_simulated = s.variance();
  m.covariance = mean_of(n, [&](auto i) { return y[i] * s[i]; });

  // If the residual is much smaller than the signals, the difference y[i] - s[i] would show the
  // rounding of the two means. Differences from the first samples are exact for similar signals.
  const Extended mean_from_first = y.mean_from_first() - s.mean_from_first();
  m.variance_residual = mean_of(
      n, [&](auto i) { return square((y.from_first(i) - s.from_first(i)) - mean_from_first); });
  m.mean_residual = (wide(measured.front()) - wide(simulated.front())) + mean_from_first;

  const auto residual = [&](std::size_t i) { return wide(measured[i]) - wide(simulated[i]); };
  m.mean_absolute_residual = mean_of(n, [&](auto i) { return std::abs(residual(i)); });
  m.mean_square_residual = mean_of(n, [&](auto i) { return square(residual(i)); });
  for (std::size_t i = 0; i < n; ++i)
    m.maximum_residual = std::max(m.maximum_residual, std::abs(residual(i)));
  return m;
}

void require_varying(const Range& range, std::string_view metric, std::string_view name) {
  if (range.constant())
    throw std::domain_error(
        fmt::format("{}: the {} signal is constant (every sample is {}), expected one that varies",
                    metric, name, range.low));
}

double unexplained_variance(const Moments& m) {
  require_varying(m.measured, "unexplained_variance", "measured");
  return to_double(m.variance_residual / m.variance_measured, "unexplained_variance");
}

double rho2(const Moments& m) {
  require_varying(m.measured, "rho2", "measured");
  // A constant cannot explain any variance. Without this line, rounding would decide the last bit.
  if (m.simulated.constant()) return 0.0;
  return to_double(1.0L - m.variance_residual / m.variance_measured, "rho2");  // Eq. 15
}

double correlation(const Moments& m) {
  require_varying(m.measured, "correlation", "measured");
  require_varying(m.simulated, "correlation", "simulated");
  const Extended r =
      m.covariance / (std::sqrt(m.variance_measured) * std::sqrt(m.variance_simulated));  // Eq. 16
  return static_cast<double>(std::clamp(r, -1.0L, 1.0L));
}

double concordance(const Moments& m) {
  require_varying(m.measured, "concordance", "measured");
  const Extended ccc =
      2.0L * m.covariance /
      (m.variance_measured + m.variance_simulated + square(m.mean_residual));  // Eq. 17
  return static_cast<double>(std::clamp(ccc, -1.0L, 1.0L));
}

double absolute_error_percent(const Moments& m) {
  require_varying(m.measured, "absolute_error_percent", "measured");
  return to_double(100.0L * m.mean_absolute_residual / m.measured.peak_to_peak(),
                   "absolute_error_percent");
}

double rmse(const Moments& m) { return to_double(std::sqrt(m.mean_square_residual), "rmse"); }

double nrmse_fit_percent(const Moments& m) {
  require_varying(m.measured, "nrmse_fit_percent", "measured");
  return to_double(
      100.0L * (1.0L - std::sqrt(m.mean_square_residual) / std::sqrt(m.variance_measured)),
      "nrmse_fit_percent");
}

double maximum_error(const Moments& m) { return to_double(m.maximum_residual, "maximum_error"); }

}  // namespace

double rho2(Signal m, Signal s) { return rho2(moments(m, s, "rho2")); }
double unexplained_variance(Signal m, Signal s) {
  return unexplained_variance(moments(m, s, "unexplained_variance"));
}
double correlation(Signal m, Signal s) { return correlation(moments(m, s, "correlation")); }
double concordance(Signal m, Signal s) { return concordance(moments(m, s, "concordance")); }
double absolute_error_percent(Signal m, Signal s) {
  return absolute_error_percent(moments(m, s, "absolute_error_percent"));
}
double rmse(Signal m, Signal s) { return rmse(moments(m, s, "rmse")); }
double nrmse_fit_percent(Signal m, Signal s) {
  return nrmse_fit_percent(moments(m, s, "nrmse_fit_percent"));
}
double maximum_error(Signal m, Signal s) { return maximum_error(moments(m, s, "maximum_error")); }

Agreement agreement(Signal measured, Signal simulated) {
  const Moments m = moments(measured, simulated, "agreement");
  Agreement all{.rho2 = rho2(m),
                .r = correlation(m),
                .ccc = concordance(m),
                .absolute_error_percent = absolute_error_percent(m),
                .rmse = rmse(m),
                .nrmse_fit_percent = nrmse_fit_percent(m),
                .maximum_error = maximum_error(m)};
  // Metrics that do not follow from the moments are computed one by one.
  for (std::size_t i = kOfMoments; i < kMetrics.size(); ++i)
    all.*kMetrics[i].value = kMetrics[i].compute(measured, simulated);
  return all;
}

double allowed_rms(std::span<const double> measured, double rho2_limit) {
  if (measured.size() < 2 || !(rho2_limit < 1.0)) return 0.0;
  finite_range(measured, "allowed_rms", "measured");
  return to_double(std::sqrt((1.0L - wide(rho2_limit)) * Centred(measured).variance()),
                   "allowed_rms");
}

}  // namespace rigcal::metrics
