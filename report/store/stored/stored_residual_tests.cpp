#include "report/store/stored/stored_residual_tests.hpp"

#include <fmt/format.h>

#include <cmath>

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
    return fmt::format("weak but significant ({}): effective sample size not reduced", p);
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
  if (test.excess_kurtosis < -0.5) text += ", light tails, like those of a sine wave";
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

}  // namespace

void add_verdicts(ResidualTests& tests, std::string_view unit) {
  tests.autocorrelation.verdict = autocorrelation_words(tests);
  if (auto& cross = tests.cross_correlation) cross->verdict = cross_correlation_words(*cross);
  tests.periodogram.verdict = periodogram_words(tests.periodogram);
  tests.normality.verdict = normality_words(tests.normality);
  tests.drift.verdict = drift_words(tests, unit);
}

StoredCurves stored_curves(const Result& result) {
  StoredCurves curves;
  curves.status = status_of(result.fit);
  curves.of = result.kind == ResultKind::fit ? kFitSchema : kValidationSchema;
  for (const calib::ConditionScore& score : result.fit.conditions)
    curves.conditions.emplace_back(score.id, score.residual_curves);
  return curves;
}

}  // namespace rigcal::report
