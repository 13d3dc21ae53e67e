#include "report/store/stored/stored_residual_tests.hpp"

#include "report/text/residual_test_words.hpp"

namespace rigcal::report {
namespace {

template <typename Test>
Worded<Test> worded(const Test& test, std::string words) {
  Worded<Test> result;
  static_cast<Test&>(result) = test;
  result.verdict = std::move(words);
  if (test.outcome != metrics::TestOutcome::not_judged) result.has_passed = test.passed();
  return result;
}

/// Every k-th value, so that at most about 200 are left, that of lag zero among them.
///
/// @param centre  the value of lag zero
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
