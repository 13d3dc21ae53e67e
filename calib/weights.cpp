#include "calib/weights.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace rigcal::calib {
namespace {

constexpr int kMaxRounds = 10;
constexpr double kSettled = 0.01;
constexpr double kLeastShare = 1e-6;

/// Sets every estimated standard deviation to the rms residual; returns the largest relative
/// change.
double update(Problem& problem, const Evaluation& optimum) {
  double largest = 0.0;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    auto& channels = problem.conditions[i].channels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      ProblemChannel& channel = channels[k];
      if (channel.sd_known) continue;
      const double range = channel.peak_to_peak > 0.0 ? channel.peak_to_peak : channel.sd;
      const double sd = std::max(optimum.conditions[i].rms[k], kLeastShare * range);
      largest = std::max(largest, std::abs(sd / channel.sd - 1.0));
      channel.sd = sd;
    }
  }
  return largest;
}

std::string channels_in_words(const Problem& problem) {
  std::set<std::string> names;
  for (const ProblemCondition& condition : problem.conditions) {
    for (const ProblemChannel& channel : condition.channels) {
      if (!channel.sd_known) names.emplace(datasets::info(channel.channel).key);
    }
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

void estimate_weights(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                      MultiStart& found, std::vector<std::string>& warnings) {
  bool settled = false;
  for (int round = 0; round < kMaxRounds && !settled; ++round) {
    if (found.result.status != FitStatus::converged || evaluator.aborted()) break;
    settled = update(problem, found.optimum) <= kSettled;
    evaluator.forget();
    const int iterations_before = found.result.iterations;
    found.result =
        solve(problem, evaluator, found.optimum.z, options.max_iterations, found.best, options);
    found.result.iterations += iterations_before;
    if (!evaluator.best().ok) break;
    found.optimum = evaluator.best();
  }
  warnings.push_back(fmt::format(
      "neither repeats nor `sd` tell the noise of {}: it was estimated from the residual of the "
      "fit "
      "in each condition{}; errors of the model count as noise",
      channels_in_words(problem), settled ? "" : " (and had not settled when the fit ended)"));
  found.result.message += "; noise estimated from the residual";
}

}  // namespace rigcal::calib
