#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "calib/score/judges.hpp"
#include "common/readable.hpp"
#include "common/significant.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;

/// An upper limit is negligible if it is below this fraction of the same parameter's value
/// elsewhere in the campaign. Estimates with half-widths above the same fraction are called weak.
constexpr double kNegligibleShare = 0.2;

/// Returns the largest absolute value of the same parameter at other levels or in other conditions,
/// fitted or known.
double elsewhere(const Fit& fit, const FittedParameter& parameter) {
  double largest = 0.0;
  for (const FittedParameter& each : fit.parameters) {
    if (&each == &parameter || each.index != parameter.index) continue;
    if (each.identifiability == Identifiability::bounded) continue;
    largest = std::max(largest, std::abs(each.value));
  }
  return largest;
}

/// Returns the upper 95 % limit on the absolute value of a parameter that is indistinguishable from
/// zero.
double upper_limit(const FittedParameter& parameter) {
  return parameter.ci95 ? std::max(std::abs(parameter.ci95->low), std::abs(parameter.ci95->high))
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
    words += own != stated.end()
                 ? ", negligible as [acceptance.negligible] states"
                 : ", negligible compared with its values elsewhere in the campaign";
  } else if (own != stated.end()) {
    words += ", more than [acceptance.negligible] allows";
  } else {
    words += "; if this is negligible, say so in [acceptance.negligible]";
  }
  return reason(negligible ? AspectState::pass : AspectState::reservation, "bounded", words, name,
                {{"upper_limit", limit}, {"allowed", allowed}});
}

/// Notes the known values that are treated as exact because the campaign states no `prior_sd` for
/// them.
void note_exact_values(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  std::set<int> uncertain;
  for (const FittedParameter& each : fit.parameters) {
    if (each.fitted) uncertain.insert(each.index);
  }
  for (const datasets::ParameterSetting& setting : campaign.parameters) {
    if (setting.prior) uncertain.insert(setting.index);
  }
  std::vector<std::string> names;
  std::set<int> seen;
  for (const FittedParameter& each : fit.parameters) {
    const model::ParameterSpec& spec = model::parameter_spec(campaign.rig.plant, each.index);
    if (uncertain.contains(each.index) || !spec.can_be_fitted ||
        spec.kind == model::ParameterKind::initial || !seen.insert(each.index).second) {
      continue;
    }
    names.push_back(each.key);
  }
  if (names.empty()) return;
  reasons.push_back(
      reason(AspectState::note, "exact_values",
             fmt::format("conditional on {} known value{} taken as exact: {}; an error in one can "
                         "shift estimates by a similar fraction unseen, and prior_sd states how "
                         "large it may be",
                         names.size(), names.size() == 1 ? "" : "s", fmt::join(names, ", ")),
             {}, {{"values", static_cast<double>(names.size())}}));
}

/// Returns true if only one of several starts ended at the result.
bool found_once(const Fit& fit) {
  const bool several = fit.starts.size() > 1 && !fit.basins.empty();
  return several && fit.basins.front().starts.size() < 2 &&
         !(fit.further_starts && fit.further_starts->as_low > 0);
}

/// Notes how many further starts a fit with a single start evaluated, and where they led.
void note_further_starts(const Fit& fit, std::vector<Reason>& reasons) {
  if (!fit.further_starts || fit.further_starts->looked_at == 0) return;
  const FurtherStarts& looks = *fit.further_starts;
  std::string words =
      fmt::format("{} further start{} tried with coarse simulations: ", looks.looked_at,
                  looks.looked_at == 1 ? " was" : "s were");
  if (fit.best_start > 1) {
    words += "one reached a lower cost than the start of the campaign and gave the result";
  } else {
    words += "none reached a lower cost";
  }
  if (looks.as_low > 0) words += fmt::format(", {} the same", looks.as_low);
  reasons.push_back(reason(AspectState::note, "further_starts", words, {},
                           {{"looked_at", static_cast<double>(looks.looked_at)},
                            {"followed", static_cast<double>(looks.followed)},
                            {"as_low", static_cast<double>(looks.as_low)}}));
}

/// Formats the size of an effect in a readable unit.
std::string readable_size(double value, const std::string& unit) {
  if (unit == "1") return significant(100.0 * value, 2) + " %";
  return readable(value, unit, 2);
}

double half_width_if_exact(const FittedParameter& parameter) {
  if (!parameter.ci95_if_exact) return HUGE_VAL;
  return 0.5 * (parameter.ci95_if_exact->high - parameter.ci95_if_exact->low);
}

