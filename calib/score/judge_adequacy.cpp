#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/score/judges.hpp"
#include "calib/trust/lack_of_fit.hpp"
#include "common/significant.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;

/// The residual counts as dependent on the input only if the input explains at least this fraction
/// of its variance. A smaller fraction is negligible compared with the rest.
constexpr double kLeastDriven = 0.1;

/// Returns the ratio of the model error to the noise, both as standard deviations.
double model_error(const LackOfFit& test) { return std::sqrt(std::max(0.0, test.ratio - 1.0)); }

std::string signal_of(const std::string& condition, datasets::Channel channel) {
  return fmt::format("{} of {}", datasets::info(channel).key, condition);
}

/// Describes the largest model error among the signals that pass. An error that exceeds the allowed
/// value but may be due to chance is reported as not significant.
std::string error_words(double largest, double largest_significant, double bound) {
  if (largest <= bound)
    return fmt::format("model error at most {:.2g} times the noise ({:.2g} allowed)", largest,
                       bound);
  const std::string noise = fmt::format(
      "estimates of up to {:.2g} times the noise are not significantly above none", largest);
  if (largest_significant > 0.0) {
    return fmt::format(
        "significant model error at most {:.2g} times the noise ({:.2g} allowed); {}",
        largest_significant, bound, noise);
  }
  return fmt::format("no significant model error ({:.2g} times the noise allowed); {}", bound,
                     noise);
}

/// Judges the records with known noise.
void judge_lack_of_fit(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  /// If the variance of the residual is below this fraction of the stated noise variance (half of
  /// the standard deviation), the stated noise is too large to be used for a judgement.
  constexpr double kOverstated = 0.25;
  const double bound = campaign.acceptance_bounds.model_error_to_noise;
  const auto& tests = fit.lack_of_fit->tests;
  if (tests.empty()) return;
  std::vector<const LackOfFit*> beyond;
  std::vector<const LackOfFit*> overstated;
  std::vector<const LackOfFit*> powerless;
  double largest = 0.0;            // largest model error of all signals
  double significant_error = 0.0;  // largest of those that differ significantly from the noise
  for (const LackOfFit& test : tests) {
    if (test.failed() && model_error(test) > bound) beyond.push_back(&test);
    if (!test.passed() && !test.failed()) powerless.push_back(&test);
    if (test.ratio < kOverstated && !test.by_repeats()) overstated.push_back(&test);
    largest = std::max(largest, model_error(test));
    if (test.failed()) significant_error = std::max(significant_error, model_error(test));
  }
  std::stable_sort(beyond.begin(), beyond.end(),
                   [](const auto* a, const auto* b) { return a->ratio > b->ratio; });
  if (!beyond.empty()) {
    const LackOfFit& worst = *beyond.front();
    reasons.push_back(reason(
        AspectState::reservation, "lack_of_fit",
        fmt::format("lack of fit in {} of {} signals of known noise; worst: {}, model error {} "
                    "times the noise ({:.2g} allowed)",
                    beyond.size(), tests.size(), signal_of(worst.condition, worst.channel),
                    significant(model_error(worst), 2), bound),
        worst.condition,
        {{"signals", static_cast<double>(beyond.size())},
         {"model_error_to_noise", model_error(worst)},
         {"allowed", bound},
         {"p", worst.p}}));
  }
  if (!overstated.empty()) {
    const LackOfFit& first = *overstated.front();
    reasons.push_back(
        reason(AspectState::reservation, "noise_overstated",
               fmt::format("the residual of {} is {} times the noise that `sd` states: if `sd` is "
                           "too large, a lack of fit is not detected",
                           signal_of(first.condition, first.channel),
                           significant(std::sqrt(first.ratio), 2)),
               first.condition, {{"residual_to_noise", std::sqrt(first.ratio)}}));
  }
  if (!powerless.empty()) {
    const LackOfFit& first = *powerless.front();
    reasons.push_back(
        reason(AspectState::reservation, "lack_of_fit_not_judged",
               fmt::format("lack of fit of {} of {} signals cannot be judged; {}: {}",
                           powerless.size(), tests.size(),
                           signal_of(first.condition, first.channel), first.reason.value_or("")),
               first.condition, {{"signals", static_cast<double>(powerless.size())}}));
  }
  if (beyond.empty() && overstated.empty() && powerless.empty()) {
    reasons.push_back(reason(
        AspectState::pass, "no_lack_of_fit",
        fmt::format("no significant lack of fit beyond the limit in {} signal{} of known noise: {}",
                    tests.size(), tests.size() == 1 ? "" : "s",
                    error_words(largest, significant_error, bound)),
        {},
        {{"signals", static_cast<double>(tests.size())},
         {"model_error_to_noise", largest},
         {"allowed", bound}}));
  }
}

