#include "calib/trust/bootstrap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "calib/search/search.hpp"
#include "common/bytes.hpp"
#include "common/task_farm.hpp"
#include "datasets/synthetic/noise.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

/// With this many replicates the standard deviation is known to within about one sixth.
constexpr std::size_t kLeastReplicates = 20;
/// Two repeats differ from their mean by the same amount with opposite signs, so drawing from them
/// would provide no information.
constexpr std::size_t kLeastRepeats = 3;

using Samples = std::vector<std::vector<double>>;  ///< the scored samples of each channel

/// Data from which the replicates of one condition are drawn.
struct Source {
  Samples centre;                ///< record or simulation
  std::vector<Samples> repeats;  ///< scaled-up deviations; if empty, blocks of residuals are drawn
  Samples residuals;             ///< scaled-up residuals
  std::size_t block = 1;
};

bool has_repeats(const ProblemCondition& condition) {
  for (const ProblemChannel& channel : condition.channels) {
    const auto& deviations = condition.record->channels.at(channel.channel).deviations;
    const std::size_t first =
        condition.record->channels.at(condition.channels.front().channel).deviations.size();
    if (deviations.size() < kLeastRepeats || deviations.size() != first) return false;
  }
  return true;
}

Source repeats_of(const ProblemCondition& condition) {
  Source source;
  const std::size_t repeats =
      condition.record->channels.at(condition.channels.front().channel).deviations.size();
  const auto count = static_cast<double>(repeats);
  const double enlarged = std::sqrt(count / (count - 1.0));
  source.repeats.resize(repeats);
  for (const ProblemChannel& channel : condition.channels) {
    source.centre.push_back(channel.measured);
    const auto& deviations = condition.record->channels.at(channel.channel).deviations;
    for (std::size_t r = 0; r < repeats; ++r) {
      std::vector<double>& own = source.repeats[r].emplace_back();
      for (const std::size_t row : condition.rows) {
        const double deviation = deviations[r][row];
        own.push_back(std::isfinite(deviation) ? enlarged * deviation : 0.0);
      }
    }
  }
  return source;
}

Source residuals_of(const ProblemCondition& condition, const ConditionScore& score,
                    const ScoreContribution& scatter) {
  Source source;
  const std::size_t samples = condition.rows.size();
  for (std::size_t k = 0; k < condition.channels.size(); ++k) {
    const ProblemChannel& channel = condition.channels[k];
    const auto& whole = score.series.at(channel.channel).second;
    std::vector<double>& simulated = source.centre.emplace_back(samples);
    std::vector<double>& residual = source.residuals.emplace_back(samples);
    double squares = 0.0;
    for (std::size_t t = 0; t < samples; ++t) {
      simulated[t] = whole[condition.rows[t]];
      residual[t] = channel.measured[t] - simulated[t];
      squares += residual[t] * residual[t];
    }
    const double variance = squares / static_cast<double>(samples);
    const double believed =
        metrics::autocovariance(scatter.noise[k], 0).front() * channel.sd * channel.sd;
    const double factor = variance > 0.0 ? std::sqrt(std::max(1.0, believed / variance)) : 1.0;
    for (double& each : residual) each *= factor;
    source.block = std::max(source.block, block_length(scatter.noise[k], samples));
  }
  return source;
}

std::size_t draw_index(datasets::RandomStream& stream, std::size_t count) {
  const auto index =
      static_cast<std::size_t>(datasets::uniform(stream, 0.0, static_cast<double>(count)));
  return std::min(index, count - 1);
}

void draw_repeats(const Source& from, datasets::RandomStream& stream, ProblemCondition& condition) {
  const std::size_t repeats = from.repeats.size();
  for (std::size_t k = 0; k < condition.channels.size(); ++k)
    condition.channels[k].measured = from.centre[k];
  for (std::size_t r = 0; r < repeats; ++r) {
    const Samples& drawn = from.repeats[draw_index(stream, repeats)];
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      std::vector<double>& measured = condition.channels[k].measured;
      for (std::size_t t = 0; t < measured.size(); ++t)
        measured[t] += drawn[k][t] / static_cast<double>(repeats);
    }
  }
}

