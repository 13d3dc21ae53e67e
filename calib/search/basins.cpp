#include "calib/search/basins.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace rigcal::calib {
namespace {

/// Fraction of a 95 % interval, equal to 0.4 standard errors; searches end within 0.05 standard
/// errors of the minimum.
constexpr double kSamePoint = 0.1;
/// Fraction of the variance of a residual, equal to half the square of 0.2 standard errors.
constexpr double kSameCost = 0.02;
/// Fraction of the cost by which two simulations of the same point may differ.
constexpr double kSimulated = 2e-6;

bool same_point(const std::vector<double>& a, const std::vector<double>& b,
                const std::vector<FittedParameter>& parameters) {
  for (std::size_t j = 0; j < a.size() && j < parameters.size(); ++j) {
    const auto& interval = parameters[j].ci95;
    if (!interval) continue;
    if (std::abs(a[j] - b[j]) > kSamePoint * (interval->high - interval->low)) return false;
  }
  return true;
}

}  // namespace

bool same_cost(double a, double b, double variance) {
  return std::abs(a - b) <= std::max(kSameCost * variance, kSimulated * std::min(a, b));
}

bool better_start(const StartReport& a, const StartReport& b, double variance) {
  const bool a_converged = a.status == FitStatus::converged;
  const bool b_converged = b.status == FitStatus::converged;
  if (a_converged != b_converged && same_cost(a.final_cost, b.final_cost, variance))
    return a_converged;
  return a.final_cost < b.final_cost;
}

std::vector<Basin> basins(const std::vector<StartReport>& starts,
                          const std::vector<FittedParameter>& parameters, double variance) {
  std::vector<const StartReport*> converged;
  for (const StartReport& start : starts) {
    if (start.status == FitStatus::converged) converged.push_back(&start);
  }
  std::stable_sort(converged.begin(), converged.end(),
                   [](const auto* a, const auto* b) { return a->final_cost < b->final_cost; });
  std::vector<Basin> result;
  for (const StartReport* start : converged) {
    const auto home = std::find_if(result.begin(), result.end(), [&](const Basin& basin) {
      return same_cost(start->final_cost, basin.cost, variance) &&
             same_point(start->end_values, basin.values, parameters);
    });
    if (home != result.end()) {
      home->starts.push_back(start->number);
    } else {
      result.push_back({start->final_cost, {start->number}, start->end_values});
    }
  }
  return result;
}

std::string agreement_of(const std::vector<StartReport>& starts, const std::vector<Basin>& basins,
                         double variance) {
  if (starts.size() < 2) return {};
  if (basins.empty()) return fmt::format("none of {} starts converged", starts.size());
  const auto lowest = std::min_element(starts.begin(), starts.end(),
                                       [](const StartReport& a, const StartReport& b) {
                                         return std::pair(a.end_values.empty(), a.final_cost) <
                                                std::pair(b.end_values.empty(), b.final_cost);
                                       });
  if (lowest->final_cost < basins.front().cost &&
      !same_cost(lowest->final_cost, basins.front().cost, variance)) {
    return fmt::format(
        "start {} of {} has the lowest cost but did not converge; the best converged one, start "
        "{}, has a cost higher by {:.3g} (2 corresponds to the 95 % interval of one parameter)",
        lowest->number, starts.size(), basins.front().starts.front(),
        (basins.front().cost - lowest->final_cost) / std::max(variance, 1e-300));
  }
  const auto unfinished = std::count_if(starts.begin(), starts.end(), [](const StartReport& start) {
    return start.status != FitStatus::converged;
  });
  std::string text = fmt::format("{} of {} starts converged to the best point",
                                 basins.front().starts.size(), starts.size());
  if (basins.size() > 1) {
    const double rise = (basins[1].cost - basins.front().cost) / std::max(variance, 1e-300);
    text += fmt::format(
        "; {} other {}, the next with a cost higher by {:.3g} (2 corresponds to the 95 % interval "
        "of one parameter)",
        basins.size() - 1, basins.size() == 2 ? "minimum" : "minima", rise);
  }
  if (unfinished > 0) text += fmt::format("; {} did not converge", unfinished);
  if (basins.front().starts.size() == 1)
    text += "; no other start confirms the best point: use more starts";
  return text;
}

}  // namespace rigcal::calib
