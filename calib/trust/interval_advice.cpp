#include "calib/trust/interval_advice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "calib/trust/lack_of_fit.hpp"
#include "common/readable.hpp"
#include "common/significant.hpp"

namespace rigcal::calib {
namespace {

/// The correlation of the residuals is mentioned if their effective fraction is below this value.
constexpr double kCorrelated = 0.5;
/// Two intervals, or the two halves of one, are regarded as equal if their lengths differ by less
/// than this factor. A bootstrap with 1000 replicates determines a length to within 5 %.
constexpr double kAgrees = 1.25;

double width(const Range& interval) { return interval.high - interval.low; }

/// Returns the ratio of the longer half of an interval to the shorter one.
double skewness(double value, const Range& interval) {
  const double below = value - interval.low;
  const double above = interval.high - value;
  if (!(below > 0.0) || !(above > 0.0)) return 1.0;
  return std::max(below / above, above / below);
}

/// Formats both ends with enough digits to distinguish them.
std::string ends_text(const Range& interval, std::string_view unit) {
  const double size = std::max(std::abs(interval.low), std::abs(interval.high));
  const double share = width(interval) > 0.0 ? size / width(interval) : 1.0;
  const int digits = std::clamp(3 + static_cast<int>(std::ceil(std::log10(share))), 4, 12);
  const ReadableUnit in = readable_unit(size, unit);
  return fmt::format("{} to {}{}{}", significant(interval.low / in.si, digits),
                     significant(interval.high / in.si, digits), in.name.empty() ? "" : " ",
                     in.name);
}

/// Compares the profile and the bootstrap of a parameter with `ci95`, and names the interval to use
/// if they differ.
std::string other_interval(const FittedParameter& parameter, std::string_view unit, bool misfit) {
  if (parameter.profile && parameter.profile->low.value && parameter.profile->high.value) {
    const Range ends{*parameter.profile->low.value, *parameter.profile->high.value};
    if (skewness(parameter.value, ends) > kAgrees) {
      return fmt::format("use the interval of the profile, {}: the cost is not quadratic there",
                         ends_text(ends, unit));
    }
  }
  if (!parameter.bootstrap) return {};
  const Range& drawn = *parameter.bootstrap->ci95;
  const double ratio = width(drawn) / width(*parameter.ci95_if_exact);
  if (ratio > kAgrees) {
    return fmt::format("use the interval of the bootstrap, {}: it is {} times as wide",
                       ends_text(drawn, unit), significant(ratio, 2));
  }
  if (skewness(parameter.value, drawn) > 2.0 * kAgrees)
    return fmt::format("use the interval of the bootstrap, {}: it is skewed",
                       ends_text(drawn, unit));
  // With few repeats the bootstrap variance is itself uncertain: its relative error is sqrt(2 / f)
  // for f degrees of freedom.
  const double chance = 2.0 / std::sqrt(2.0 * std::max(1.0, parameter.bootstrap->freedom));
  if (ratio * (kAgrees + chance) < 1.0) {
    return fmt::format("the bootstrap interval is {:.2g} times as wide; use `ci95_if_exact`{}",
                       ratio, misfit ? ", which includes model error too" : "");
  }
  return {};
}

}  // namespace

std::string interval_advice(const Problem& problem, const OptimumCheck& check,
                            const Uncertainty& found, const std::vector<LackOfFit>& tests) {
  if (!check.is_minimum()) {
    return fmt::format(
        "no interval is reliable: the fit did not end at a minimum; by the derivatives there, the "
        "nearest minimum is {} standard errors away; the intervals are centred on the end point",
        significant(check.relative_offset, 2));
  }
  if (found.detail == Detail::plain)
    return "only the plain standard errors exist: the search was stopped on request";
  if (found.scatter.empty()) {
    return "only the plain standard errors exist: too few residuals to estimate their correlation, "
           "or "
           "a record that could not be simulated again";
  }
  const double share = found.independent_residuals / static_cast<double>(problem.residual_count());
  std::string text =
      share < kCorrelated
          ? "residuals are autocorrelated: use the robust errors; the plain ones are too small"
          : "residuals are hardly autocorrelated: robust and plain errors agree where the variance "
            "of the noise is constant";
  const auto flagged = misfit(tests);
  if (!flagged && !tests.empty()) {
    const auto open = std::find_if(tests.begin(), tests.end(), [](const LackOfFit& test) {
      return test.outcome == metrics::TestOutcome::not_judged;
    });
    return text + fmt::format("; lack of fit cannot be judged (condition \"{}\", {}: {})",
                              open->condition, datasets::info(open->channel).key,
                              open->reason.value_or(""));
  }
  if (!flagged) {
    return text +
           "; without repeats and without `sd` errors of the model and noise "
           "cannot be separated";
  }
  const LackOfFit& test = *least_likely(tests);
  const std::string against =
      test.by_repeats() ? "the variation between repeats" : "the stated `sd`";
  if (*flagged) {
    return text + fmt::format(
                      "; significant lack of fit (condition \"{}\", {}: residual variance {} "
                      "times that of {}, {}): intervals apply to the values that fit this "
                      "model best to these signals; other signals may lead to other values",
                      test.condition, datasets::info(test.channel).key, significant(test.ratio, 3),
                      against, p_value_text(test.p));
  }
  return text + fmt::format("; no lack of fit detected against {} (smallest {}, {} test{})",
                            against, p_value_text(test.p), tests.size(),
                            tests.size() == 1 ? "" : "s");
}

std::optional<BetweenRepeats> between_repeats(const Problem& problem, const Uncertainty& found) {
  BetweenRepeats result;
  for (std::size_t j = 0; j < found.repeats_ratio.size(); ++j) {
    result.ratio = std::max(result.ratio, found.repeats_ratio[j]);
    result.p = std::min(result.p, found.repeats_p[j]);
    if (found.from_repeats[j]) result.parameters.push_back(problem.name(j));
  }
  if (!(result.ratio > 0.0)) return std::nullopt;
  result.p = std::min(1.0, result.p * static_cast<double>(found.repeats_p.size()));
  result.differ = found.repeats_differ() || found.difference;
  if (found.difference) {
    if (!found.repeats_differ()) result.p = found.difference->p;
    result.cause = unless_empty(found.difference->cause);
    if (result.cause) {
      result.cause_sd = found.difference->sd;
      result.cause_explains = found.difference->explained;
    }
  }
  return result;
}

std::string between_repeats_warning(const BetweenRepeats& repeats) {
  if (!repeats.differ) return {};
  std::string text = fmt::format(
      "repeats differ from one another by more than their noise ({}): standard errors from "
      "these differences are up to {} times those from the residuals of their mean",
      p_value_text(repeats.p), significant(repeats.ratio, 2));
  if (!repeats.parameters.empty())
    text += fmt::format(", and the intervals of {} use them", fmt::join(repeats.parameters, ", "));
  if (!repeats.cause) return text;
  if (repeats.cause == "start") {
    return text + fmt::format(
                      "; they differ as if each had started at a different time (standard "
                      "deviation {:.2g} ms), so the start of their mean is uncertain too: record "
                      "the drive, or use a common trigger",
                      1e3 * *repeats.cause_sd);
  }
  text += fmt::format("; they differ as if {} varied by {} % from repeat to repeat", *repeats.cause,
                      significant(100.0 * *repeats.cause_sd, 2));
  text += ": ";
  if (repeats.cause == "supply_pressure")
    text += "a recorded supply pressure (channel `supply_pressure`) would account for it, or ";
  return text + fmt::format(
                    "`between_repeats` of {} in [rig.parameters], with this standard "
                    "deviation, estimates it for every condition",
                    *repeats.cause);
}

std::string noiseless_warning(const Problem& problem, const Uncertainty& found) {
  std::size_t all = 0;
  for (const ProblemCondition& condition : problem.conditions) all += condition.channels.size();
  return fmt::format(
      "in {} of {} records the residual is too small to be noise: it contains errors of the model "
      "and of its solver, which do not average out. Standard errors there treat each condition as "
      "one observation; they show how far such errors may shift a value, not its variation",
      found.noiseless, all);
}

std::string compare_intervals(const Problem& problem,
                              const std::vector<FittedParameter>& parameters,
                              const std::vector<std::string>& carried, bool misfit) {
  std::vector<std::string> words;
  std::vector<std::string> open;
  bool drawn = false;
  bool followed = false;
  for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j) {
    const FittedParameter& each = parameters[j];
    if (each.nuisance || (!each.bootstrap && !each.profile)) continue;
    if (each.identifiability == Identifiability::not_identifiable) {
      open.push_back(problem.name(j));
      continue;
    }
    if (!each.ci95_if_exact || !(width(*each.ci95_if_exact) > 0.0)) continue;
    drawn = drawn || each.bootstrap;
    followed =
        followed || (each.profile && !each.profile->low.is_lost() && !each.profile->high.is_lost());
    if (!carried.empty()) continue;
    const std::string advice = other_interval(each, problem.spec(j).unit, misfit);
    if (!advice.empty()) words.push_back(problem.name(j) + ": " + advice);
  }
  const std::string made = drawn && followed ? "bootstrap and profiles"
                           : drawn           ? "the bootstrap"
                                             : "profiles";
  const char* const s = drawn && !followed ? "s" : "";
  if (!carried.empty() && (drawn || followed)) {
    words.push_back(
        fmt::format("{} leave{} out the uncertainty of {}: use `ci95`, which includes it", made, s,
                    fmt::join(carried, ", ")));
  } else if (words.empty() && (drawn || followed)) {
    words.push_back(fmt::format("{}{} agree{} with `ci95_if_exact`",
                                open.empty() ? "" : "elsewhere ", made, s));
  }
  if (!open.empty()) {
    words.insert(words.begin(), fmt::format("not identifiable, so no interval is reliable: {}",
                                            fmt::join(open, ", ")));
  }
  return fmt::format("{}", fmt::join(words, "; "));
}

}  // namespace rigcal::calib
