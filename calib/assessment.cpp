#include "calib/assessment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/lack_of_fit.hpp"
#include "common/significant.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;

/// Without limits, an agreement below this is named: a model that explains less than nine tenths of
/// the variance does not describe a record by anybody's standard.
constexpr double kPoorRho2 = 0.9;
/// Share of the residual's variance that must be explained by the input before it counts: less is
/// not seen beside the rest.
constexpr double kLeastDriven = 0.1;
/// An upper limit is negligible below this share of what the same parameter is elsewhere in the
/// campaign: the share that makes an estimate weak.
constexpr double kNegligibleShare = 0.2;

Reason reason(AspectState state, std::string code, std::string words, std::string subject = {},
              std::vector<std::pair<std::string, double>> numbers = {}) {
  return {state, std::move(code), std::move(subject), std::move(numbers), std::move(words)};
}

/// How grave a state is.
int rank(AspectState state) {
  switch (state) {
    case AspectState::fail:
      return 3;
    case AspectState::not_assessed:
      return 2;
    case AspectState::reservation:
      return 1;
    case AspectState::pass:
      break;
  }
  return 0;
}

/// The gravest reason makes the state; reasons of one state stay in their order.
Aspect aspect_of(std::vector<Reason> reasons) {
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const Reason& a, const Reason& b) { return rank(a.state) > rank(b.state); });
  Aspect aspect;
  if (!reasons.empty()) aspect.state = reasons.front().state;
  aspect.reasons = std::move(reasons);
  return aspect;
}

std::string conditions_text(std::size_t count) {
  return fmt::format("{} condition{}", count, count == 1 ? "" : "s");
}

double largest_use(const ConditionScore& score) {
  double used = 0.0;
  for (const LimitCheck& check : score.checks) used = std::max(used, check.used);
  return used;
}

/// "37 %", "1.8 %", "over 1000 %".
std::string percent(double share) {
  return share > 10.0 ? std::string("over 1000 %") : fmt::format("{:.2g} %", 100.0 * share);
}

/// Scores in the order of how far they use their tolerances, the worst first.
std::vector<const ConditionScore*> by_use(const std::vector<const ConditionScore*>& scores) {
  std::vector<const ConditionScore*> sorted = scores;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) {
    const auto key = [](const ConditionScore* s) {
      return std::pair(s->failure.empty() ? 0 : 1, largest_use(*s));
    };
    return key(a) > key(b);
  });
  return sorted;
}

/// What the limits say of some conditions.
void judge_limits(const std::vector<const ConditionScore*>& scores, std::vector<Reason>& reasons) {
  const ConditionScore* nearest = nullptr;
  std::size_t kept = 0;
  for (const ConditionScore* score : by_use(scores)) {
    const std::string words = fmt::format("{}: {}", score->id, fmt::join(score->reasons, "; "));
    const std::vector<std::pair<std::string, double>> numbers{
        {"tolerance_used", largest_use(*score)}};
    if (!score->not_scored.empty()) {
      reasons.push_back(reason(AspectState::reservation, "not_scored",
                               fmt::format("{}: not scored ({})", score->id, score->not_scored),
                               score->id));
    } else if (!score->failure.empty()) {
      reasons.push_back(reason(AspectState::fail, "not_simulated", words, score->id));
    } else if (score->verdict == Verdict::fail) {
      const bool evaluated = std::all_of(score->checks.begin(), score->checks.end(),
                                         [](const LimitCheck& check) { return check.value; });
      reasons.push_back(reason(AspectState::fail,
                               evaluated ? "limit_broken" : "limit_not_evaluable", words, score->id,
                               numbers));
    } else if (score->verdict == Verdict::warn) {
      reasons.push_back(reason(AspectState::reservation, "limit_near", words, score->id, numbers));
    } else if (score->verdict) {
      ++kept;
      if (nearest == nullptr) nearest = score;
    }
  }
  if (nearest == nullptr) return;
  const double used = largest_use(*nearest);
  reasons.push_back(reason(
      AspectState::pass, "limits_kept",
      scores.size() == 1
          ? fmt::format("{} keeps its limits: {} of the tolerance used", nearest->id, percent(used))
          : fmt::format("{} of {} keep their limits; closest to one: {}, {} of the tolerance used",
                        kept, conditions_text(scores.size()), nearest->id, percent(used)),
      nearest->id,
      {{"conditions", static_cast<double>(scores.size())},
       {"kept", static_cast<double>(kept)},
       {"tolerance_used", used}}));
}

