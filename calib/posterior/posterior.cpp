#include "calib/posterior/posterior.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "calib/posterior/chains.hpp"
#include "calib/posterior/effect_step.hpp"
#include "calib/posterior/kept_limits.hpp"
#include "common/bytes.hpp"
#include "common/significant.hpp"
#include "common/task_farm.hpp"
#include "datasets/synthetic/noise.hpp"

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The start points of the chains are drawn from the normal approximation around the optimum,
/// widened by this factor. They vary more than the posterior, so that R-hat can detect chains that
/// have not forgotten their start.
constexpr double kScattered = 2.0;
/// Maximum number of attempts to draw a start point that can be simulated. Each attempt is half as
/// far from the optimum as the last.
constexpr int kMostTries = 8;
/// Numbers of sweeps in the two steps that change the sizes of effects after each draw. Many sweeps
/// give sizes that do not depend on the last ones. One gives sizes closer to them, which are
/// accepted more often where the outputs are far from linear.
constexpr int kManySweeps = 300;
constexpr int kFewSweeps = 1;
/// Fraction of missing information below which the chains may not reach the tails.
constexpr double kLeastEnergyFraction = 0.3;
/// Number of effective draws in all chains below which the quantiles are unreliable.
constexpr double kLeastEffective = 100.0 * kPosteriorChains;

std::vector<double> listed(const MatrixXd& matrix) {
  return {matrix.data(), matrix.data() + matrix.size()};
}

/// State of a chain after a task, with the draws from that task. It contains only numbers, so that
/// it can be stored.
struct ChainTask {
  std::vector<double> position, whitened, covariance;
  std::vector<double> sizes;  ///< sizes of the small effects
  double step = 0.0;
  long iteration = 0;
  long evaluations = 0;
  std::vector<std::vector<double>> positions;  ///< one for each draw: y, then the sizes
  std::vector<double> energies;
  int diverged = 0;
  int longest = 0;

  template <typename Archive>
  void serialize(Archive& archive) {
    archive(position, whitened, covariance, sizes, step, iteration, evaluations, positions,
            energies, diverged, longest);
  }

  ChainState state() const {
    const auto n = static_cast<Index>(position.size());
    ChainState result;
    result.position = Eigen::Map<const VectorXd>(position.data(), n);
    result.covariance = Eigen::Map<const MatrixXd>(covariance.data(), n, n);
    result.whitened =
        Eigen::Map<const VectorXd>(whitened.data(), static_cast<Index>(whitened.size()));
    result.step = step;
    result.iteration = iteration;
    return result;
  }
  void take(const ChainState& state) {
    position = listed(state.position);
    whitened = listed(state.whitened);
    covariance = listed(state.covariance);
    step = state.step;
    iteration = state.iteration;
  }
};

/// Chooses the start point of a chain.
///
/// @return  false if no point can be simulated, not even the optimum
bool begin_chain(const LogDensityOf& density, const PosteriorDensity& posterior, std::uint64_t seed,
                 std::size_t chain, ChainState& state) {
  const MatrixXd lower = posterior.covariance().llt().matrixL();
  auto stream =
      datasets::random_stream(seed, {"posterior", fmt::format("chain {}", chain), "begin"});
  state.covariance = posterior.covariance();
  double far = kScattered;
  for (int i = 0; i < kMostTries; ++i, far *= 0.5) {
    VectorXd step(lower.rows());
    for (double& each : step) each = far * datasets::normal(stream, 1.0);
    state.position = posterior.centre() + lower * step;
    if (std::isfinite(density(state.position).value)) return true;
  }
  state.position = posterior.centre();
  return std::isfinite(density(state.position).value);
}

VectorXd point_of(const std::vector<double>& position) {
  return Eigen::Map<const VectorXd>(position.data(), static_cast<Index>(position.size()));
}

/// Changes the sizes of the effects after a draw, and the position with them.
///
/// @return  number of simulated points
int change_sizes(const PosteriorDensity& posterior, const NutsOptions& sampler, ChainState& state,
                 VectorXd& sizes) {
  auto stream =
      datasets::random_stream(sampler.seed, {"posterior", fmt::format("chain {}", sampler.chain),
                                             "sizes", fmt::format("draw {}", state.iteration)});
  int simulated = 0;
  for (const int sweeps : {kFewSweeps, kManySweeps}) {
    const SizeStep step = step_sizes(posterior, sweeps, stream, state.position, sizes);
    simulated += step.simulated;
    if (step.accepted) state.whitened.resize(0);
  }
  return simulated;
}

