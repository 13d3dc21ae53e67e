#include "diagnosis/record/leak_estimate.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/machine/between_days.hpp"
#include "diagnosis/record/leak_budget.hpp"

using namespace rigcal::diagnosis;
using Catch::WithinAbs;
using Catch::WithinRel;

namespace {

/// share = C / 10, a straight line, so that errors carry over in proportion.
LeakCurve straight() {
  return LeakCurve({{0.0, 0.0, 0.0, 0.1, 1e-5}, {8.0, 0.8, 8e-5, 0.1, 1e-5}});
}

/// A record whose coefficient is known within `se`, with practically unlimited degrees of freedom.
LeakFit fit_of(double coefficient, double se) {
  LeakFit fit;
  fit.coefficient = coefficient;
  fit.white_se = se;
  fit.white_freedom = 1'000'000;
  fit.effect_m = 1e-3;
  return fit;
}

LeakEstimate estimated(const LeakFit& fit, const SignalErrors& errors = {}, int repeats = 1,
                       int reference = 0, double share_rig_se = 0.0) {
  return estimate_leak(fit.coefficient, coefficient_error(fit, errors, repeats, reference),
                       straight(), share_rig_se, {});
}

double probability(const LeakEstimate& estimate, LeakClass leak_class) {
  return estimate.probability[static_cast<std::size_t>(leak_class)];
}

const rigcal::datasets::DiagnosisSettings kSettings;

}  // namespace

TEST_CASE("estimate_leak: class probabilities follow the interval", "[diagnosis]") {
  const auto sure = estimated(fit_of(1.5, 0.02));
  CHECK(sure.most_probable == LeakClass::medium);
  CHECK(probability(sure, LeakClass::medium) > 0.999);
  CHECK_THAT(sure.share, WithinRel(0.15, 1e-9));
  // The half width is 1.96 times 0.02 for the coefficient, and a tenth of that for the share. 401
  // draws resolve a hundredth.
  CHECK_THAT(sure.share_ci95.low, WithinAbs(0.15 - 0.00392, 1e-4));
  CHECK_THAT(sure.ci95.high, WithinAbs(1.5 + 0.0392, 1e-5));

  const auto torn = estimated(fit_of(1.0, 0.1));
  // Half the distribution is below the limit, and the prior makes this half more probable. The
  // values are integrals of exp(-(s - 0.1)^2 / (2 0.01^2)) / (0.00125 + s).
  CHECK_THAT(probability(torn, LeakClass::slight), WithinAbs(0.5398, 2e-3));
  CHECK_THAT(probability(torn, LeakClass::medium), WithinAbs(0.4602, 2e-3));
  CHECK_THAT(std::accumulate(torn.probability.begin(), torn.probability.end(), 0.0),
             WithinAbs(1.0, 1e-12));
}

TEST_CASE("estimate_leak: beforehand normal is as probable as slight, without a step between them",
          "[diagnosis]") {
  // The record hardly determines shares below 10 %, so only the prior counts.
  const auto vague = estimated(fit_of(0.0, 50.0));
  CHECK_THAT(probability(vague, LeakClass::normal) / probability(vague, LeakClass::slight),
             WithinRel(1.0, 0.1));
  // At a limit the record decides: 1.1 % with an error of 0.2 %, using the same integrals as above.
  const auto near = estimated(fit_of(0.11, 0.02));
  CHECK_THAT(probability(near, LeakClass::slight), WithinAbs(0.6268, 4e-3));
  // For these limits, no offset makes the classes equally probable, so every share is as probable
  // as any other.
  rigcal::datasets::DiagnosisSettings close;
  close.limits = {0.10, 0.15, 0.2, 0.3};
  const LeakFit fit = fit_of(1.0, 0.1);
  const auto flat = estimate_leak(1.0, coefficient_error(fit, {}, 1, 0), straight(), 0.0, close);
  CHECK_THAT(probability(flat, LeakClass::normal), WithinAbs(0.5, 2e-3));
}

TEST_CASE("estimate_leak: given that a leak is not negative", "[diagnosis]") {
  // The values are integrals of exp(-s^2 / (2 0.01^2)) / (0.00125 + s), from 0 to 1 % and beyond.
  const auto none = estimated(fit_of(0.0, 0.1));
  CHECK_THAT(probability(none, LeakClass::normal), WithinAbs(0.8873, 4e-3));
  CHECK(none.ci95.low == 0.0);
  CHECK_FALSE(none.leak_detected);
  const auto negative = estimated(fit_of(-0.5, 0.1));
  CHECK(negative.share == 0.0);
  CHECK(probability(negative, LeakClass::normal) > 0.99);
}