void draw_blocks(const Source& from, datasets::RandomStream& stream, ProblemCondition& condition) {
  const std::size_t samples = condition.rows.size();
  for (std::size_t t = 0; t < samples; t += from.block) {
    const std::size_t begin = draw_index(stream, samples);
    for (std::size_t i = 0; i < from.block && t + i < samples; ++i) {
      for (std::size_t k = 0; k < condition.channels.size(); ++k) {
        condition.channels[k].measured[t + i] =
            from.centre[k][t + i] + from.residuals[k][(begin + i) % samples];
      }
    }
  }
}

/// Returns a quantile by linear interpolation between the ordered values.
double quantile(const std::vector<double>& ordered, double share) {
  const double at = share * static_cast<double>(ordered.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, ordered.size() - 1);
  return ordered[below] + (at - static_cast<double>(below)) * (ordered[above] - ordered[below]);
}

/// @param spec  contains the limits beyond which values have no physical meaning
BootstrapSpread replicate_spread(std::vector<double> values, double estimate, double freedom,
                                 const model::ParameterSpec& spec) {
  const auto count = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += value;
  const double mean = sum / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  std::sort(values.begin(), values.end());
  const double widened = student_t(freedom) / metrics::normal_quantile(0.975);
  const auto end = [&](double share) {
    return std::clamp(estimate + widened * (quantile(values, share) - estimate), spec.lower,
                      spec.upper);
  };
  return {std::sqrt(squares / (count - 1.0)), mean - estimate, freedom,
          Range{end(0.025), end(0.975)}};
}

/// Returns Satterthwaite's degrees of freedom for an unknown, from the contributions of the
/// conditions to its variance.
double freedom_of(const Uncertainty& found, const std::vector<Source>& sources,
                  Eigen::Index unknown) {
  double total = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const Eigen::VectorXd c = found.root.row(unknown, i);
    const double variance = c.dot(found.scatter[i].covariance * c);
    const double freedom = sources[i].repeats.empty()
                               ? freedom_in(found.scatter[i], found.root, unknown, i)
                               : static_cast<double>(sources[i].repeats.size() - 1);
    total += variance;
    if (freedom > 0.0) squares += variance * variance / freedom;
  }
  return squares > 0.0 ? total * total / squares : 1.0;
}

std::string drawn_from(const std::vector<Source>& sources) {
  std::size_t with_repeats = 0;
  std::size_t longest = 0;
  for (const Source& each : sources) {
    if (each.repeats.empty()) {
      longest = std::max(longest, each.block);
    } else {
      ++with_repeats;
    }
  }
  std::string text;
  if (with_repeats > 0) {
    text = fmt::format(
        "; {} of {} conditions resampled from their repeats: this includes variation between "
        "repeats, but no model error",
        with_repeats, sources.size());
  }
  if (longest > 0) {
    text += fmt::format(
        "; {} of {} conditions resampled from their residuals in blocks of up to {} samples: model "
        "error counts as noise",
        sources.size() - with_repeats, sources.size(), longest);
  }
  return text;
}

/// Discards the replicates after the one that reached the limit on evaluations, because which of
/// them were computed depends on the number of threads.
void cut_at(const std::optional<long>& allowed, std::vector<long>& taken,
            std::vector<std::vector<double>>& values) {
  if (!allowed) return;
  long sum = 0;
  for (std::size_t b = 0; b < taken.size(); ++b) {
    if (sum >= *allowed) {
      taken[b] = 0;
      values[b].clear();
    }
    sum += taken[b];
  }
}

}  // namespace

std::size_t block_length(const metrics::Autoregression& noise, std::size_t samples) {
  if (noise.phi.empty() || samples < 2) return 1;
  const int lags = std::min(metrics::kLongestMemory, static_cast<int>(samples) - 1);
  const auto gamma = metrics::autocovariance(noise, lags);
  double weighted = 0.0;
  double sum = gamma[0];
  for (std::size_t h = 1; h < gamma.size(); ++h) {
    weighted += 2.0 * static_cast<double>(h) * gamma[h];
    sum += 2.0 * gamma[h];
  }
  if (!(sum > 0.0)) return 1;
  const double cube = 2.0 * weighted * weighted / (4.0 / 3.0 * sum * sum);
  const double length = std::cbrt(cube * static_cast<double>(samples));
  return static_cast<std::size_t>(std::clamp(length, 1.0, static_cast<double>(samples)));
}