/// Limits of the campaign that no scored condition could be held against.
void judge_unused_limits(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  const auto by_campaign = [&](const ConditionScore& score) {
    const datasets::Condition* condition = campaign.find(score.id);
    return condition != nullptr && !condition->acceptance && score.failure.empty() &&
           score.not_scored.empty();
  };
  if (std::none_of(fit.conditions.begin(), fit.conditions.end(), by_campaign)) return;
  for (const datasets::AcceptanceLimit& limit : campaign.acceptance) {
    const bool used =
        std::any_of(fit.conditions.begin(), fit.conditions.end(), [&](const auto& score) {
          return by_campaign(score) &&
                 std::any_of(score.checks.begin(), score.checks.end(), [&](const auto& check) {
                   return check.channel == limit.channel && check.metric == limit.metric;
                 });
        });
    if (used) continue;
    const auto key = datasets::info(limit.channel).key;
    reasons.push_back(reason(AspectState::fail, "limit_not_evaluable",
                             fmt::format("the limit of {} of {} was not evaluated: no condition "
                                         "recorded {}",
                                         limit.metric, key, key)));
  }
}

/// Recordings about which something was found doubtful.
void judge_recordings(const Fit& fit, std::vector<Reason>& reasons) {
  const ConditionScore* first = nullptr;
  std::size_t count = 0;
  for (const ConditionScore& score : fit.conditions) {
    if (score.data_warnings.empty()) continue;
    ++count;
    if (first == nullptr) first = &score;
  }
  if (first == nullptr) return;
  reasons.push_back(
      reason(AspectState::reservation, "recording_doubtful",
             fmt::format("recordings of {} are doubtful; {}: {}", conditions_text(count), first->id,
                         first->data_warnings.front()),
             first->id, {{"conditions", static_cast<double>(count)}}));
}

/// The least rho2 of all signals, where the campaign gives no limits.
void name_poor_agreement(const Fit& fit, std::vector<Reason>& reasons) {
  const ConditionScore* where = nullptr;
  const ChannelScore* worst = nullptr;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& channel : score.channels) {
      if (!channel.agreement) continue;
      if (worst != nullptr && channel.agreement->rho2 >= worst->agreement->rho2) continue;
      worst = &channel;
      where = &score;
    }
  }
  if (worst == nullptr) return;
  const double rho2 = worst->agreement->rho2;
  const bool poor = rho2 < kPoorRho2;
  reasons.push_back(reason(AspectState::not_assessed, poor ? "poor_agreement" : "least_agreement",
                           fmt::format("least agreement: rho2 = {:.4g} of {} in {}{}", rho2,
                                       datasets::info(worst->channel).key, where->id,
                                       poor ? ": the model does not describe this record" : ""),
                           where->id, {{"rho2", rho2}}));
}

Reason no_limits() {
  return reason(AspectState::not_assessed, "no_limits",
                "the campaign has no acceptance limits, so that nothing was judged");
}

bool has_limits(const Campaign& campaign, const Fit& fit) {
  return !campaign.acceptance.empty() ||
         std::any_of(fit.conditions.begin(), fit.conditions.end(),
                     [](const ConditionScore& score) { return score.verdict.has_value(); });
}

Aspect judge_agreement(const Campaign& campaign, const Fit& fit) {
  std::vector<Reason> reasons;
  if (!has_limits(campaign, fit)) {
    reasons.push_back(no_limits());
    name_poor_agreement(fit, reasons);
    return aspect_of(std::move(reasons));
  }
  std::vector<const ConditionScore*> scores;
  for (const ConditionScore& score : fit.conditions) scores.push_back(&score);
  judge_limits(scores, reasons);
  judge_unused_limits(campaign, fit, reasons);
  judge_recordings(fit, reasons);
  if (reasons.empty()) {
    reasons.push_back(
        reason(AspectState::not_assessed, "not_scored",
               scores.empty() ? "no condition was scored" : "no scored condition has a limit"));
  }
  return aspect_of(std::move(reasons));
}

Aspect judge_validation(const Campaign& campaign, const Fit& fit,
                        const std::set<std::string>& estimated_from) {
  std::vector<Reason> reasons;
  std::vector<const ConditionScore*> independent;
  for (const ConditionScore& score : fit.conditions) {
    if (!estimated_from.contains(score.id)) independent.push_back(&score);
  }
  if (independent.empty()) {
    std::string words =
        "none: every condition that was scored is one that the values were estimated from";
    if (!fit.cross_validation.empty())
      words += "; left out one after the other, see the cross-validation";
    reasons.push_back(
        reason(AspectState::not_assessed, "no_validation", words, {}, {{"conditions", 0.0}}));
  } else if (!has_limits(campaign, fit)) {
    reasons.push_back(no_limits());
  } else {
    judge_limits(independent, reasons);
    if (reasons.empty()) {
      reasons.push_back(reason(AspectState::not_assessed, "not_scored",
                               "no condition of the validation has a limit"));
    }
  }
  return aspect_of(std::move(reasons));
}

