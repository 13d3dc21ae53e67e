#include "calib/lack_of_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

constexpr double kMisfitLevel = 0.05;
constexpr int kLongestMemory = 5000;

/// 1 + 2 sum rho_h^2: by how much correlation thins a sum of squares out.
double square_inflation(const metrics::Autoregression& noise, double samples) {
  if (noise.phi.empty()) return 1.0;
  const int lags = std::min(kLongestMemory, static_cast<int>(samples) - 1);
  const auto gamma = metrics::autocovariance(noise, lags);
  double sum = 1.0;
  for (std::size_t h = 1; h < gamma.size(); ++h)
    sum += 2.0 * (gamma[h] / gamma[0]) * (gamma[h] / gamma[0]);
  return sum;
}

double exceedance(const LackOfFit& test) {
  if (!(test.ratio > 0.0)) return 1.0;
  if (std::isinf(test.pure_freedom))
    return metrics::chi_squared_exceedance(test.ratio * test.freedom, test.freedom);
  return metrics::fisher_f_exceedance(test.ratio, test.freedom, test.pure_freedom);
}

}  // namespace

const LackOfFit* least_likely(const std::vector<LackOfFit>& tests) {
  const auto found = std::min_element(tests.begin(), tests.end(),
                                      [](const auto& a, const auto& b) { return a.p < b.p; });
  return found == tests.end() ? nullptr : &*found;
}

std::vector<LackOfFit> lack_of_fit(const Problem& problem, const Uncertainty& found) {
  std::vector<LackOfFit> result;
  for (std::size_t i = 0; i < found.scatter.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      const ProblemChannel& channel = condition.channels[k];
      if (!channel.sd_known) continue;
      const metrics::Autoregression& noise = found.scatter[i].noise[k];
      const auto samples = static_cast<double>(condition.rows.size());
      const datasets::Series& series = condition.record->channels.at(channel.channel);
      LackOfFit test;
      test.condition = condition.condition->id;
      test.channel = channel.channel;
      test.by_repeats = series.repeats > 1 && !series.sd.empty();
      test.ratio = metrics::autocovariance(noise, 0).front();
      test.freedom = std::max(1.0, samples / square_inflation(noise, samples));
      test.pure_freedom = test.by_repeats ? (series.repeats - 1) * test.freedom
                                          : std::numeric_limits<double>::infinity();
      test.p = exceedance(test);
      result.push_back(std::move(test));
    }
  }
  return result;
}

std::optional<bool> misfit(const std::vector<LackOfFit>& tests) {
  const LackOfFit* least = least_likely(tests);
  if (least == nullptr) return std::nullopt;
  return least->p * static_cast<double>(tests.size()) < kMisfitLevel;
}

}  // namespace rigcal::calib