TEST_CASE("estimate_leak: every source of error is in the interval", "[diagnosis]") {
  LeakFit fit = fit_of(1.5, 0.03);
  fit.rig_se = 0.04;
  SignalErrors errors;
  errors.between_m = 0.12e-3;  // 0.12 in terms of the coefficient
  errors.repeat_freedom = 16;
  errors.healthy_m = 0.05e-3;
  const auto single = estimated(fit, errors, 1, 0);
  CHECK_THAT(single.standard_error,
             WithinRel(std::sqrt(0.03 * 0.03 + 0.04 * 0.04 + 0.12 * 0.12 + 0.05 * 0.05), 1e-9));
  const auto mean = estimated(fit, errors, 4, 0);
  CHECK_THAT(mean.standard_error,
             WithinRel(std::sqrt(0.03 * 0.03 + 0.04 * 0.04 + 0.06 * 0.06 + 0.05 * 0.05), 1e-9));
  // Welch and Satterthwaite: only the contribution of the repeats has few degrees of freedom.
  CHECK_THAT(single.freedom,
             WithinRel(std::pow(single.standard_error, 4) / (std::pow(0.12, 4) / 16.0), 1e-5));
}

TEST_CASE("leak budgets: the contributions to coefficient and share add up by hand",
          "[diagnosis]") {
  LeakFit fit = fit_of(1.5, 0.03);
  fit.rig_se = 0.05;
  SignalErrors errors;
  errors.between_m = 0.12e-3;  // 0.12 in terms of the coefficient
  errors.repeat_freedom = 16;
  errors.healthy_m = 0.05e-3;
  const CoefficientError error = with_days(coefficient_error(fit, errors, 1, 0), 0.02, 1e6);
  const std::vector<rigcal::calib::BudgetLine> of_rig{{"rig_parameters", "known_value", 0.03},
                                                      {"ki", "effect", 0.04}};
  const auto budget = coefficient_budget(error, of_rig);
  std::vector<std::pair<std::string, double>> lines;
  for (const auto& line : budget.lines) lines.emplace_back(line.source, line.uncertainty);
  const std::vector<std::pair<std::string, double>> expected{
      {"noise", 0.03},          {"repeats", 0.12}, {"healthy_records", 0.05},
      {"rig_parameters", 0.03}, {"ki", 0.04},      {"days", 0.02}};
  REQUIRE(lines.size() == expected.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(lines[i].first == expected[i].first);
    CHECK_THAT(lines[i].second, WithinRel(expected[i].second, 1e-12));
    squares += lines[i].second * lines[i].second;
  }
  CHECK(budget.combined == error.total());
  CHECK_THAT(std::sqrt(squares), WithinRel(budget.combined, 1e-12));
  CHECK_THAT(budget.expanded, WithinRel(error.half_width(), 1e-12));
  // The share is a tenth of the coefficient, and its budget is in percentage points.
  const std::vector<rigcal::calib::BudgetLine> of_share{{"rig_parameters", "known_value", 0.003},
                                                        {"ki", "effect", 0.004}};
  const auto share = share_budget(error, 0.1, of_share, 0.002);
  REQUIRE(share.lines.size() == budget.lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK(share.lines[i].source == budget.lines[i].source);
    CHECK_THAT(share.lines[i].uncertainty, WithinRel(10.0 * budget.lines[i].uncertainty, 1e-12));
  }
  CHECK_THAT(share.combined, WithinRel(10.0 * budget.combined, 1e-12));
  // Far from zero it is the interval of the distribution.
  const auto estimate =
      estimate_leak(1.5, error, straight(), std::hypot(0.003, 0.004, 0.002), kSettings);
  const double half = 50.0 * (estimate.share_ci95.high - estimate.share_ci95.low);
  CHECK_THAT(share.expanded, WithinRel(half, 0.03));
}

TEST_CASE("coefficient_error: clusters count where the signal has misfit and the record shows it",
          "[diagnosis]") {
  LeakFit fit = fit_of(1.5, 0.03);
  fit.cluster_freedom = 9;
  SignalErrors errors;
  const auto with = [&](bool misfit, double cluster_se) {
    errors.misfit = misfit;
    fit.cluster_se = cluster_se;
    return coefficient_error(fit, errors, 1, 0);
  };
  CHECK(with(false, 0.09).own_se == 0.03);
  CHECK(with(true, 0.09).own_se == 0.09);
  CHECK(with(true, 0.09).own.front().source == "lack_of_fit");
  CHECK(with(false, 0.09).own.front().source == "noise");
  CHECK_THAT(with(true, 0.09).freedom, WithinRel(9.0, 1e-9));
  // The upper quartile of chi-square divided by its 9 degrees of freedom is 1.265.
  CHECK(with(true, 0.03 * std::sqrt(1.25)).own_se == 0.03);
  CHECK(with(true, 0.03 * std::sqrt(1.28)).own_se > 0.03);
}