void bootstrap(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
               const std::vector<ConditionScore>& scores, const FitOptions& options, Fit& fit,
               Budget& left) {
  if (found.scatter.empty()) {
    fit.bootstrap = BootstrapRun{0, "no bootstrap: there are no residuals to resample"};
    return;
  }
  std::vector<Source> sources;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    if (scores[i].failure) {
      fit.bootstrap = BootstrapRun{
          0, fmt::format("no bootstrap: condition \"{}\" could not be simulated", scores[i].id)};
      return;
    }
    sources.push_back(has_repeats(problem.conditions[i])
                          ? repeats_of(problem.conditions[i])
                          : residuals_of(problem.conditions[i], scores[i], found.scatter[i]));
  }
  FitOptions quiet = options;
  quiet.progress = nullptr;
  const auto replicates = static_cast<std::size_t>(options.bootstrap);
  std::vector<std::vector<double>> values(replicates);  // empty if the replicate did not converge
  const std::optional<long> allowed = left.evaluations_left();
  std::vector<long> taken(replicates, 0);  // evaluations; 0 if the replicate was not completed
  std::atomic<int> done = 0;
  // Every replicate starts at the optimum, so its first simulation is the same for all of them.
  std::once_flag simulated;
  std::vector<model::Simulation> runs(problem.conditions.size());
  const auto simulate = [&] {
    for (std::size_t i = 0; i < runs.size(); ++i)
      runs[i] = simulate_condition(problem, i, optimum.z, left.cancel());
  };
  const auto make = [&](std::size_t b) -> TaskResult {
    if (left.spent()) return {{}, false};
    std::call_once(simulated, simulate);
    Problem drawn = problem;
    for (std::size_t i = 0; i < drawn.conditions.size(); ++i) {
      auto stream = datasets::random_stream(
          options.seed,
          {"bootstrap", fmt::format("{}", b), std::string_view(drawn.conditions[i].condition->id)});
      (sources[i].repeats.empty() ? draw_blocks : draw_repeats)(sources[i], stream,
                                                                drawn.conditions[i]);
    }
    Budget part = left.part();
    Evaluator evaluator(drawn, part);
    evaluator.begin_with(
        evaluate_at(drawn, optimum.z, 1, {evaluator.fidelity(), nullptr, false, &runs}));
    const auto solved = Search(drawn, evaluator, quiet, static_cast<int>(b) + 1).polish(optimum.z);
    left.count(evaluator.counters().evaluations);
    if (left.interrupted()) return {{}, false};
    return {to_bytes(evaluator.counters().evaluations, solved.status == FitStatus::converged
                                                           ? drawn.to_physical(evaluator.best().z)
                                                           : std::vector<double>())};
  };
  const auto tell = [&](std::size_t /*b*/, const TaskResult& result) {
    if (options.beside && result.whole)
      options.beside("replicates of the bootstrap", ++done, static_cast<int>(replicates));
  };
  ThreadFarm threads;
  TaskFarm& farm = options.farm != nullptr ? *options.farm : threads;
  const auto results = farm.run(
      {"bootstrap", to_bytes(optimum.z, optimum.cost, options.seed), replicates, options.threads},
      make, tell);
  for (std::size_t b = 0; b < replicates; ++b) {
    if (results[b].whole) from_bytes(results[b].bytes, taken[b], values[b]);
  }
  cut_at(allowed, taken, values);
  const auto made = static_cast<std::size_t>(
      std::count_if(taken.begin(), taken.end(), [](long each) { return each > 0; }));
  values.erase(
      std::remove_if(values.begin(), values.end(), [](const auto& each) { return each.empty(); }),
      values.end());
  fit.bootstrap =
      BootstrapRun{static_cast<int>(values.size()),
                   fmt::format("{} of {} replicates converged", values.size(), made) +
                       (made == replicates ? "" : fmt::format(", {} were asked for", replicates)) +
                       drawn_from(sources)};
  if (values.size() < kLeastReplicates) {
    fit.bootstrap->message +=
        fmt::format("; too few for an interval, expected at least {}", kLeastReplicates);
    return;
  }
  for (std::size_t j = 0; j < optimum.z.size(); ++j) {
    std::vector<double> column;
    for (const auto& each : values) column.push_back(each[j]);
    fit.parameters[j].bootstrap =
        replicate_spread(std::move(column), fit.parameters[j].value,
                         freedom_of(found, sources, static_cast<Eigen::Index>(j)), problem.spec(j));
  }
}

}  // namespace rigcal::calib