/// Standard deviation of the model's error over that of the noise.
double model_error(const LackOfFit& test) { return std::sqrt(std::max(0.0, test.ratio - 1.0)); }

std::string signal_of(const std::string& condition, datasets::Channel channel) {
  return fmt::format("{} of {}", datasets::info(channel).key, condition);
}

/// What the records of known noise say.
void judge_lack_of_fit(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  /// A residual of less than half of the stated noise means that this is stated too large, and
  /// nothing is judged by it.
  constexpr double kOverstated = 0.25;
  const double bound = campaign.acceptance_bounds.model_error_to_noise;
  const auto& tests = fit.lack_of_fit;
  if (tests.empty()) return;
  std::vector<const LackOfFit*> beyond;
  std::vector<const LackOfFit*> overstated;
  std::vector<const LackOfFit*> powerless;
  double largest = 0.0;
  for (const LackOfFit& test : tests) {
    if (test.failed() && model_error(test) > bound) beyond.push_back(&test);
    if (!test.passed() && !test.failed()) powerless.push_back(&test);
    if (test.ratio < kOverstated && !test.by_repeats) overstated.push_back(&test);
    largest = std::max(largest, model_error(test));
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
               fmt::format("the residual of {} is {} times the noise that `sd` states: by an "
                           "overstated noise a lack of fit is not seen",
                           signal_of(first.condition, first.channel),
                           significant(std::sqrt(first.ratio), 2)),
               first.condition, {{"residual_to_noise", std::sqrt(first.ratio)}}));
  }
  if (!powerless.empty()) {
    const LackOfFit& first = *powerless.front();
    reasons.push_back(reason(
        AspectState::reservation, "lack_of_fit_not_judged",
        fmt::format("lack of fit of {} of {} signals cannot be judged; {}: {}", powerless.size(),
                    tests.size(), signal_of(first.condition, first.channel), first.reason),
        first.condition, {{"signals", static_cast<double>(powerless.size())}}));
  }
  if (beyond.empty() && overstated.empty() && powerless.empty()) {
    reasons.push_back(
        reason(AspectState::pass, "no_lack_of_fit",
               fmt::format("no lack of fit beyond what is allowed in {} signal{} of known noise: "
                           "model error at most {:.2g} times the noise ({:.2g} allowed)",
                           tests.size(), tests.size() == 1 ? "" : "s", largest, bound),
               {},
               {{"signals", static_cast<double>(tests.size())},
                {"model_error_to_noise", largest},
                {"allowed", bound}}));
  }
}

/// A signal whose noise nothing tells, so that its residual alone can speak.
struct UnjudgedSignal {
  const ConditionScore* condition = nullptr;
  const ChannelScore* channel = nullptr;
};

std::vector<UnjudgedSignal> signals_of_unknown_noise(const Fit& fit) {
  std::vector<UnjudgedSignal> result;
  for (const ConditionScore& score : fit.conditions) {
    for (const ChannelScore& channel : score.channels) {
      const bool known =
          std::any_of(fit.lack_of_fit.begin(), fit.lack_of_fit.end(), [&](const auto& test) {
            return test.condition == score.id && test.channel == channel.channel;
          });
      if (!known) result.push_back({&score, &channel});
    }
  }
  return result;
}

/// The residual that the input explains most, of those given.
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
                  count > 1 ? fmt::format(", likewise in {} other signal{}", count - 1,
                                          count == 2 ? "" : "s")
                            : ""),
      worst->condition->id, {{"share", largest}, {"signals", static_cast<double>(count)}}));
}

