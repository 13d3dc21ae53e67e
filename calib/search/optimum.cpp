#include "calib/search/optimum.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/problem/arrow_svd.hpp"

namespace rigcal::calib {
namespace {

/// Largest relative offset of a stationary point, in standard errors; see OptimumCheck.
constexpr double kStationary = 0.01;

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

BoundSide bound_side(double z) {
  if (z <= kAtBound) return BoundSide::lower;
  return z >= 1.0 - kAtBound ? BoundSide::upper : BoundSide::inside;
}

double rank_threshold(double simulation_tolerance) {
  return std::clamp(50.0 * simulation_tolerance, 1e-8, 1e-4);
}

bool OptimumCheck::stationary() const { return relative_offset <= kStationary && is_minimum(); }
bool OptimumCheck::is_minimum() const { return fall_left <= kMinimumLeaves; }

std::vector<bool> active_bounds(const Linearisation& system, std::span<const double> z) {
  const Eigen::VectorXd gradient = system.gradient();
  std::vector<bool> active;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const double slope = gradient(static_cast<Eigen::Index>(j));
    const BoundSide side = bound_side(z[j]);
    active.push_back((side == BoundSide::lower && slope > 0.0) ||
                     (side == BoundSide::upper && slope < 0.0));
  }
  return active;
}

OptimumCheck check_optimum(const Problem& problem, const Evaluation& evaluation) {
  Linearisation system = linearise(problem, evaluation);
  OptimumCheck check;
  check.active_bound = active_bounds(system, evaluation.z);
  for (const double z : evaluation.z) check.side.push_back(bound_side(z));
  system.hold(check.active_bound);
  const ArrowSvd svd(system, rank_threshold(problem.tolerance));
  check.step = svd.step();
  const auto rank = static_cast<double>(svd.rank());
  const double explained = svd.explained();
  const double all = system.square();
  const double residuals = evaluation.share * static_cast<double>(problem.residual_count());
  const double freedom = std::max(1.0, residuals - rank);
  const double unexplained = std::sqrt(std::max(0.0, all - explained));
  const double noise = std::max(problem.least_noise(), unexplained / std::sqrt(freedom));
  check.relative_offset = std::sqrt(explained / std::max(rank, 1.0)) / noise;
  check.fall_left = 0.5 * explained / (noise * noise);
  if (all > 0.0) check.reducible = explained / all;
  return check;
}

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
        "; the remaining step is along {}, which hardly affects the records: state a prior or a "
        "known value",
        names(along));
  } else if (along.size() > 1) {
    words += fmt::format(
        "; the remaining step is along a valley of {}, which the records hardly separate: state a "
        "prior or a known value of one of them",
        names(along));
  }
  std::vector<std::size_t> bounded;
  for (std::size_t j = 0; j < check.active_bound.size(); ++j) {
    if (check.active_bound[j]) bounded.push_back(j);
  }
  if (!bounded.empty()) {
    words += fmt::format("; at an active bound: {}: set a wider bound, a prior or a known value",
                         names(bounded));
  }
  return words;
}

}  // namespace rigcal::calib
