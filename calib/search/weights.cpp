#include "calib/search/weights.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calib/problem/measured_tolerance.hpp"

namespace rigcal::calib {
namespace {

/// A warning is added if the standard deviations have not settled after this many rounds.
constexpr int kMaxRounds = 10;
/// Reweighting stops when no standard deviation changes by more than this fraction.
constexpr double kSettled = 0.1;

/// Calls action(channel, rms residual) for every channel whose noise is estimated.
template <typename Action>
void for_each_estimated(Problem& problem, const Evaluation& optimum, const Action& action) {
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    auto& channels = problem.conditions[i].channels;
    for (std::size_t k = 0; k < channels.size(); ++k) {
      if (!channels[k].sd_known) action(channels[k], optimum.conditions[i].rms[k]);
    }
  }
}

/// Returns the root mean square residual of each channel whose noise is estimated, over the samples
/// of all its conditions. With separate values for each condition, the record that the model
/// happens to fit best would get most of the weight, at the expense of the others.
std::map<datasets::Channel, double> pooled_rms(Problem& problem, const Evaluation& optimum) {
  struct Sum {
    double squares = 0.0;
    double samples = 0.0;
  };
  std::map<datasets::Channel, Sum> sums;
  for_each_estimated(problem, optimum, [&](const ProblemChannel& channel, double rms) {
    const auto samples = static_cast<double>(channel.measured.size());
    Sum& sum = sums[channel.channel];
    sum.squares += samples * rms * rms;
    sum.samples += samples;
  });
  std::map<datasets::Channel, double> pooled;
  for (const auto& [channel, sum] : sums) pooled[channel] = std::sqrt(sum.squares / sum.samples);
  return pooled;
}

/// Sets every estimated standard deviation to the pooled residual of its channel, and derives the
/// simulation tolerance from these values. Returns the largest relative change in a standard
/// deviation.
double update(Problem& problem, const Evaluation& optimum, int threads,
              const std::atomic<bool>* cancel) {
  const auto pooled = pooled_rms(problem, optimum);
  double largest = 0.0;
  const auto set = [&](ProblemChannel& channel, double) {
    const double sd = std::max(pooled.at(channel.channel), problem.least_sd(channel));
    largest = std::max(largest, std::abs(sd / channel.sd - 1.0));
    channel.sd = sd;
  };
  for_each_estimated(problem, optimum, set);
  if (!problem.tolerance_fixed) {
    // The tolerance never becomes coarser again, because each change alters the cost and moves its
    // minimum.
    problem.tolerance = std::min(problem.tolerance, tolerance_from_noise(problem.conditions, true));
    for_each_estimated(problem, optimum, set);  // a finer simulation allows a smaller sd
    refine_tolerances(problem, optimum.z, threads, cancel);
  }
  return largest;
}

void warn(Problem& problem, const Evaluation& optimum, bool settled,
          std::vector<std::string>& warnings) {
  std::set<std::string> names;
  int estimated = 0;
  int unresolved = 0;
  double share = 0.0;
  const auto pooled = pooled_rms(problem, optimum);
  for_each_estimated(problem, optimum, [&](const ProblemChannel& channel, double) {
    names.emplace(datasets::info(channel.channel).key);
    ++estimated;
    if (pooled.at(channel.channel) >= problem.least_sd(channel)) return;
    ++unresolved;
    if (channel.peak_to_peak > 0.0)
      share = std::max(share, problem.least_sd(channel) / channel.peak_to_peak);
  });
  std::vector<std::string> where;
  for (const ProblemCondition& each : problem.conditions) {
    if (std::any_of(each.channels.begin(), each.channels.end(),
                    [](const ProblemChannel& channel) { return !channel.sd_known; }))
      where.push_back(fmt::format("\"{}\"", each.condition->id));
  }
  warnings.push_back(fmt::format(
      "without repeats and without `sd` the noise of {} was estimated from the residuals of the "
      "fit, one value per channel, over {}{}; model errors count as noise",
      fmt::join(names, ", "),
      where.size() == problem.conditions.size() ? std::string("all conditions")
                                                : fmt::format("{}", fmt::join(where, ", ")),
      settled ? "" : " (and had not settled when the fit ended)"));
  if (unresolved == 0) return;
  warnings.push_back(fmt::format(
      "in {} of {} records the residual is smaller than a simulation with tolerance {:.2g} can "
      "resolve: their standard deviation was set to {:.2g} of the peak-to-peak value",
      unresolved, estimated, problem.tolerance, share));
}

}  // namespace

void estimate_weights(Problem& problem, Evaluator& evaluator, const FitOptions& options,
                      MultiStart& found, std::vector<std::string>& warnings) {
  bool settled = false;
  for (int round = 0; round < kMaxRounds && !settled; ++round) {
    if (found.result.status != FitStatus::converged || evaluator.budget().spent()) break;
    const double change =
        update(problem, found.optimum, options.threads, evaluator.budget().cancel());
    settled = change <= kSettled;
    if (!search_on(problem, evaluator, options, found)) break;
  }
  if (!settled && evaluator.budget().spent() && found.result.status == FitStatus::converged) {
    found.result.status = FitStatus::stopped;
    found.result.message = "stopped before the noise was estimated";
  }
  warn(problem, found.optimum, settled, warnings);
  found.result.message += "; noise estimated from the residual";
}

}  // namespace rigcal::calib
