#include "calib/search/obstacle.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "calib/problem/arrow_svd.hpp"

namespace rigcal::calib {
namespace {

/// A direction is a valley if a step along it changes the residuals by less than this fraction of
/// the change caused by a step in a single parameter.
constexpr double kValley = 0.1;
/// A parameter is named if it contributes at least this fraction of the squared length of the
/// valley's direction.
constexpr double kPart = 0.1;

/// Returns the unknowns that form a valley if most of the remaining step follows one; otherwise
/// empty.
std::vector<std::size_t> valley(const Problem& problem, Linearisation system,
                                const OptimumCheck& check) {
  system.hold(check.active_bound);
  const auto longest = ArrowSvd(system, rank_threshold(problem.tolerance)).longest_way();
  if (!longest || longest->singular_value > kValley) return {};
  Eigen::VectorXd parts = Eigen::VectorXd::Zero(system.unknowns());
  parts(longest->unknowns) = longest->parts.cwiseAbs2();
  std::vector<std::size_t> unknowns(problem.map.unknowns().size());
  std::iota(unknowns.begin(), unknowns.end(), std::size_t{0});
  const auto part = [&](std::size_t j) { return parts(static_cast<Eigen::Index>(j)); };
  std::stable_sort(unknowns.begin(), unknowns.end(),
                   [&](std::size_t a, std::size_t b) { return part(a) > part(b); });
  const auto end = std::find_if(unknowns.begin(), unknowns.end(),
                                [&](std::size_t j) { return part(j) < kPart; });
  return {unknowns.begin(), end};
}

}  // namespace

std::string far_from_minimum(const Problem& problem, const Evaluation& evaluation,
                             const OptimumCheck& check) {
  if (check.is_minimum() || !evaluation.ok) return {};
  std::string words = fmt::format(
      "; a step would lower the cost by {:.2g} times the variance of a residual (a minimum leaves "
      "{})",
      check.fall_left, kMinimumLeaves);
  const auto names = [&](const std::vector<std::size_t>& unknowns) {
    std::vector<std::string> result;
    for (const std::size_t j : unknowns) result.push_back(problem.name(j));
    return fmt::format("{}", fmt::join(result, ", "));
  };
  const auto along = valley(problem, linearise(problem, evaluation), check);
  if (along.size() == 1) {
    words += fmt::format(
        "; what is left of the way is along {}, which hardly moves the records: a prior or a known "
        "value would end it",
        names(along));
  } else if (along.size() > 1) {
    words += fmt::format(
        "; what is left of the way is a valley along {}, which the records hardly separate: a "
        "prior or a known value of one of them would end it",
        names(along));
  }
  std::vector<std::size_t> bounded;
  for (std::size_t j = 0; j < check.active_bound.size(); ++j) {
    if (check.active_bound[j]) bounded.push_back(j);
  }
  if (!bounded.empty()) {
    words += fmt::format(
        "; at a bound that the cost presses against: {}: a wider bound, a prior or a known value",
        names(bounded));
  }
  return words;
}

}  // namespace rigcal::calib