TEST_CASE("estimate_leak: a reference adds its own scatter and takes the model's off",
          "[diagnosis]") {
  SignalErrors errors;
  errors.between_m = 0.12e-3;  // 0.12 in terms of the coefficient
  errors.repeat_freedom = 16;
  errors.healthy_m = 0.05e-3;
  const LeakFit fit = fit_of(1.5, 0.03);
  const auto corrected = estimated(fit, errors, 1, 3);
  CHECK_THAT(corrected.standard_error,
             WithinRel(std::sqrt(0.03 * 0.03 + 0.12 * 0.12 * (1.0 + 1.0 / 3.0)), 1e-9));
  // Welch and Satterthwaite: the contribution of the repeats has 16 degrees of freedom, and that of
  // the residuals 1e6.
  const double repeats = 0.12 * 0.12 * (1.0 + 1.0 / 3.0);
  CHECK_THAT(corrected.freedom, WithinRel(std::pow(0.03 * 0.03 + repeats, 2) /
                                              (repeats * repeats / 16.0 + std::pow(0.03, 4) / 1e6),
                                          1e-9));
}

TEST_CASE("estimate_leak: a leak is detected from the level of false alarms on", "[diagnosis]") {
  // The normal quantile for 1 % false alarms is 2.3263.
  REQUIRE(kSettings.false_alarms == 0.01);
  CHECK_FALSE(estimated(fit_of(0.232, 0.1)).leak_detected);
  CHECK(estimated(fit_of(0.233, 0.1)).leak_detected);
  CHECK_THAT(estimated(fit_of(0.233, 0.1)).leak_score, WithinRel(2.33, 1e-12));
}

TEST_CASE("estimate_leak: few degrees of freedom take a larger score, and widen the share",
          "[diagnosis]") {
  LeakFit fit = fit_of(0.0, 0.1);
  fit.white_freedom = 4;
  // With 4 degrees of freedom, the quantile of t for 1 % false alarms is 3.747.
  fit.coefficient = 0.37;
  CHECK_FALSE(estimated(fit).leak_detected);
  fit.coefficient = 0.38;
  CHECK(estimated(fit).leak_detected);
  // For the ends of the interval, it is 2.776.
  fit.coefficient = 1.5;
  fit.white_se = 0.02;
  CHECK_THAT(estimated(fit).share_ci95.low, WithinAbs(0.15 - 2.776 * 0.002, 3e-4));
  CHECK_THAT(estimated(fit).share_ci95.high, WithinAbs(0.15 + 2.776 * 0.002, 3e-4));
}

TEST_CASE("estimate_leak: the rig's error blurs the share", "[diagnosis]") {
  const auto found = estimated(fit_of(1.5, 1e-9), {}, 1, 0, 0.01);
  // The interval ends at 1.96 standard errors. The search stops at 1e-15 of the range.
  CHECK_THAT(found.share_ci95.low, WithinAbs(0.15 - 0.0195996, 1e-6));
  CHECK_THAT(found.share_ci95.high, WithinAbs(0.15 + 0.0195996, 1e-6));
}

TEST_CASE("estimate_leak: an upper limit where no leak is detected", "[diagnosis]") {
  // For half a normal distribution with sd 0.1, 95 % is below 1.959964 sd, and the share is a tenth
  // of the coefficient.
  const auto none = estimated(fit_of(0.0, 0.1));
  REQUIRE(none.share_upper_limit);
  CHECK_THAT(*none.share_upper_limit, WithinAbs(0.0196, 1e-4));
  CHECK(none.share_ci95.low == 0.0);
  CHECK(none.share_ci95.high == *none.share_upper_limit);
  const auto some = estimated(fit_of(0.3, 0.1));
  CHECK_FALSE(some.share_upper_limit);
  CHECK(some.share_ci95.low > 0.0);
}

TEST_CASE("estimate_leak: no interval ends at zero, however far below it the estimate lies",
          "[diagnosis]") {
  // Without a leak, 95 % of half a normal distribution is below 1.959964 sd.
  const auto none = estimated(fit_of(0.0, 0.1));
  CHECK(none.ci95.low == 0.0);
  CHECK_THAT(none.ci95.high, WithinRel(0.1959964, 1e-5));
  // Two standard errors below zero, P(Z > 2) = 0.0227501 is left above zero, and a twentieth of
  // this is beyond 3.05176 standard errors.
  const auto below = estimated(fit_of(-0.2, 0.1));
  CHECK_FALSE(below.incompatible);
  CHECK_THAT(below.ci95.high, WithinAbs(0.1 * (3.05176 - 2.0), 1e-5));
  // Beyond 2.3263 errors (1 % false alarms), no leak explains the record.
  CHECK_FALSE(estimated(fit_of(-0.232, 0.1)).incompatible);
  const auto beyond = estimated(fit_of(-0.233, 0.1));
  CHECK(beyond.incompatible);
  CHECK_FALSE(beyond.has_class());
  CHECK_THAT(beyond.ci95.low, WithinAbs(-0.233 - 0.196, 1e-4));
  CHECK_THAT(beyond.ci95.high, WithinAbs(-0.233 + 0.196, 1e-4));
}

