#include "datasets/checks/equal_runs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "datasets/checks/median.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kMotionSteps = 4.0;
constexpr double kShareOfRange = 1e-6;
constexpr double kLeastTurning = 0.05;
constexpr std::size_t kFewestTurns = 30;
constexpr std::size_t kBesideRun = 3;  // samples on each side of a run

}  // namespace

bool is_constant(std::span<const double> x) {
  return std::adjacent_find(x.begin(), x.end(), std::not_equal_to<>()) == x.end();
}

std::vector<EqualRun> equal_runs(std::span<const double> x) {
  std::vector<EqualRun> runs;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i > 0 && x[i] == x[i - 1])
      ++runs.back().length;
    else
      runs.push_back({i, 1, x[i]});
  }
  return runs;
}

double resolution(const std::vector<EqualRun>& runs) {
  double least = 0.0;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    const double step = std::abs(runs[k].value - runs[k - 1].value);
    if (least == 0.0 || step < least) least = step;
  }
  return least;
}

double typical_step(const std::vector<EqualRun>& runs) {
  std::vector<double> steps;
  steps.reserve(runs.size());
  for (std::size_t k = 1; k < runs.size(); ++k)
    steps.push_back(std::abs(runs[k].value - runs[k - 1].value));
  return steps.empty() ? 0.0 : median(std::move(steps));
}

bool cuts_a_motion(std::span<const double> x, const EqualRun& run, double least) {
  const bool has_before = run.begin >= kBesideRun;
  const bool has_after = run.end() + kBesideRun <= x.size();
  const bool arrives = !has_before || std::abs(x[run.begin - kBesideRun] - run.value) >= least;
  const bool leaves = !has_after || std::abs(x[run.end() - 1 + kBesideRun] - run.value) >= least;
  return (has_before || has_after) && arrives && leaves;
}

bool shows_noise(const std::vector<EqualRun>& runs, double low, double high) {
  if (runs.size() < 4) return false;
  const auto [smallest, largest] = std::minmax_element(
      runs.begin(), runs.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  // The factor allows for rounding of the resolution.
  const double least = 0.97 * std::max(kMotionSteps * resolution(runs),
                                       kShareOfRange * (largest->value - smallest->value));
  const auto step = [&](std::size_t k) { return runs[k].value - runs[k - 1].value; };
  const auto is_inside = [&](std::size_t k) { return runs[k].value > low && runs[k].value < high; };
  std::size_t turning = 0;
  std::size_t all = 0;
  for (std::size_t k = 2; k + 1 < runs.size(); ++k) {
    if (!is_inside(k - 2) || !is_inside(k - 1) || !is_inside(k) || !is_inside(k + 1)) continue;
    ++all;
    const double before = step(k) - step(k - 1);
    const double after = step(k) - step(k + 1);
    if (before * after > 0.0 && std::min(std::abs(before), std::abs(after)) > least) ++turning;
  }
  return turning >= kFewestTurns &&
         static_cast<double>(turning) >= kLeastTurning * static_cast<double>(all);
}

}  // namespace rigcal::datasets