/// Names other effects that explain almost as much as the missing one, with their weights: "; lag
/// of the position sensor would explain nearly as much (weight 0.3)".
std::string alternatives_text(const Considered& considered) {
  constexpr double kNegligibleWeight = 0.05;
  std::vector<std::string> words;
  for (const RefittedModel& each : considered.refitted) {
    if (each.effects.empty() || each.effects == considered.missing ||
        each.weight < kNegligibleWeight)
      continue;
    std::vector<std::string> names;
    for (const std::string& key : each.effects) names.push_back(considered.find(key)->meaning);
    words.push_back(
        fmt::format("{} (weight {})", fmt::join(names, " with "), significant(each.weight, 2)));
  }
  if (words.empty()) return {};
  return fmt::format("; the records hardly separate it from {}", fmt::join(words, ", "));
}

/// Reports effects that the residuals call for. Expresses a reservation if such an effect would
/// move an estimate out of the interval that assumes an exact model.
void judge_missing(const Fit& fit, std::vector<Reason>& reasons) {
  std::vector<std::string> moved;
  for (const FittedParameter& each : fit.parameters) {
    if (each.fitted && !each.nuisance && each.moved_by_missing > half_width_if_exact(each))
      moved.push_back(parameter_label(each.key, each.scope, each.level));
  }
  for (const std::string& key : fit.considered->missing) {
    const ConsideredEffect& effect = *fit.considered->find(key);
    const double alone = effect.alone.value_or(0.0);
    const double half = effect.alone_half_width.value_or(0.0);
    reasons.push_back(reason(
        moved.empty() ? AspectState::note : AspectState::reservation, "missing_effect",
        fmt::format(
            "the residuals indicate a term that the model lacks: {} ({}) of {} ({} to {}){}{}",
            effect.meaning, effect.key, readable_size(alone, effect.unit),
            readable_size(alone - half, effect.unit), readable_size(alone + half, effect.unit),
            moved.empty()
                ? std::string()
                : fmt::format(
                      "; it would change {} by more than half of the interval for an exact model",
                      fmt::join(moved, ", ")),
            key == fit.considered->missing.front() ? alternatives_text(*fit.considered)
                                                   : std::string()),
        effect.key,
        {{"size", alone},
         {"low", alone - half},
         {"high", alone + half},
         {"p", effect.p_of_all.value_or(1.0)}}));
  }
}

/// Judges whether the validation records alone lead to the same estimates.
void judge_stability(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  if (!fit.stability || fit.stability->empty()) return;
  std::vector<std::string> words;
  for (const StabilityCheck& each : *fit.stability) {
    if (!each.differs) continue;
    const int row = model::parameter_index(campaign.rig.plant, each.key);
    const auto& spec = model::parameter_spec(campaign.rig.plant, row);
    const ReadableUnit unit = readable_unit(each.value, spec.unit);
    words.push_back(fmt::format(
        "{} {} ({}{}, {} allowed)", parameter_label(each.key, each.scope, each.level),
        readable(each.value, spec.unit, 4), each.difference < 0.0 ? "" : "+",
        significant(each.difference / unit.si, 2), significant(each.expanded / unit.si, 2)));
  }
  const std::vector<std::pair<std::string, double>> numbers{
      {"differ", static_cast<double>(words.size())},
      {"estimated", static_cast<double>(fit.stability->size())}};
  if (words.empty()) {
    reasons.push_back(
        reason(AspectState::pass, "stable",
               "estimates from the validation records alone agree within the uncertainty of both",
               {}, numbers));
  } else {
    reasons.push_back(
        reason(AspectState::reservation, "unstable",
               fmt::format("{} of {} estimates differ significantly from those of the validation "
                           "records alone: {}",
                           words.size(), fit.stability->size(), fmt::join(words, ", ")),
               {}, numbers));
  }
}

double half_width(const FittedParameter& parameter) {
  return parameter.ci95 ? 0.5 * (parameter.ci95->high - parameter.ci95->low) : HUGE_VAL;
}

/// Judges model error that is in the residuals although no effect explains it. It could act in
/// phase with the sensitivity of an estimate.
void judge_unexplained(const FittedParameter& estimate, std::vector<Reason>& reasons) {
  const double times = estimate.moved_by_unexplained / half_width(estimate);
  if (!(times > 1.0)) return;
  const std::string name = parameter_label(estimate.name, estimate.scope, estimate.level);
  reasons.push_back(reason(
      AspectState::reservation, "unexplained_error",
      fmt::format("{}: the model error visible in the residuals, which no small effect explains, "
                  "could shift it by up to {} times the half width of its interval",
                  parameter_label(estimate.key, estimate.scope, estimate.level),
                  significant(times, 2)),
      name, {{"times_half_width", times}}));
}