TEST_CASE("estimate_leak: a share is within 0 and 1, or none", "[diagnosis]") {
  // share = C / 10. For a coefficient of 9 with an error of 2, the interval includes shares above
  // 1.
  const auto wide = estimated(fit_of(9.0, 2.0));
  CHECK(wide.has_share());
  CHECK(wide.share_ci95.high == 1.0);
  CHECK(wide.share_ci95.low > 0.4);
  CHECK_FALSE(estimated(fit_of(11.0, 2.0)).has_share());
}

TEST_CASE("detection_limit: Currie's sum of both quantiles", "[diagnosis]") {
  // The sum of the quantiles is 2.3263 + 1.6449.
  const CoefficientError error = coefficient_error(fit_of(0.0, 0.01), {}, 1, 0);
  CHECK_THAT(detection_limit(error, kSettings), WithinRel(0.039712, 1e-4));
  // With 4 degrees of freedom, it is 3.74695 + 2.13185.
  CHECK_THAT(detection_limit({0.01, 0.0, 4.0, 0.0}, kSettings), WithinRel(0.0587880, 1e-5));
}

TEST_CASE("error_of_averages: noise, misfit and the spread beyond noise, of both means",
          "[diagnosis]") {
  SignalErrors errors;
  // A record that is its own reference has no residual and therefore no error.
  const LeakFit reference = fit_of(0.0, 0.0);
  CHECK_FALSE(error_of_averages(reference, errors, 5, 5));
  errors.repeat_m = 0.13e-3;  // 0.13 in terms of the coefficient
  errors.repeat_noise_m = 0.12e-3;
  errors.repeat_freedom = 4;
  const double of_both = 1.0 / 5.0 + 1.0 / 3.0;
  // The spread of a few repeats is close to the noise that their samples show, so noise is known.
  const auto noise = error_of_averages(reference, errors, 5, 3);
  REQUIRE(noise);
  CHECK_THAT(noise->own_se, WithinRel(0.12 * std::sqrt(of_both), 1e-12));
  CHECK(noise->freedom == rigcal::metrics::kManyDegrees);
  CHECK(noise->rig_se == 0.0);
  // What is beyond noise has the degrees of freedom of the repeats.
  errors.between_m = 0.05e-3;
  const auto beyond = error_of_averages(reference, errors, 5, 3);
  REQUIRE(beyond);
  CHECK_THAT(beyond->own_se, WithinRel(0.13 * std::sqrt(of_both), 1e-12));
  CHECK_THAT(beyond->freedom, WithinRel(4.0 * std::pow(0.13 / 0.05, 4), 1e-3));
  // Residuals that are not white count as they do in the records that will be diagnosed.
  errors.between_m = 0.0;
  errors.residual_ratio = 2.25;
  errors.residual_freedom = 20.0;
  const auto misfit = error_of_averages(reference, errors, 5, 3);
  REQUIRE(misfit);
  CHECK_THAT(misfit->own_se, WithinRel(0.18 * std::sqrt(of_both), 1e-12));
  CHECK_THAT(misfit->freedom, WithinRel(20.0, 1e-9));
  LeakFit of_unsure_rig = reference;
  of_unsure_rig.rig_se = 0.05;
  const auto more = error_of_averages(of_unsure_rig, errors, 5, 3);
  REQUIRE(more);
  CHECK(more->rig_se == 0.05);
}

TEST_CASE("keep_larger: the limit of the larger flow, whatever comes first", "[diagnosis]") {
  const DetectionLimit small{0.5, 1e-6, 0.02};
  const DetectionLimit large{0.1, 2e-6, 0.01};
  for (const bool small_first : {false, true}) {
    std::optional<DetectionLimit> kept;
    keep_larger(small_first ? small : large, kept);
    keep_larger(small_first ? large : small, kept);
    REQUIRE(kept);
    CHECK(kept->leak_flow_m3_per_s == 2e-6);
  }
}

TEST_CASE("class_of: a share at a limit is above it", "[diagnosis]") {
  CHECK(class_of(kSettings, 0.0) == LeakClass::normal);
  CHECK(class_of(kSettings, 0.01) == LeakClass::slight);
  CHECK(class_of(kSettings, 0.0999) == LeakClass::slight);
  CHECK(class_of(kSettings, 0.25) == LeakClass::critical);
  CHECK(class_of(kSettings, 2.0) == LeakClass::supercritical);
}
