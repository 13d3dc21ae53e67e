#include "calib/score/judge_parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "calib/problem/parameter_map.hpp"

namespace rigcal::calib {
namespace {

using datasets::Campaign;

/// An upper limit is negligible below this fraction of the same parameter's value elsewhere in the
/// campaign; it is the fraction that makes an estimate weak.
constexpr double kNegligibleShare = 0.2;

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

/// Largest possible size (95 %) of a parameter that is not distinguishable from zero.
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

/// Notes the known values that the estimates take as exact: those for which `prior_sd` could state
/// an uncertainty and does not.
void note_exact_values(const Campaign& campaign, const Fit& fit, std::vector<Reason>& reasons) {
  const auto table = model::parameter_table(campaign.rig.plant);
  std::set<int> uncertain;
  for (const FittedParameter& each : fit.parameters) {
    if (each.fitted) uncertain.insert(each.index);
  }
  for (const datasets::ParameterSetting& setting : campaign.parameters) {
    if (setting.prior) uncertain.insert(setting.index);
  }
  std::vector<std::string_view> names;
  std::set<int> seen;
  for (const FittedParameter& each : fit.parameters) {
    const model::ParameterSpec& spec = table[static_cast<std::size_t>(each.index)];
    if (uncertain.contains(each.index) || !spec.can_be_fitted ||
        spec.kind == model::ParameterKind::initial || !seen.insert(each.index).second) {
      continue;
    }
    names.push_back(spec.key);
  }
  if (names.empty()) return;
  reasons.push_back(
      reason(AspectState::note, "exact_values",
             fmt::format("conditional on {} known value{} taken as exact: {}", names.size(),
                         names.size() == 1 ? "" : "s", fmt::join(names, ", ")),
             {}, {{"values", static_cast<double>(names.size())}}));
}

/// Whether only one of several starts ended at the result.
bool found_once(const Fit& fit) {
  const bool several = fit.starts.size() > 1 && !fit.basins.empty();
  return several && fit.basins.front().starts.size() < 2 &&
         !(fit.further_starts && fit.further_starts->as_low > 0);
}

/// Notes how many further starts a fit with one start evaluated, and where they led.
void note_further_starts(const Fit& fit, std::vector<Reason>& reasons) {
  if (!fit.further_starts || fit.further_starts->looked_at == 0) return;
  const FurtherStarts& looks = *fit.further_starts;
  std::string words =
      fmt::format("{} further start{} looked at with coarse simulations: ", looks.looked_at,
                  looks.looked_at == 1 ? " was" : "s were");
  if (fit.best_start > 1) {
    words += "one led lower than that of the campaign, and is the result";
  } else {
    words += "none led lower";
  }
  if (looks.as_low > 0) words += fmt::format(", {} as low", looks.as_low);
  reasons.push_back(reason(AspectState::note, "further_starts", words, {},
                           {{"looked_at", static_cast<double>(looks.looked_at)},
                            {"followed", static_cast<double>(looks.followed)},
                            {"as_low", static_cast<double>(looks.as_low)}}));
}

}  // namespace

Aspect judge_parameters(const Campaign& campaign, const Fit& fit) {
  const auto table = model::parameter_table(campaign.rig.plant);
  // Intervals and grades hold only at a minimum.
  if (!fit.has_converged())
    return aspect_of({reason(AspectState::reservation, "not_converged", fit.message)});
  std::vector<Reason> reasons;
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
  if (found_once(fit)) {
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
  note_further_starts(fit, reasons);
  note_exact_values(campaign, fit, reasons);
  return aspect_of(std::move(reasons));
}

}  // namespace rigcal::calib
