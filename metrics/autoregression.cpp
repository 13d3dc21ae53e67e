#include "metrics/autoregression.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rigcal::metrics {
namespace {

/// One step of the Levinson-Durbin recursion.
std::vector<double> extended(const std::vector<double>& phi, double partial) {
  std::vector<double> next(phi.size() + 1);
  for (std::size_t k = 0; k < phi.size(); ++k) next[k] = phi[k] - partial * phi[phi.size() - 1 - k];
  next.back() = partial;
  return next;
}

/// Returns the next partial autocorrelation, given a model of the first autocovariances.
double next_partial(const Autoregression& model, std::span<const double> gamma) {
  const std::size_t m = model.phi.size();
  double unexplained = gamma[m + 1];
  for (std::size_t k = 0; k < m; ++k) unexplained -= model.phi[k] * gamma[m - k];
  return unexplained / model.variance;
}

void extend(Autoregression& model, double partial) {
  model.phi = extended(model.phi, partial);
  model.variance *= 1.0 - partial * partial;
}

/// Computes the partial autocorrelations of a model by running the recursion backwards.
std::vector<double> partials(std::vector<double> phi) {
  std::vector<double> result(phi.size());
  for (std::size_t m = phi.size(); m-- > 0;) {
    const double partial = phi[m];
    result[m] = partial;
    std::vector<double> shorter(m);
    for (std::size_t k = 0; k < m; ++k)
      shorter[k] = (phi[k] + partial * phi[m - 1 - k]) / (1.0 - partial * partial);
    phi = std::move(shorter);
  }
  return result;
}

}  // namespace

double Autoregression::effective_samples(double samples) const {
  if (phi.empty() || !(variance > 0.0)) return samples;
  const double gain = 1.0 - std::accumulate(phi.begin(), phi.end(), 0.0);
  const double long_run = variance / (gain * gain);
  const double sample_variance = autocovariance(*this, 0).front();
  return std::clamp(samples * sample_variance / long_run, 1.0, std::max(samples, 1.0));
}

std::vector<double> autocovariance(std::span<const double> series, int lags) {
  std::vector<double> gamma(static_cast<std::size_t>(lags) + 1, 0.0);
  for (std::size_t h = 0; h < gamma.size() && h < series.size(); ++h) {
    double sum = 0.0;
    for (std::size_t t = 0; t + h < series.size(); ++t) sum += series[t] * series[t + h];
    gamma[h] = sum / static_cast<double>(series.size());
  }
  return gamma;
}

std::vector<double> autocovariance(const Autoregression& model, int lags) {
  // Levinson-Durbin in reverse: the models in the recursion give one lag after another.
  const std::vector<double> partial = partials(model.phi);
  double variance = model.variance;
  for (const double each : partial) variance /= 1.0 - each * each;
  std::vector<double> gamma{variance};
  std::vector<double> phi;
  for (std::size_t m = 0; m < partial.size(); ++m) {
    double next = partial[m] * variance;
    for (std::size_t k = 0; k < phi.size(); ++k) next += phi[k] * gamma[m - k];
    gamma.push_back(next);
    variance *= 1.0 - partial[m] * partial[m];
    phi = extended(phi, partial[m]);
  }
  while (gamma.size() <= static_cast<std::size_t>(lags)) {
    double next = 0.0;
    for (std::size_t k = 0; k < phi.size(); ++k) next += phi[k] * gamma[gamma.size() - 1 - k];
    gamma.push_back(next);
  }
  gamma.resize(static_cast<std::size_t>(lags) + 1);
  return gamma;
}

std::vector<double> partial_autocorrelations(std::span<const double> gamma) {
  std::vector<double> result;
  if (gamma.empty() || !(gamma.front() > 0.0)) return result;
  Autoregression model{{}, gamma.front()};
  while (model.phi.size() + 1 < gamma.size()) {
    const double partial = next_partial(model, gamma);
    if (!(std::abs(partial) < 1.0)) break;
    extend(model, partial);
    result.push_back(partial);
  }
  return result;
}

bool is_autocovariance(std::span<const double> gamma) {
  if (gamma.empty() || !(gamma.front() > 0.0)) return false;
  return partial_autocorrelations(gamma).size() + 1 == gamma.size();
}

Autoregression fit_autoregression(std::span<const double> gamma, double samples) {
  constexpr double kMemory = 10.0;  // minimum ratio of the record's length to the model's memory
  if (gamma.empty() || !(gamma.front() > 0.0)) return {};
  const double most = std::max(0.0, 1.0 - kMemory / samples);
  Autoregression model{{}, gamma.front()};
  Autoregression best = model;
  double least = samples * std::log(model.variance);
  while (model.phi.size() + 1 < gamma.size()) {
    const double partial = next_partial(model, gamma);
    // Real series do not get here. A series that repeats exactly does, after a partial
    // autocorrelation has been limited. All further ones would be limited, too, and would give a
    // model whose response grows without bound.
    if (!model.phi.empty() && !(std::abs(partial) < 1.0)) break;
    extend(model, std::clamp(partial, -most, most));
    const double criterion = samples * std::log(model.variance) +
                             static_cast<double>(model.phi.size()) * std::log(samples);
    if (criterion < least) {
      least = criterion;
      best = model;
    }
  }
  return best;
}

}  // namespace rigcal::metrics
