#include "calib/interval_advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/lack_of_fit.hpp"

namespace rigcal::calib {
namespace {

/// Effective share of the residuals below which correlation is worth a word.
constexpr double kCorrelated = 0.5;
/// Widths and halves that differ by less agree: a bootstrap of 1000 knows its own to 5 %.
constexpr double kAgrees = 1.25;

double width(const std::pair<double, double>& interval) { return interval.second - interval.first; }

/// Share by which the longer half of an interval exceeds the other.
double skewness(double value, const std::pair<double, double>& interval) {
  const double below = value - interval.first;
  const double above = interval.second - value;
  if (!(below > 0.0) || !(above > 0.0)) return 1.0;
  return std::max(below / above, above / below);
}

}  // namespace

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

std::string compare_intervals(const Problem& problem,
                              const std::vector<FittedParameter>& parameters) {
  std::vector<std::string> words;
  bool asked = false;
  for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j) {
    const FittedParameter& each = parameters[j];
    if (each.nuisance || !each.ci95 || !(width(*each.ci95) > 0.0)) continue;
    asked = asked || each.bootstrap || each.profile;
    if (each.profile && each.profile->low.value && each.profile->high.value) {
      const std::pair ends{*each.profile->low.value, *each.profile->high.value};
      if (skewness(each.value, ends) > kAgrees) {
        words.push_back(fmt::format(
            "{}: believe the profile, {:.4g} to {:.4g}; the cost is not quadratic there",
            problem.name(j), ends.first, ends.second));
        continue;
      }
    }
    if (!each.bootstrap) continue;
    const double ratio = width(each.bootstrap->ci95) / width(*each.ci95);
    if (ratio > kAgrees || skewness(each.value, each.bootstrap->ci95) > 2.0 * kAgrees) {
      words.push_back(fmt::format(
          "{}: believe the bootstrap, {:.4g} to {:.4g}, {:.2g} times as wide", problem.name(j),
          each.bootstrap->ci95.first, each.bootstrap->ci95.second, ratio));
    } else if (ratio * kAgrees < 1.0) {
      words.push_back(fmt::format(
          "{}: the bootstrap is {:.2g} times as wide; believe `ci95`, which counts what the model "
          "lacks too",
          problem.name(j), ratio));
    }
  }
  if (!words.empty()) return fmt::format("{}", fmt::join(words, "; "));
  return asked ? "bootstrap and profiles agree with `ci95`" : "";
}

}  // namespace rigcal::calib
