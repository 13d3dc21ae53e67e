#include "report/store/stored/stored_residual_tests.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "common/significant.hpp"
#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using metrics::ResidualTests;

std::string hertz(double value) { return fmt::format("{:.3g} Hz", value); }

std::string not_judged(const metrics::Judged& test) {
  return "cannot be judged: " + test.reason.value_or("");
}

std::string autocorrelation_words(const ResidualTests& tests) {
  const auto& test = tests.autocorrelation;
  const std::string p = p_value_text(test.p_value);
  if (test.passed()) return fmt::format("no significant autocorrelation ({})", p);
  if (!test.failed()) return not_judged(test);
  constexpr double kNoLoss = 0.99;
  if (tests.effective_samples > kNoLoss * static_cast<double>(tests.samples))
    return fmt::format("weak but significant ({}): no loss of effective sample size", p);
  return fmt::format(
      "significant ({}) up to a lag of {}: effective sample size {:.0f} of {}; unmodelled "
      "dynamics, "
      "or noise that is not white",
      p, readable(test.correlation_time_s, "s", 2), std::floor(tests.effective_samples),
      tests.samples);
}

std::string cross_correlation_words(const metrics::CrossCorrelation& test) {
  const std::string peak =
      fmt::format("largest correlation {:.2g}, 95 % bound {:.2g}", std::abs(test.peak), test.limit);
  if (test.passed()) return fmt::format("not significantly correlated with the input: {}", peak);
  if (!test.failed()) return not_judged(test);
  return fmt::format(
      "{:.0f} % of the residual variance is linearly explained by the input (correlation {:.2g} at "
      "a lag of {}, 95 % bound {:.2g}): unmodelled dynamics, or a wrong parameter",
      100.0 * test.peak * test.peak, test.peak, readable(test.peak_lag_s, "s", 2), test.limit);
}

std::string periodogram_words(const metrics::Periodogram& test) {
  if (test.passed()) return "consistent with a flat spectrum (white noise)";
  if (!test.failed()) return not_judged(test);
  std::string text =
      fmt::format("not flat: half of the power is below {}", hertz(test.median_frequency_hz));
  if (test.peak_share >= 0.1) {
    text += fmt::format(", {:.0f} % at {}", 100.0 * test.peak_share, hertz(test.peak_frequency_hz));
  }
  return text;
}

std::string normality_words(const metrics::Normality& test) {
  if (test.passed())
    return fmt::format("consistent with a normal distribution ({})", p_value_text(test.p_value));
  if (!test.failed()) return not_judged(test);
  std::string text = fmt::format("not normal ({})", p_value_text(test.p_value));
  if (test.excess_kurtosis > 0.5) text += ", heavy tails or rare bursts";
  if (test.excess_kurtosis < -0.5) text += ", light tails, as those of a sine wave";
  if (std::abs(test.skewness) > 0.3)
    text += test.skewness > 0.0 ? ", skewed to the right" : ", skewed to the left";
  return text;
}

/// @param unit  SI unit of the residual
std::string drift_words(const ResidualTests& tests, std::string_view unit) {
  const auto& test = tests.drift;
  if (test.passed()) return "no significant offset or trend";
  if (!test.failed()) return not_judged(test);
  const double span =
      test.slope_per_s * tests.sample_interval_s * static_cast<double>(tests.samples);
  return fmt::format("offset {} ({}), trend {} over the record ({})", readable(test.mean, unit, 3),
                     p_value_text(test.mean_p_value), readable(span, unit, 3),
                     p_value_text(test.slope_p_value));
}

template <typename Test>
Worded<Test> worded(const Test& test, std::string words) {
  Worded<Test> result;
  static_cast<Test&>(result) = test;
  result.verdict = std::move(words);
  if (test.outcome != metrics::TestOutcome::not_judged) result.has_passed = test.passed();
  return result;
}

/// Keeps every k-th value, so that about 200 values or fewer remain. The value at lag zero is kept.
///
/// @param centre  index of lag zero
StoredCorrelogram thinned(const std::vector<double>& values, std::size_t centre, double band,
                          double sample_interval_s) {
  constexpr std::size_t kMost = 200;
  const std::size_t stride = values.size() / kMost + 1;
  StoredCorrelogram result;
  result.first_lag_s =
      (static_cast<double>(centre % stride) - static_cast<double>(centre)) * sample_interval_s;
  result.lag_step_s = static_cast<double>(stride) * sample_interval_s;
  result.band = band;
  for (std::size_t i = centre % stride; i < values.size(); i += stride)
    result.values.push_back(values[i]);
  return result;
}

StoredResidualCurves curves_of(const metrics::ResidualTests& tests) {
  StoredResidualCurves curves;
  curves.autocorrelation =
      thinned(tests.autocorrelation.values, 0, tests.autocorrelation.band, tests.sample_interval_s);
  if (const auto& cross = tests.cross_correlation) {
    curves.cross_correlation =
        thinned(cross->values, cross->values.size() / 2, cross->band, tests.sample_interval_s);
    curves.cross_correlation->band_of_peak = cross->limit;
  }
  curves.periodogram = {tests.periodogram.frequency_hz, tests.periodogram.density};
  curves.normality = {tests.normality.normal_quantile, tests.normality.residual_quantile};
  // Not thinned: the order of a model is the number of the last lag beyond the band.
  StoredCorrelogram partial;
  partial.first_lag_s = partial.lag_step_s = tests.sample_interval_s;
  partial.band = tests.autocorrelation.band;
  partial.values = tests.autocorrelation.partial;
  curves.partial_autocorrelation = std::optional(std::move(partial));
  curves.cumulative_periodogram = std::optional(StoredCumulative{
      tests.periodogram.last_frequency_hz, tests.periodogram.limit, tests.periodogram.cumulative});
  return curves;
}

}  // namespace

StoredResidualTests stored(const metrics::ResidualTests& tests, std::string_view unit) {
  StoredResidualTests result;
  result.samples = tests.samples;
  result.sample_interval_s = tests.sample_interval_s;
  result.std = tests.std;
  result.effective_samples = tests.effective_samples;
  result.autocorrelation = worded(tests.autocorrelation, autocorrelation_words(tests));
  if (const auto& cross = tests.cross_correlation)
    result.cross_correlation = worded(*cross, cross_correlation_words(*cross));
  result.periodogram = worded(tests.periodogram, periodogram_words(tests.periodogram));
  result.normality = worded(tests.normality, normality_words(tests.normality));
  result.drift = worded(tests.drift, drift_words(tests, unit));
  return result;
}

StoredCurves stored_curves(const Result& result) {
  StoredCurves curves;
  curves.status = status_of(result.fit);
  curves.of = result.kind == ResultKind::fit ? kFitSchema : kValidationSchema;
  for (const calib::ConditionScore& score : result.fit.conditions) {
    StoredChannelCurves& channels =
        curves.conditions.emplace_back(score.id, StoredChannelCurves()).second;
    for (const calib::ChannelScore& channel : score.channels) {
      std::optional<StoredResidualCurves> found;
      if (channel.residual_tests) found = curves_of(*channel.residual_tests);
      channels.emplace_back(info(channel.channel).key, std::move(found));
    }
  }
  return curves;
}

}  // namespace rigcal::report
