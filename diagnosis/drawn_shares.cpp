#include "diagnosis/drawn_shares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "calib/posterior/chains.hpp"
#include "common/error.hpp"
#include "common/parallel.hpp"
#include "diagnosis/record/duty.hpp"
#include "diagnosis/record/steady_leak.hpp"

namespace rigcal::diagnosis {
namespace {

std::size_t duty_of(const calib::Problem& problem) {
  std::vector<const datasets::Condition*> all;
  for (const calib::ProblemCondition& each : problem.conditions) all.push_back(each.condition);
  const auto named = duty_among(all, problem.campaign->diagnosis.duty);
  return named ? *named : duty_among(all, "").value();
}

/// Returns a condition in which an unknown acts: the duty if possible, otherwise the first one.
std::size_t condition_with(const calib::Problem& problem, int unknown, std::size_t duty) {
  const auto acts_in = [&](std::size_t condition) {
    const std::vector<int>& acting = problem.map.acting(condition);
    return std::find(acting.begin(), acting.end(), unknown) != acting.end();
  };
  std::size_t found = 0;
  while (found + 1 < problem.conditions.size() && !acts_in(found)) ++found;
  return acts_in(duty) ? duty : found;
}

/// @param shares  one for each draw that could be simulated, at least one
calib::DrawnShare summary_of(const std::vector<double>& shares,
                             const datasets::DiagnosisSettings& settings) {
  calib::DrawnShare result;
  result.draws = static_cast<int>(shares.size());
  result.leak_share_percent = 100.0 * calib::quantile_of(shares, 0.5);
  result.leak_share_ci95_percent = {100.0 * calib::quantile_of(shares, 0.025),
                                    100.0 * calib::quantile_of(shares, 0.975)};
  for (const datasets::LeakClass each : datasets::kLeakClasses) {
    const auto count = std::count_if(shares.begin(), shares.end(), [&](double share) {
      return datasets::class_of(settings, share) == each;
    });
    result.class_probabilities.emplace_back(
        datasets::to_string(each), static_cast<double>(count) / static_cast<double>(shares.size()));
  }
  return result;
}

}  // namespace

std::vector<calib::DrawnShare> drawn_shares(const calib::Problem& problem,
                                            const std::vector<std::vector<double>>& draws,
                                            int threads, const calib::Budget& left) {
  const datasets::Campaign& campaign = *problem.campaign;
  const int leak = model::parameter_index(campaign.rig.plant, "leakage_coefficient");
  const std::size_t duty = duty_of(problem);
  std::vector<calib::DrawnShare> result;
  for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j) {
    const calib::Unknown& unknown = problem.map.unknowns()[j];
    if (unknown.index != leak) continue;
    const std::size_t own = condition_with(problem, static_cast<int>(j), duty);
    std::vector<double> shares(draws.size(), std::numeric_limits<double>::quiet_NaN());
    parallel_for(draws.size(), threads, [&](std::size_t k) {
      if (left.interrupted()) return;
      try {
        shares[k] = steady_leak(problem, problem.conditions[duty], problem.values_at(own, draws[k]),
                                {}, left.cancel())
                        .share;
      } catch (const NoResultError&) {  // the draw is left out
      }
    });
    if (left.interrupted()) return {};
    std::erase_if(shares, [](double share) { return !std::isfinite(share); });
    if (shares.empty()) continue;
    calib::DrawnShare& found = result.emplace_back(summary_of(shares, campaign.diagnosis));
    found.level = unknown.level;
    found.condition = problem.conditions[duty].condition->id;
  }
  return result;
}

}  // namespace rigcal::diagnosis