/// A signal with unknown noise, which can be judged only from its residual.
struct UnjudgedSignal {
  const ConditionScore* condition = nullptr;
  const ChannelScore* channel = nullptr;
};

std::vector<UnjudgedSignal> signals_of_unknown_noise(const Fit& fit) {
  std::vector<UnjudgedSignal> result;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& channel : score.channels) {
      if (!fit.lack_of_fit->has(score.id, channel.channel)) result.push_back({&score, &channel});
    }
  }
  return result;
}

/// Reports the signal whose residual depends most on the input.
void judge_driven(const std::vector<UnjudgedSignal>& signals, std::vector<Reason>& reasons) {
  const UnjudgedSignal* worst = nullptr;
  double largest = 0.0;
  std::size_t count = 0;
  for (const UnjudgedSignal& each : signals) {
    const auto& tests = each.channel->residual_tests;
    if (!tests || !tests->cross_correlation || !tests->cross_correlation->failed()) continue;
    const double share = tests->cross_correlation->peak * tests->cross_correlation->peak;
    if (share < kLeastDriven) continue;
    ++count;
    if (share <= largest) continue;
    largest = share;
    worst = &each;
  }
  if (worst == nullptr) return;
  const std::string signal = signal_of(worst->condition->id, worst->channel->channel);
  reasons.push_back(reason(
      AspectState::reservation, "residual_depends_on_input",
      fmt::format("{:.0f} % of the residual variance of {} is linearly explained by the input{}: "
                  "unmodelled dynamics, or a wrong parameter",
                  100.0 * largest, signal,
                  count > 1
                      ? fmt::format(", also in {} other signal{}", count - 1, count == 2 ? "" : "s")
                      : ""),
      worst->condition->id, {{"share", largest}, {"signals", static_cast<double>(count)}}));
}

/// Judges the records with unknown noise.
void judge_residuals(const std::vector<UnjudgedSignal>& signals, std::vector<Reason>& reasons) {
  if (signals.empty()) return;
  judge_driven(signals, reasons);
  std::size_t coloured = 0;
  std::size_t judged = 0;
  for (const UnjudgedSignal& each : signals) {
    if (!each.channel->residual_tests) continue;
    const metrics::Autocorrelation& test = each.channel->residual_tests->autocorrelation;
    if (test.passed() || test.failed()) ++judged;
    if (test.failed()) ++coloured;
  }
  const std::vector<std::pair<std::string, double>> numbers{
      {"signals", static_cast<double>(signals.size())},
      {"autocorrelated", static_cast<double>(coloured)}};
  const std::string unknown =
      fmt::format("without repeats and without `sd` the noise is unknown for {} signal{}",
                  signals.size(), signals.size() == 1 ? "" : "s");
  if (judged == 0) {
    reasons.push_back(reason(AspectState::not_assessed, "noise_unknown",
                             unknown + ", and their residuals are too few to be tested", {},
                             numbers));
  } else if (coloured > 0) {
    reasons.push_back(reason(
        AspectState::reservation, "noise_unknown",
        fmt::format("{}, and the residual of {} is autocorrelated: coloured noise, or unmodelled "
                    "dynamics; repeats would distinguish them",
                    unknown, coloured),
        {}, numbers));
  } else {
    reasons.push_back(reason(AspectState::pass, "residuals_white",
                             unknown + "; their residuals have no significant autocorrelation", {},
                             numbers));
  }
}

}  // namespace

Aspect judge_adequacy(const Campaign& campaign, const Fit& fit) {
  std::vector<Reason> reasons;
  judge_lack_of_fit(campaign, fit, reasons);
  judge_residuals(signals_of_unknown_noise(fit), reasons);
  if (reasons.empty())
    reasons.push_back(reason(AspectState::not_assessed, "not_scored", "no condition was scored"));
  return aspect_of(std::move(reasons));
}

}  // namespace rigcal::calib