/// Draws of all chains, as coordinates of the sampler: [chain][draw][coordinate].
using Positions = std::vector<std::vector<std::vector<double>>>;

/// Returns one number for each draw of each chain.
template <typename Value>
Chains chains_of(const Positions& positions, const Value& value) {
  Chains chains;
  for (const auto& chain : positions) {
    std::vector<double>& values = chains.emplace_back();
    for (const auto& position : chain) values.push_back(value(point_of(position)));
  }
  return chains;
}

PosteriorSpread statistics_of(const Chains& chains) {
  std::vector<double> all;
  for (const auto& chain : chains) all.insert(all.end(), chain.begin(), chain.end());
  double mean = 0.0;
  for (const double value : all) mean += value / static_cast<double>(all.size());
  double squares = 0.0;
  for (const double value : all) squares += (value - mean) * (value - mean);
  PosteriorSpread statistics;
  statistics.median = quantile_of(all, 0.5);
  statistics.sd = std::sqrt(squares / static_cast<double>(all.size() - 1));
  statistics.ci95 = {quantile_of(all, 0.025), quantile_of(all, 0.975)};
  statistics.r_hat = split_r_hat(chains);
  statistics.bulk_draws = bulk_effective_draws(chains);
  statistics.tail_draws = tail_effective_draws(chains);
  return statistics;
}

/// Returns the draws that are shown in pair plots: at most kMostPairDraws draws of at most
/// kMostPaired estimates.
Pairs pairs_of(const Posterior& found, const std::vector<FittedParameter>& parameters) {
  constexpr std::size_t kMostPaired = 6;
  constexpr std::size_t kMostPairDraws = 400;
  Pairs pairs;
  if (found.values.empty()) return pairs;
  const std::size_t count = found.values.front().size();
  const std::size_t every = (count + kMostPairDraws - 1) / kMostPairDraws;
  pairs.every = static_cast<int>(every);
  for (std::size_t j = 0; j < found.values.size() && pairs.names.size() < kMostPaired; ++j) {
    if (parameters[j].nuisance) continue;
    pairs.names.push_back(found.names[j]);
    std::vector<double>& values = pairs.values.emplace_back();
    for (std::size_t k = 0; k < count; k += every) values.push_back(found.values[j][k]);
  }
  return pairs;
}

/// Describes any problems with the chains, in words; empty if there are none.
std::string complaints(const Posterior& found) {
  std::vector<std::string> words;
  if (!found.mixed()) {
    words.push_back(fmt::format(
        "the chains disagree (R-hat {} of {}, expected at most 1.01): more draws are needed",
        significant(found.r_hat, 4), found.worst.value_or("")));
  }
  if (found.diverged > 0) {
    words.push_back(fmt::format(
        "{} trajector{} diverged: the density is too sharply curved there for the sampler, which "
        "may have missed a part of it",
        found.diverged, found.diverged == 1 ? "y" : "ies"));
  }
  if (found.longest > 0)
    words.push_back(
        fmt::format("{} trajectories were cut off at {} doublings, which costs time but does not "
                    "bias the draws",
                    found.longest, NutsOptions{}.most_doublings));
  if (found.energy_fraction < kLeastEnergyFraction)
    words.push_back(fmt::format("the energy mixes slowly (fraction {}): the tails may be too short",
                                significant(found.energy_fraction, 2)));
  if (found.least_draws < kLeastEffective)
    words.push_back(fmt::format(
        "the effective sample size is only {:.0f}, so the ends of intervals are inaccurate",
        found.least_draws));
  std::string text;
  for (const std::string& each : words) text += "; " + each;
  return text;
}

std::string how_drawn(const Posterior& found, const std::string& stopped) {
  std::string text =
      fmt::format("{} chains of {} draws by the no-U-turn sampler, after {} warm-up draws each",
                  found.chains, found.draws, found.warm_up);
  if (found.draws < found.asked)
    text += fmt::format(" ({} were asked for: {})", found.asked, stopped);
  if (found.effects)
    text += "; the sizes of the small effects that the model leaves out are drawn, too";
  text += fmt::format("; largest R-hat {}, at least {:.0f} effective draws, {}, energy fraction {}",
                      significant(found.r_hat, 4), found.least_draws,
                      found.diverged == 0 ? std::string("no divergence")
                                          : fmt::format("{} divergences", found.diverged),
                      significant(found.energy_fraction, 2));
  return text + complaints(found);
}

}  // namespace

