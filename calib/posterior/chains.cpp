#include "calib/posterior/chains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

constexpr std::size_t kLeastDraws = 4;

std::size_t total(const Chains& chains) {
  return chains.empty() ? 0 : chains.size() * chains.front().size();
}

bool too_short(const Chains& chains) {
  return chains.empty() || chains.front().size() < kLeastDraws;
}

/// Splits each chain into two halves. If the number of draws is odd, the middle draw is left out.
Chains halves(const Chains& chains) {
  Chains split;
  for (const auto& chain : chains) {
    const auto half = static_cast<std::ptrdiff_t>(chain.size() / 2);
    split.emplace_back(chain.begin(), chain.begin() + half);
    split.emplace_back(chain.end() - half, chain.end());
  }
  return split;
}

/// Returns the normal scores of the ranks. Equal draws share their mean rank.
Chains normal_scores(const Chains& chains) {
  struct Place {
    double value;
    std::size_t chain, draw;
  };
  std::vector<Place> order;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    for (std::size_t i = 0; i < chains[c].size(); ++i) order.push_back({chains[c][i], c, i});
  }
  std::sort(order.begin(), order.end(),
            [](const Place& a, const Place& b) { return a.value < b.value; });
  Chains scores = chains;
  const auto count = static_cast<double>(order.size());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin + 1;
    while (end < order.size() && order[end].value == order[begin].value) ++end;
    const double rank = 0.5 * static_cast<double>(begin + 1 + end);
    const double score = metrics::normal_quantile((rank - 0.375) / (count + 0.25));
    for (std::size_t k = begin; k < end; ++k) scores[order[k].chain][order[k].draw] = score;
    begin = end;
  }
  return scores;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double variance_of(const std::vector<double>& values) {
  const double mean = mean_of(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return squares / static_cast<double>(values.size() - 1);
}

struct Variances {
  double within = 0.0;
  double pooled = 0.0;  ///< estimate of the variance of the distribution, var+
};

Variances variances_of(const Chains& chains) {
  std::vector<double> means;
  std::vector<double> within;
  for (const auto& chain : chains) {
    means.push_back(mean_of(chain));
    within.push_back(variance_of(chain));
  }
  const auto draws = static_cast<double>(chains.front().size());
  Variances result;
  result.within = mean_of(within);
  result.pooled = (draws - 1.0) / draws * result.within;
  if (chains.size() > 1) result.pooled += variance_of(means);
  return result;
}

double r_hat(const Chains& chains) {
  const Variances found = variances_of(chains);
  if (!(found.within > 0.0)) return found.pooled > 0.0 ? HUGE_VAL : 1.0;
  return std::sqrt(found.pooled / found.within);
}

double autocovariance_at(const std::vector<double>& chain, double mean, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < chain.size(); ++i)
    sum += (chain[i] - mean) * (chain[i - lag] - mean);
  return sum / static_cast<double>(chain.size());
}

/// Returns the effective sample size of split chains, from Geyer's initial monotone sequence over
/// all chains.
double effective_of(const Chains& chains) {
  const auto count = static_cast<double>(total(chains));
  const std::size_t draws = chains.front().size();
  const Variances found = variances_of(chains);
  if (!(found.pooled > 0.0)) return count;
  std::vector<double> means;
  for (const auto& chain : chains) means.push_back(mean_of(chain));
  const auto correlation = [&](std::size_t lag) {
    double sum = 0.0;
    for (std::size_t c = 0; c < chains.size(); ++c)
      sum += autocovariance_at(chains[c], means[c], lag);
    const double unbiased = static_cast<double>(draws) / static_cast<double>(draws - 1);
    const double mean = sum / static_cast<double>(chains.size()) * unbiased;
    return 1.0 - (found.within - mean) / found.pooled;
  };
  double sum = -1.0;
  double least = HUGE_VAL;
  for (std::size_t lag = 0; lag + 1 < draws; lag += 2) {
    const double pair = (lag == 0 ? 1.0 : correlation(lag)) + correlation(lag + 1);
    if (!(pair > 0.0)) break;
    least = std::min(least, pair);
    sum += 2.0 * least;
  }
  // The draws of antithetic chains may be worth more than as many independent draws. This limits
  // how much more.
  return count / std::max(sum, 1.0 / std::log10(count));
}

double effective_or_nan(const Chains& chains) {
  if (too_short(chains)) return std::numeric_limits<double>::quiet_NaN();
  return effective_of(halves(chains));
}

std::vector<double> gathered(const Chains& chains) {
  std::vector<double> all;
  for (const auto& chain : chains) all.insert(all.end(), chain.begin(), chain.end());
  return all;
}

}  // namespace

double split_r_hat(const Chains& chains) {
  if (too_short(chains)) return std::numeric_limits<double>::quiet_NaN();
  const double median = quantile_of(gathered(chains), 0.5);
  Chains folded = chains;
  for (auto& chain : folded) {
    for (double& draw : chain) draw = std::abs(draw - median);
  }
  return std::max(r_hat(normal_scores(halves(chains))), r_hat(normal_scores(halves(folded))));
}

double bulk_effective_draws(const Chains& chains) {
  if (too_short(chains)) return std::numeric_limits<double>::quiet_NaN();
  return effective_of(normal_scores(halves(chains)));
}

double tail_effective_draws(const Chains& chains) {
  double least = HUGE_VAL;
  for (const double share : {0.05, 0.95}) {
    const double limit = quantile_of(gathered(chains), share);
    Chains below = chains;
    for (auto& chain : below) {
      for (double& draw : chain) draw = draw <= limit ? 1.0 : 0.0;
    }
    const double found = effective_or_nan(below);
    if (std::isnan(found)) return found;
    least = std::min(least, found);
  }
  return least;
}

double energy_fraction(const std::vector<double>& energies) {
  if (energies.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  const double mean = mean_of(energies);
  double squares = 0.0;
  double moves = 0.0;
  for (std::size_t i = 0; i < energies.size(); ++i) {
    squares += (energies[i] - mean) * (energies[i] - mean);
    if (i > 0) moves += (energies[i] - energies[i - 1]) * (energies[i] - energies[i - 1]);
  }
  return squares > 0.0 ? moves / squares : std::numeric_limits<double>::quiet_NaN();
}

double quantile_of(std::vector<double> draws, double share) {
  if (draws.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(draws.begin(), draws.end());
  const double at = share * static_cast<double>(draws.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, draws.size() - 1);
  return draws[below] + (at - static_cast<double>(below)) * (draws[above] - draws[below]);
}

}  // namespace rigcal::calib
