#include "calib/lack_of_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>

namespace rigcal::calib {
namespace {

constexpr double kMisfitLevel = 0.05;
constexpr int kLongestMemory = 5000;
/// Effective share of the residuals from which on correlation is worth a word.
constexpr double kCorrelated = 0.5;

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
  namespace bm = boost::math;
  if (!(test.ratio > 0.0)) return 1.0;
  if (std::isinf(test.pure_freedom)) {
    const bm::chi_squared distribution(test.freedom);
    return bm::cdf(bm::complement(distribution, test.ratio * test.freedom));
  }
  const bm::fisher_f distribution(test.freedom, test.pure_freedom);
  return bm::cdf(bm::complement(distribution, test.ratio));
}

const LackOfFit* least_likely(const std::vector<LackOfFit>& tests) {
  const auto found = std::min_element(tests.begin(), tests.end(),
                                      [](const auto& a, const auto& b) { return a.p < b.p; });
  return found == tests.end() ? nullptr : &*found;
}

}  // namespace

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

std::string interval_advice(const Problem& problem, const Uncertainty& found,
                            const std::vector<LackOfFit>& tests) {
  if (found.scatter.empty()) {
    return "only the plain standard errors exist: too few residuals to tell their correlation, or "
           "a record that could not be simulated again";
  }
  const double residuals = static_cast<double>(problem.residual_count());
  const double share = found.effective_samples / residuals;
  std::string text =
      share < kCorrelated
          ? fmt::format(
                "residuals are correlated in time: {:.0f} of them count as {:.0f} "
                "independent ones, so believe the robust errors; the plain ones are too "
                "small",
                residuals, found.effective_samples)
          : std::string(
                "residuals are all but uncorrelated in time: robust and plain errors agree "
                "where the noise is even");
  const auto flagged = misfit(tests);
  if (!flagged) {
    return text +
           "; neither repeats nor `sd` tell the noise, so errors of the model and noise "
           "cannot be told apart";
  }
  const LackOfFit& test = *least_likely(tests);
  const std::string against = test.by_repeats ? "the scatter of the repeats" : "the stated `sd`";
  if (*flagged) {
    return text + fmt::format(
                      "; the model leaves more than noise (condition \"{}\", {}: variance {:.3g} "
                      "times that of {}, p = {:.2g}): intervals hold for the values that fit this "
                      "model best to these signals, and other signals may ask for others",
                      test.condition, datasets::info(test.channel).key, test.ratio, against,
                      test.p);
  }
  return text + fmt::format("; what the model leaves is no more than {} (least p = {:.2g} of {})",
                            against, test.p, tests.size());
}

}  // namespace rigcal::calib
