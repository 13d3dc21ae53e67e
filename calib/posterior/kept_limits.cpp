#include "calib/posterior/kept_limits.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "calib/posterior/chains.hpp"
#include "calib/problem/evaluation.hpp"
#include "common/parallel.hpp"
#include "metrics/metric_table.hpp"

namespace rigcal::calib {
namespace {

/// A limit in a condition, with the channel and the metric that it applies to.
struct Bound {
  std::size_t condition = 0;
  std::size_t channel = 0;
  const metrics::MetricSpec* metric = nullptr;
  double limit = 0.0;
};

std::vector<Bound> bounds_of(const Problem& problem) {
  std::vector<Bound> bounds;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    for (const auto& limit : problem.campaign->limits(*condition.condition)) {
      const auto metric = std::find_if(metrics::kMetrics.begin(), metrics::kMetrics.end(),
                                       [&](const auto& spec) { return spec.name == limit.metric; });
      if (!limit.limit || metric == metrics::kMetrics.end()) continue;
      for (std::size_t k = 0; k < condition.channels.size(); ++k) {
        if (condition.channels[k].channel == limit.channel)
          bounds.push_back({i, k, &*metric, *limit.limit});
      }
    }
  }
  return bounds;
}

/// Returns the metric for one simulation; NaN if it is undefined.
///
/// @param change  change in the weighted outputs, or empty
double score_of(const Bound& bound, const ProblemCondition& condition, const model::Simulation& run,
                const Eigen::VectorXd& change) {
  if (!run.ok()) return std::numeric_limits<double>::quiet_NaN();
  const ProblemChannel& channel = condition.channels[bound.channel];
  std::vector<double> simulated;
  for (const std::size_t row : condition.rows)
    simulated.push_back(
        run.outputs(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(bound.channel)));
  const auto first = static_cast<Eigen::Index>(bound.channel * simulated.size());
  for (std::size_t t = 0; t < simulated.size() && change.size() > 0; ++t)
    simulated[t] += channel.sd * change(first + static_cast<Eigen::Index>(t));
  try {
    return bound.metric->compute(channel.measured, simulated);
  } catch (const std::logic_error&) {  // the record is constant
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

std::vector<KeptLimit> kept_limits(const Problem& problem,
                                   const std::vector<std::vector<double>>& points,
                                   const ChangeOf& change, int threads,
                                   const std::atomic<bool>* cancel) {
  const std::vector<Bound> bounds = bounds_of(problem);
  if (bounds.empty() || points.empty()) return {};
  std::vector<std::vector<double>> scores(bounds.size(), std::vector<double>(points.size()));
  const Fidelity values_only{false, true};
  parallel_for(points.size(), threads, [&](std::size_t p) {
    for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
      const bool judged = std::any_of(bounds.begin(), bounds.end(),
                                      [i](const Bound& each) { return each.condition == i; });
      if (!judged || (cancel != nullptr && *cancel)) continue;
      const auto run = simulate_condition(problem, i, points[p], cancel, values_only);
      const Eigen::VectorXd by_effects = change ? change(i, p) : Eigen::VectorXd();
      for (std::size_t b = 0; b < bounds.size(); ++b) {
        if (bounds[b].condition == i)
          scores[b][p] = score_of(bounds[b], problem.conditions[i], run, by_effects);
      }
    }
  });
  if (cancel != nullptr && *cancel) return {};
  std::vector<KeptLimit> result;
  for (std::size_t b = 0; b < bounds.size(); ++b) {
    const Bound& bound = bounds[b];
    const ProblemCondition& condition = problem.conditions[bound.condition];
    const auto kept = std::count_if(scores[b].begin(), scores[b].end(), [&](double score) {
      return bound.metric->higher_is_better ? score >= bound.limit : score <= bound.limit;
    });
    std::vector<double> found;
    for (const double score : scores[b]) {
      if (std::isfinite(score)) found.push_back(score);
    }
    result.push_back({condition.condition->id, condition.channels[bound.channel].channel,
                      std::string(bound.metric->name), bound.limit,
                      static_cast<double>(kept) / static_cast<double>(points.size()),
                      quantile_of(std::move(found), 0.5)});
  }
  return result;
}

}  // namespace rigcal::calib