void sample_posterior(const Problem& problem, const Evaluation& optimum, const Uncertainty& found,
                      const EffectLikelihood* effects, const FitOptions& options, Fit& fit,
                      Budget& left) {
  Posterior& result = fit.posterior.emplace();
  result.asked = options.posterior;
  result.warm_up = kPosteriorWarmUp;
  result.chains = kPosteriorChains;
  for (std::size_t j = 0; j < optimum.z.size(); ++j) result.names.push_back(problem.name(j));
  const Evaluation with_rows =
      evaluate_at(problem, optimum.z, options.threads, {Fidelity::full, left.cancel(), true});
  if (!with_rows.ok) {
    result.message = fmt::format(
        "no draws: {}", left.spent() ? left.reason() : "the optimum could not be simulated again");
    return;
  }
  const PosteriorDensity posterior(problem, with_rows, found, fit.parameters, left.cancel(),
                                   effects);
  result.effects = effects != nullptr;
  result.noise_variance = posterior.noise();

  const auto stop = [&left] { return left.interrupted(); };
  ThreadFarm threads;
  TaskFarm& farm = options.farm != nullptr ? *options.farm : threads;
  std::atomic<int> done = 0;
  const int of_all = kPosteriorChains * (kPosteriorWarmUp + options.posterior);
  std::vector<ChainTask> chains(kPosteriorChains);
  // The warm-up comes first, then one group of draws after the other. All chains must complete a
  // group before the next one starts.
  const auto run = [&](const std::string& name, int count) {
    const bool warming = result.draws == 0 && chains.front().position.empty();
    const auto make = [&](std::size_t c) -> TaskResult {
      if (left.spent()) return {{}, false};
      ChainTask next;
      VectorXd sizes = posterior.sizes_beside().mean;  // until the first draw
      const LogDensityOf density = [&](const VectorXd& y) {
        ++next.evaluations;
        return posterior.at(y, sizes);
      };
      NutsOptions sampler;
      sampler.seed = options.seed;
      sampler.chain = static_cast<int>(c);
      sampler.stop = stop;
      ChainState state;
      if (warming) {
        if (!begin_chain(density, posterior, options.seed, c, state)) return {{}, !stop()};
        if (!warm_up(density, count, sampler, state)) return {{}, false};
      } else {
        state = chains[c].state();
        sizes = point_of(chains[c].sizes);
        const int at_once = effects != nullptr ? 1 : count;
        for (int drawn = 0; drawn < count; drawn += at_once) {
          const std::vector<Draw> draws = sample(density, at_once, sampler, state);
          if (static_cast<int>(draws.size()) < at_once) return {{}, false};
          for (const Draw& draw : draws) {
            next.positions.push_back(listed(draw.position));
            next.energies.push_back(draw.energy);
            next.diverged += draw.diverged ? 1 : 0;
            next.longest += draw.doublings >= sampler.most_doublings ? 1 : 0;
          }
          if (effects == nullptr) continue;
          next.evaluations += change_sizes(posterior, sampler, state, sizes);
          next.positions.back() = listed(state.position);
          const std::vector<double> own = listed(sizes);
          next.positions.back().insert(next.positions.back().end(), own.begin(), own.end());
        }
      }
      next.take(state);
      next.sizes = listed(sizes);
      return {to_bytes(next), !stop()};
    };
    const auto tell = [&](std::size_t /*chain*/, const TaskResult& made) {
      if (options.beside && made.whole)
        options.beside("draws of the posterior", done += count, of_all);
    };
    std::string before;
    for (const ChainTask& each : chains) before += to_bytes(each.position, each.iteration);
    const auto results = farm.run(
        {name,
         to_bytes(optimum.z, optimum.cost, listed(posterior.centre()), options.seed, count, before),
         chains.size(), options.threads},
        make, tell);
    std::vector<ChainTask> next(chains.size());
    for (std::size_t c = 0; c < chains.size(); ++c) {
      if (!results[c].whole || results[c].bytes.empty()) return false;
      from_bytes(results[c].bytes, next[c]);
    }
    for (const ChainTask& each : next) {
      result.evaluations += each.evaluations;
      result.diverged += each.diverged;
      result.longest += each.longest;
      left.count(each.evaluations);
    }
    chains = std::move(next);
    return true;
  };

  Positions positions(chains.size());
  std::vector<std::vector<double>> energies(chains.size());
  bool whole = run("posterior warm-up", kPosteriorWarmUp);
  while (whole && result.draws < options.posterior) {
    const int count = std::min(kPosteriorStretch, options.posterior - result.draws);
    whole = run(fmt::format("posterior draws {} to {}", result.draws, result.draws + count), count);
    if (!whole) break;
    result.draws += count;
    for (std::size_t c = 0; c < chains.size(); ++c) {
      positions[c].insert(positions[c].end(), chains[c].positions.begin(),
                          chains[c].positions.end());
      energies[c].insert(energies[c].end(), chains[c].energies.begin(), chains[c].energies.end());
    }
  }
  const std::string stopped = left.spent() ? left.reason() : "nothing could be simulated";
  if (result.draws == 0) {
    result.message = fmt::format("no draws: {}", stopped);
    return;
  }

  result.energy_fraction = HUGE_VAL;
  for (const auto& chain : energies)
    result.energy_fraction = std::min(result.energy_fraction, energy_fraction(chain));
  result.least_draws = HUGE_VAL;
  const auto unknowns = static_cast<Index>(result.names.size());
  const auto judged = [&result](const Chains& draws, const std::string& name) {
    const PosteriorSpread statistics = statistics_of(draws);
    result.least_draws =
        std::min({result.least_draws, statistics.bulk_draws, statistics.tail_draws});
    if (!(statistics.r_hat <= result.r_hat)) {
      result.r_hat = statistics.r_hat;
      result.worst = name;
    }
    return statistics;
  };
  for (std::size_t j = 0; j < result.names.size(); ++j) {
    const Chains of_unknown = chains_of(positions, [&](const VectorXd& y) {
      return problem.map.to_physical(static_cast<int>(j), posterior.to_unit(y.head(unknowns))[j]);
    });
    fit.parameters[j].posterior = judged(of_unknown, result.names[j]);
    std::vector<double>& values = result.values.emplace_back();
    for (const auto& chain : of_unknown) values.insert(values.end(), chain.begin(), chain.end());
  }
  for (std::size_t e = 0; effects != nullptr && e < effects->keys.size(); ++e) {
    const std::string& key = effects->keys[e];
    for (ConsideredEffect& about : fit.considered->effects) {
      if (about.key != key) continue;
      about.posterior = judged(chains_of(positions,
                                         [&](const VectorXd& y) {
                                           return about.size * y(unknowns + static_cast<Index>(e));
                                         }),
                               key);
    }
  }
  result.pairs = pairs_of(result, fit.parameters);
  std::vector<std::vector<double>> points;
  std::vector<VectorXd> sizes;
  const auto count =
      static_cast<std::size_t>(result.chains) * static_cast<std::size_t>(result.draws);
  const std::size_t simulated = std::min<std::size_t>(kPosteriorSimulated, count);
  for (std::size_t k = 0; k < simulated; ++k) {
    const std::size_t at = k * count / simulated;
    const auto& position = positions[at / static_cast<std::size_t>(result.draws)]
                                    [at % static_cast<std::size_t>(result.draws)];
    const VectorXd point = point_of(position);
    points.push_back(posterior.to_unit(point.head(unknowns)));
    sizes.push_back(point.tail(point.size() - unknowns));
  }
  ChangeOf change;
  if (effects != nullptr) {
    change = [&](std::size_t condition, std::size_t point) {
      return posterior.changes(condition, sizes[point]);
    };
  }
  if (!stop()) result.limits = kept_limits(problem, points, change, options.threads, left.cancel());
  if (!stop() && options.shares) result.shares = options.shares(problem, points, left);
  if (!result.limits.empty() || !result.shares.empty())
    result.simulated = static_cast<int>(points.size());
  result.message = how_drawn(result, stopped);
}

}  // namespace rigcal::calib
