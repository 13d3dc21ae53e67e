#include "calib/trust/lack_of_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/trust/sandwich.hpp"
#include "metrics/distributions.hpp"
#include "metrics/significance.hpp"

namespace rigcal::calib {
namespace {

/// A test may pass only if it could have detected this variance ratio, a residual twice as large as
/// the noise.
constexpr double kLargestUsefulRatio = 4.0;

/// Returns 1 + 2 sum rho_h^2, the factor by which correlation reduces the degrees of freedom of a
/// sum of squares.
double square_inflation(const metrics::Autoregression& noise, double samples) {
  if (noise.phi.empty()) return 1.0;
  const int lags = std::min(metrics::kLongestMemory, static_cast<int>(samples) - 1);
  const auto gamma = metrics::autocovariance(noise, lags);
  double sum = 1.0;
  for (std::size_t h = 1; h < gamma.size(); ++h)
    sum += 2.0 * (gamma[h] / gamma[0]) * (gamma[h] / gamma[0]);
  return sum;
}

/// Returns the probability that noise alone gives this ratio or a larger one.
double exceedance(double ratio, const LackOfFit& test) {
  if (!(ratio > 0.0)) return 1.0;
  if (std::isinf(test.pure_error_freedom))
    return metrics::chi_squared_exceedance(ratio * test.freedom, test.freedom);
  return metrics::fisher_f_exceedance(ratio, test.freedom, test.pure_error_freedom);
}

/// Judges a test at a significance level. The level of the F test is valid even for few degrees of
/// freedom, so a rejection always counts. A test passes only if it would have rejected
/// kLargestUsefulRatio.
metrics::Judged judged(const LackOfFit& test, double level) {
  using metrics::TestOutcome;
  if (test.p < level) return {TestOutcome::failed, {}};
  if (exceedance(kLargestUsefulRatio, test) < level) return {TestOutcome::passed, {}};
  return {TestOutcome::not_judged,
          fmt::format("a residual variance of {:.0f} times the noise would not be detected "
                      "({:.1f} effective degrees of freedom)",
                      kLargestUsefulRatio, test.freedom)};
}

/// @param noise  model of the weighted residual; its variance is the ratio
LackOfFit make_test(const ProblemCondition& condition, const ProblemChannel& channel,
                    const metrics::Autoregression& noise, double samples) {
  const datasets::Series& series = condition.record->channels.at(channel.channel);
  LackOfFit test;
  test.condition = condition.condition->id;
  test.channel = channel.channel;
  test.against = series.repeats > 1 && !series.sd.empty() ? "repeats" : "sd";
  test.ratio = metrics::autocovariance(noise, 0).front();
  test.freedom = std::max(1.0, samples / square_inflation(noise, samples));
  test.pure_error_freedom = test.by_repeats() ? (series.repeats - 1) * test.freedom
                                              : std::numeric_limits<double>::infinity();
  test.p = exceedance(test.ratio, test);
  return test;
}

}  // namespace

double detectable_error(const LackOfFit& test, double level) {
  // With the many degrees of freedom of a stated noise, F becomes a chi-square distribution.
  const double freedom = std::min(test.pure_error_freedom, metrics::kManyDegrees);
  const double ratio = metrics::fisher_f_upper_quantile(level, test.freedom, freedom);
  return std::sqrt(std::max(0.0, ratio - 1.0));
}

const LackOfFit* least_likely(const std::vector<LackOfFit>& tests) {
  const auto found = std::min_element(tests.begin(), tests.end(),
                                      [](const auto& a, const auto& b) { return a.p < b.p; });
  return found == tests.end() ? nullptr : &*found;
}

void judge_together(std::vector<LackOfFit>& tests) {
  const double level =
      metrics::kWarningLevel / static_cast<double>(tests.size());  // Bonferroni correction
  for (LackOfFit& test : tests) static_cast<metrics::Judged&>(test) = judged(test, level);
}

std::optional<LackOfFit> lack_of_prediction(const ProblemCondition& condition,
                                            const ProblemChannel& channel,
                                            std::span<const double> residual) {
  if (!channel.sd_known) return std::nullopt;
  std::vector<double> weighted;
  for (const double each : residual) weighted.push_back(each / channel.sd);
  const auto samples = static_cast<double>(weighted.size());
  const int lags = std::min<int>(kMostLags, static_cast<int>(weighted.size() / 10));
  const auto gamma = metrics::autocovariance(weighted, lags);
  if (!(gamma.front() > 0.0)) return std::nullopt;
  return make_test(condition, channel, metrics::fit_autoregression(gamma, samples), samples);
}

std::vector<LackOfFit> lack_of_fit(const Problem& problem, const Uncertainty& found) {
  std::vector<LackOfFit> result;
  for (std::size_t i = 0; i < found.scatter.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      const ProblemChannel& channel = condition.channels[k];
      if (!channel.sd_known) continue;
      result.push_back(make_test(condition, channel, found.scatter[i].noise[k],
                                 static_cast<double>(condition.rows.size())));
    }
  }
  judge_together(result);
  return result;
}

std::optional<bool> misfit(const std::vector<LackOfFit>& tests) {
  bool all = !tests.empty();
  for (const LackOfFit& test : tests) {
    if (test.failed()) return true;
    all = all && test.passed();
  }
  return all ? std::optional(false) : std::nullopt;
}

}  // namespace rigcal::calib
