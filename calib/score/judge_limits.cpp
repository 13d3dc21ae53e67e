#include "calib/score/judge_limits.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calib/score/acceptance.hpp"

namespace rigcal::calib {
namespace {

double largest_use(const ConditionScore& score) {
  double used = 0.0;
  for (const LimitCheck& check : score.limit_checks)
    used = std::max(used, check.tolerance_used.value_or(0.0));
  return used;
}

/// Sorts scores by the used fraction of their tolerances, the worst first.
std::vector<const ConditionScore*> by_use(const std::vector<const ConditionScore*>& scores) {
  std::vector<const ConditionScore*> sorted = scores;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) {
    const auto key = [](const ConditionScore* s) {
      return std::pair(s->failure ? 1 : 0, largest_use(*s));
    };
    return key(a) > key(b);
  });
  return sorted;
}

}  // namespace

bool has_limits(const datasets::Campaign& campaign, const Fit& fit) {
  return !campaign.acceptance.empty() ||
         std::any_of(fit.conditions.begin(), fit.conditions.end(),
                     [](const ConditionScore& score) { return score.verdict.has_value(); });
}

Reason no_limits() {
  return reason(AspectState::not_assessed, "no_limits",
                "the campaign has no acceptance limits, so that nothing was judged");
}

void judge_limits(const std::vector<const ConditionScore*>& scores, std::vector<Reason>& reasons) {
  const ConditionScore* nearest = nullptr;
  std::size_t kept = 0;
  for (const ConditionScore* score : by_use(scores)) {
    const std::string words = fmt::format("{}: {}", score->id, fmt::join(score->reasons, "; "));
    const std::vector<std::pair<std::string, double>> numbers{
        {"tolerance_used", largest_use(*score)}};
    if (score->not_scored) {
      reasons.push_back(reason(AspectState::reservation, "not_scored",
                               fmt::format("{}: not scored ({})", score->id, *score->not_scored),
                               score->id));
    } else if (score->failure) {
      reasons.push_back(reason(AspectState::fail, "not_simulated", words, score->id));
    } else if (score->verdict == Verdict::fail) {
      const bool evaluated = std::all_of(score->limit_checks.begin(), score->limit_checks.end(),
                                         [](const LimitCheck& check) { return check.value; });
      reasons.push_back(reason(AspectState::fail,
                               evaluated ? "limit_broken" : "limit_not_evaluable", words, score->id,
                               numbers));
    } else if (score->verdict == Verdict::warn) {
      const bool guarded = std::all_of(
          score->limit_checks.begin(), score->limit_checks.end(), [](const LimitCheck& check) {
            return check.verdict != Verdict::warn || check.in_guard_band;
          });
      reasons.push_back(reason(AspectState::reservation, guarded ? "guard_band" : "limit_near",
                               words, score->id, numbers));
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
          ? fmt::format("{} meets its limits: {} of the tolerance used", nearest->id,
                        tolerance_used_text(used))
          : fmt::format("{} of {} meet their limits; tightest: {}, {} of the tolerance used", kept,
                        conditions_text(scores.size()), nearest->id, tolerance_used_text(used)),
      nearest->id,
      {{"conditions", static_cast<double>(scores.size())},
       {"kept", static_cast<double>(kept)},
       {"tolerance_used", used}}));
}

std::string conditions_text(std::size_t count) {
  return fmt::format("{} condition{}", count, count == 1 ? "" : "s");
}

}  // namespace rigcal::calib