/// What the records of unknown noise say.
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
  const std::string unknown = fmt::format("neither repeats nor `sd` tell the noise of {} signal{}",
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

Aspect judge_adequacy(const Campaign& campaign, const Fit& fit) {
  std::vector<Reason> reasons;
  judge_lack_of_fit(campaign, fit, reasons);
  judge_residuals(signals_of_unknown_noise(fit), reasons);
  if (reasons.empty())
    reasons.push_back(reason(AspectState::not_assessed, "not_scored", "no condition was scored"));
  return aspect_of(std::move(reasons));
}

/// The largest size that a parameter has in the result at another level, condition or known value.
double elsewhere(const Fit& fit, const FittedParameter& parameter) {
  double largest = 0.0;
  for (const FittedParameter& each : fit.parameters) {
    if (&each == &parameter || each.index != parameter.index) continue;
    if (each.identifiability == Identifiability::bounded) continue;
    largest = std::max(largest, std::abs(each.value));
  }
  return largest;
}

/// The largest size that a parameter which cannot be told from zero may have (95 %).
double upper_limit(const FittedParameter& parameter) {
  return parameter.ci95
             ? std::max(std::abs(parameter.ci95->first), std::abs(parameter.ci95->second))
             : HUGE_VAL;
}

Reason judge_bounded(const Campaign& campaign, const Fit& fit, const FittedParameter& parameter,
                     const std::string& name) {
  const double limit = upper_limit(parameter);
  const auto& stated = campaign.acceptance_bounds.negligible;
  const auto own = stated.find(parameter.index);
  const double allowed =
      own != stated.end() ? own->second : kNegligibleShare * elsewhere(fit, parameter);
  const bool negligible = limit <= allowed;
  std::string words = name + ": " + parameter.reason;
  if (negligible) {
    words += own != stated.end() ? ", negligible as [acceptance.negligible] states"
                                 : ", negligible beside its values elsewhere in the campaign";
  } else if (own != stated.end()) {
    words += ", more than [acceptance.negligible] allows";
  } else {
    words += "; [acceptance.negligible] may state what would not matter";
  }
  return reason(negligible ? AspectState::pass : AspectState::reservation, "bounded", words, name,
                {{"upper_limit", limit}, {"allowed", allowed}});
}

Aspect judge_parameters(const Campaign& campaign, const Fit& fit) {
  const auto table = model::parameter_table(campaign.rig.plant);
  std::vector<Reason> reasons;
  if (!fit.has_converged())
    reasons.push_back(reason(AspectState::reservation, "not_converged", fit.message));
  std::size_t estimated = 0;
  std::size_t identified = 0;
  for (const FittedParameter& each : fit.parameters) {
    if (!each.fitted || each.nuisance) continue;
    ++estimated;
    const std::string name =
        parameter_name(table[static_cast<std::size_t>(each.index)], each.scope, each.level);
    const bool active = each.at_bound && each.identifiability != Identifiability::bounded;
    if (each.identifiability == Identifiability::bounded) {
      reasons.push_back(judge_bounded(campaign, fit, each, name));
    } else if (each.identifiability == Identifiability::identified && !active) {
      ++identified;
    } else {
      const char* code = each.identifiability == Identifiability::not_identifiable
                             ? "not_identifiable"
                         : active ? "active_bound"
                                  : "weak";
      reasons.push_back(reason(AspectState::reservation, code, name + ": " + each.reason, name));
    }
  }
  if (fit.starts.size() > 1 && !fit.basins.empty() && fit.basins.front().starts.size() < 2) {
    reasons.push_back(reason(AspectState::reservation, "found_once",
                             "only one of several starts ended at this point: " + fit.agreement, {},
                             {{"starts", static_cast<double>(fit.starts.size())}}));
  }
  if (estimated == 0) {
    reasons.push_back(reason(AspectState::pass, "stated_values",
                             "no parameter was estimated: the values are those of the campaign"));
  } else if (identified > 0) {
    reasons.push_back(reason(AspectState::pass, "identified",
                             fmt::format("{} of {} estimated parameter{} identified", identified,
                                         estimated, estimated == 1 ? " is" : "s are"),
                             {},
                             {{"identified", static_cast<double>(identified)},
                              {"estimated", static_cast<double>(estimated)}}));
  }
  return aspect_of(std::move(reasons));
}

}  // namespace

std::string_view to_string(AspectState state) {
  switch (state) {
    case AspectState::pass:
      return "pass";
    case AspectState::reservation:
      return "reservation";
    case AspectState::fail:
      return "fail";
    case AspectState::not_assessed:
      return "not_assessed";
  }
  return "";
}

Assessment assess(const Campaign& campaign, const Fit& fit,
                  const std::set<std::string>& estimated_from, const Aspect* parameters) {
  return {judge_agreement(campaign, fit), judge_validation(campaign, fit, estimated_from),
          judge_adequacy(campaign, fit),
          parameters != nullptr ? *parameters : judge_parameters(campaign, fit)};
}

std::optional<Verdict> verdict_of(const Assessment& assessment) {
  const auto& [agreement, validation, adequacy, parameters] = assessment;
  if (agreement.state == AspectState::not_assessed) return std::nullopt;
  if (agreement.state == AspectState::fail || validation.state == AspectState::fail)
    return Verdict::fail;
  const bool all = validation.state == AspectState::pass && adequacy.state == AspectState::pass &&
                   parameters.state == AspectState::pass && agreement.state == AspectState::pass;
  return all ? Verdict::pass : Verdict::warn;
}

}  // namespace rigcal::calib