/// Notes how far a model error that is tolerated, and too small for the residuals to show it, could
/// move an estimate beyond its interval. It is not a reservation, because a correct model would
/// have it as well (docs/decisions/0066-unseen-error.md).
void note_unseen(const Fit& fit, std::vector<Reason>& reasons) {
  const FittedParameter* worst = nullptr;
  double times = 1.0;
  for (const FittedParameter& each : fit.parameters) {
    if (!each.fitted || each.nuisance || !(each.moved_by_unseen > times * half_width(each)))
      continue;
    worst = &each;
    times = each.moved_by_unseen / half_width(each);
  }
  if (worst == nullptr) return;
  const std::string name = parameter_label(worst->name, worst->scope, worst->level);
  reasons.push_back(reason(
      AspectState::note, "unseen_error",
      fmt::format("a model error too small to be seen in the residuals could shift {} by up to {} "
                  "times the half width of its interval, if it acted exactly like that parameter",
                  parameter_label(worst->key, worst->scope, worst->level), significant(times, 2)),
      name, {{"times_half_width", times}}));
}

/// Judges how small effects that the model omits change the estimates.
void judge_considered(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  if (!fit.considered) return;
  judge_missing(fit, reasons);
  for (const FittedParameter& each : fit.parameters) {
    if (each.fitted && !each.nuisance) judge_unexplained(each, reasons);
  }
  if (!fit.considered->left_out.empty()) {
    reasons.push_back(
        reason(AspectState::reservation, "effects_left_out",
               campaign.considered.none
                   ? std::string("the campaign treats the model as exact, so the intervals do not "
                                 "include effects that the model lacks")
                   : fmt::format("small effects not considered, by choice of the campaign: {}",
                                 fmt::join(fit.considered->left_out, ", ")),
               {}, {{"effects", static_cast<double>(fit.considered->left_out.size())}}));
  }
}

/// Judges whether the posterior draws are reliable.
void judge_posterior(const Fit& fit, std::vector<Reason>& reasons) {
  if (!fit.posterior || fit.posterior->draws == 0) return;
  const Posterior& found = *fit.posterior;
  if (!found.mixed()) {
    reasons.push_back(reason(
        AspectState::reservation, "posterior_not_mixed",
        fmt::format("the chains of the posterior disagree: R-hat {} of {}, expected at most {}",
                    significant(found.r_hat, 4), found.worst.value_or(""), Posterior::kMostRHat),
        found.worst.value_or(""), {{"r_hat", found.r_hat}, {"allowed", Posterior::kMostRHat}}));
  }
  if (found.diverged > 0) {
    reasons.push_back(reason(
        AspectState::reservation, "posterior_divergences",
        fmt::format("{} of {} draws of the posterior diverged: the sampler may have missed a part "
                    "of it",
                    found.diverged, found.chains * found.draws),
        {},
        {{"diverged", static_cast<double>(found.diverged)},
         {"draws", static_cast<double>(found.chains * found.draws)}}));
  }
}

}  // namespace

Aspect judge_parameters(const Campaign& campaign, const Fit& fit) {
  // Intervals and grades are valid only at a minimum.
  if (!fit.has_converged())
    return aspect_of({reason(AspectState::reservation, "not_converged", fit.message)});
  std::vector<Reason> reasons;
  std::size_t estimated = 0;
  std::size_t identified = 0;
  for (const FittedParameter& each : fit.parameters) {
    if (!each.fitted || each.nuisance) continue;
    ++estimated;
    const std::string name = parameter_label(each.name, each.scope, each.level);
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
      reasons.push_back(
          reason(AspectState::reservation, code,
                 parameter_label(each.key, each.scope, each.level) + ": " + each.reason, name));
    }
  }
  if (found_once(fit)) {
    reasons.push_back(reason(AspectState::reservation, "found_once",
                             "only one of several starts converged to this point: " + fit.agreement,
                             {}, {{"starts", static_cast<double>(fit.starts.size())}}));
  }
  if (estimated == 0) {
    reasons.push_back(reason(AspectState::pass, "stated_values",
                             "no parameter was estimated: the values are those of the campaign"));
  } else if (identified > 0) {  // first, since it sums up the others
    reasons.insert(reasons.begin(),
                   reason(AspectState::pass, "identified",
                          fmt::format("{} of {} estimated parameter{} identified", identified,
                                      estimated, estimated == 1 ? " is" : "s are"),
                          {},
                          {{"identified", static_cast<double>(identified)},
                           {"estimated", static_cast<double>(estimated)}}));
  }
  note_further_starts(fit, reasons);
  judge_considered(campaign, fit, reasons);
  judge_stability(campaign, fit, reasons);
  judge_posterior(fit, reasons);
  note_unseen(fit, reasons);
  note_exact_values(campaign, fit, reasons);
  return aspect_of(std::move(reasons));
}

}  // namespace rigcal::calib
