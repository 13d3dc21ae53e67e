#include "report/store/residual_tests_json.hpp"

#include <fmt/format.h>

#include <cmath>

#include "report/text/readable.hpp"

namespace rigcal::report {
namespace {

using metrics::ResidualTests;

std::string hertz(double value) { return fmt::format("{:.3g} Hz", value); }

std::string not_judged(const metrics::Judged& test) { return "cannot be judged: " + test.reason; }

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
  const std::string peak = fmt::format("largest correlation {:.2g}, 95 % bound {:.2g}",
                                       std::abs(test.peak), test.band_of_peak);
  if (test.passed()) return fmt::format("not significantly correlated with the input: {}", peak);
  if (!test.failed()) return not_judged(test);
  return fmt::format(
      "{:.0f} % of the residual variance is linearly explained by the input (correlation {:.2g} at "
      "a lag of {}, 95 % bound {:.2g}): unmodelled dynamics, or a wrong parameter",
      100.0 * test.peak * test.peak, test.peak, readable(test.peak_lag_s, "s", 2),
      test.band_of_peak);
}

std::string periodogram_words(const metrics::Periodogram& test) {
  if (test.passed()) return "consistent with a flat spectrum (white noise)";
  if (!test.failed()) return not_judged(test);
  std::string text =
      fmt::format("not flat: half of the power lies below {}", hertz(test.median_frequency_hz));
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

/// `passed` and `reason` are null where they do not apply.
Json with_outcome(const metrics::Judged& test, Json json) {
  const bool judged = test.outcome != metrics::TestOutcome::not_judged;
  json["passed"] = judged ? Json(test.passed()) : Json(nullptr);
  json["outcome"] = std::string(metrics::to_string(test.outcome));
  json["reason"] = judged ? Json(nullptr) : Json(test.reason);
  return json;
}

/// Every k-th value, so that at most about 200 are left.
struct Thinned {
  std::size_t stride = 1;
  Json values = Json::array();
};

Thinned thinned(const std::vector<double>& values, std::size_t centre) {
  constexpr std::size_t kMost = 200;
  Thinned result;
  result.stride = values.size() / kMost + 1;
  for (std::size_t i = centre % result.stride; i < values.size(); i += result.stride)
    result.values.push_back(number(values[i]));
  return result;
}

Json curves_of(const ResidualTests& tests) {
  Json json;
  const Thinned rho = thinned(tests.autocorrelation.values, 0);
  json["autocorrelation"] = {
      {"first_lag_s", 0.0},
      {"lag_step_s", static_cast<double>(rho.stride) * tests.sample_interval_s},
      {"band", tests.autocorrelation.band},
      {"values", rho.values}};
  json["cross_correlation"] = nullptr;
  if (const auto& cross = tests.cross_correlation) {
    const std::size_t centre = cross->values.size() / 2;
    const Thinned values = thinned(cross->values, centre);
    const double first = static_cast<double>(centre % values.stride) - static_cast<double>(centre);
    json["cross_correlation"] = {
        {"first_lag_s", first * tests.sample_interval_s},
        {"lag_step_s", static_cast<double>(values.stride) * tests.sample_interval_s},
        {"band", cross->band},
        {"band_of_peak", cross->band_of_peak},
        {"values", values.values}};
  }
  json["periodogram"] = {{"frequency_hz", tests.periodogram.frequency_hz},
                         {"density", tests.periodogram.density}};
  json["normality"] = {{"normal_quantile", tests.normality.normal_quantile},
                       {"residual_quantile", tests.normality.residual_quantile}};
  return json;
}

}  // namespace

Json residual_tests_json(const ResidualTests& tests, std::string_view unit) {
  Json json;
  json["samples"] = tests.samples;
  json["sample_interval_s"] = number(tests.sample_interval_s);
  json["std"] = number(tests.std);
  json["effective_samples"] = number(tests.effective_samples);
  const auto& rho = tests.autocorrelation;
  json["autocorrelation"] =
      with_outcome(rho, {{"ljung_box", number(rho.ljung_box)},
                         {"tested_lags", rho.tested_lags},
                         {"p_value", number(rho.p_value)},
                         {"durbin_watson", number(rho.durbin_watson)},
                         {"correlation_time_s", number(rho.correlation_time_s)},
                         {"verdict", autocorrelation_words(tests)}});
  json["cross_correlation"] = nullptr;
  if (const auto& cross = tests.cross_correlation) {
    json["cross_correlation"] =
        with_outcome(*cross, {{"peak", number(cross->peak)},
                              {"peak_lag_s", number(cross->peak_lag_s)},
                              {"limit", number(cross->band_of_peak)},
                              {"verdict", cross_correlation_words(*cross)}});
  }
  const auto& spectrum = tests.periodogram;
  json["periodogram"] =
      with_outcome(spectrum, {{"distance", number(spectrum.distance)},
                              {"limit", number(spectrum.limit)},
                              {"median_frequency_hz", number(spectrum.median_frequency_hz)},
                              {"peak_frequency_hz", number(spectrum.peak_frequency_hz)},
                              {"peak_share", number(spectrum.peak_share)},
                              {"verdict", periodogram_words(spectrum)}});
  const auto& shape = tests.normality;
  json["normality"] = with_outcome(shape, {{"skewness", number(shape.skewness)},
                                           {"excess_kurtosis", number(shape.excess_kurtosis)},
                                           {"jarque_bera", number(shape.jarque_bera)},
                                           {"p_value", number(shape.p_value)},
                                           {"verdict", normality_words(shape)}});
  const auto& drift = tests.drift;
  json["drift"] = with_outcome(drift, {{"mean", number(drift.mean)},
                                       {"mean_p_value", number(drift.mean_p_value)},
                                       {"slope_per_s", number(drift.slope_per_s)},
                                       {"slope_p_value", number(drift.slope_p_value)},
                                       {"verdict", drift_words(tests, unit)}});
  return json;
}

std::string residual_curves_text(const Result& result) {
  Json json;
  json["status"] = std::string(to_string(status_of(result.fit)));
  json["schema"] = kResidualTestsSchema;
  json["of"] = result.kind == ResultKind::fit ? kFitSchema : kValidationSchema;
  json["conditions"] = Json::object();
  for (const calib::ConditionScore& score : result.fit.conditions) {
    Json& channels = json["conditions"][score.id] = Json::object();
    for (const calib::ChannelScore& channel : score.channels) {
      channels[std::string(info(channel.channel).key)] =
          channel.residual_tests ? curves_of(*channel.residual_tests) : Json(nullptr);
    }
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace rigcal::report
