#include "calib/posterior/nuts.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "calib/posterior/chains.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kWarmUp = 400;
constexpr int kDraws = 1500;

ChainState state_at(const VectorXd& position) {
  ChainState state;
  state.position = position;
  state.covariance = MatrixXd::Identity(position.size(), position.size());
  return state;
}

/// Runs four chains from distant points. Their initial mass contains no information about the
/// density.
std::vector<std::vector<Draw>> four_chains(const LogDensityOf& density, double far,
                                           double acceptance) {
  std::vector<std::vector<Draw>> chains;
  for (int c = 0; c < 4; ++c) {
    NutsOptions options;
    options.seed = 7;
    options.chain = c;
    options.target_acceptance = acceptance;
    ChainState state = state_at(Vector2d(c < 2 ? far : -far, c % 2 == 0 ? far : -far));
    REQUIRE(warm_up(density, kWarmUp, options, state));
    chains.push_back(sample(density, kDraws, options, state));
    REQUIRE(chains.back().size() == kDraws);
  }
  return chains;
}

template <typename Function>
Chains of_draws(const std::vector<std::vector<Draw>>& draws, const Function& function) {
  Chains chains;
  for (const auto& chain : draws) {
    std::vector<double>& values = chains.emplace_back();
    for (const Draw& draw : chain) values.push_back(function(draw.position));
  }
  return chains;
}

/// Checks that the mean of a function over all draws is within four standard errors of `expected`.
template <typename Function>
void check_mean(const std::vector<std::vector<Draw>>& draws, const Function& function,
                double expected) {
  const Chains chains = of_draws(draws, function);
  double mean = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const auto& chain : chains) {
    for (const double value : chain) {
      mean += value;
      square += value * value;
      count += 1.0;
    }
  }
  mean /= count;
  const double effective = bulk_effective_draws(chains);
  CHECK(effective > 0.05 * count);
  CHECK(split_r_hat(chains) < 1.01);
  CHECK_THAT(mean,
             WithinAbs(expected, 4.0 * std::sqrt((square / count - mean * mean) / effective)));
}

LogDensity normal_density(const VectorXd& x, const MatrixXd& precision, const VectorXd& mean) {
  const VectorXd pull = precision * (x - mean);
  return {-0.5 * (x - mean).dot(pull), -pull};
}

/// Correlation 0.99, standard deviations 1 and 0.1.
MatrixXd narrow() {
  MatrixXd covariance(2, 2);
  covariance << 1.0, 0.099, 0.099, 0.01;
  return covariance;
}

}  // namespace

TEST_CASE("nuts: a normal distribution of correlation 0.99", "[calib]") {
  const MatrixXd precision = narrow().inverse();
  const Vector2d mean(1.0, -2.0);
  const auto draws =
      four_chains([&](const VectorXd& x) { return normal_density(x, precision, mean); }, 5.0, 0.8);
  const auto x = [](const VectorXd& at) { return at(0) - 1.0; };
  const auto y = [](const VectorXd& at) { return at(1) + 2.0; };
  check_mean(draws, x, 0.0);
  check_mean(draws, y, 0.0);
  check_mean(
      draws, [&](const VectorXd& at) { return x(at) * x(at); }, 1.0);
  check_mean(
      draws, [&](const VectorXd& at) { return y(at) * y(at); }, 0.01);
  check_mean(
      draws, [&](const VectorXd& at) { return x(at) * y(at); }, 0.099);
  check_mean(
      draws, [&](const VectorXd& at) { return x(at) < -1.2815515655446 ? 1.0 : 0.0; }, 0.1);
  for (const auto& chain : draws) {
    double acceptance = 0.0;
    for (const Draw& draw : chain) {
      CHECK_FALSE(draw.diverged);
      CHECK(draw.doublings <= 5);  // the density is not narrow for the adapted mass
      acceptance += draw.acceptance / kDraws;
    }
    CHECK_THAT(acceptance, WithinAbs(0.85, 0.1));
  }
}

TEST_CASE("nuts: a banana", "[calib]") {
  // x is normal, and y is normal around x^2, with standard deviation 1. The density is narrow far
  // out, where the steps for the usual acceptance are too long.
  const LogDensityOf banana = [](const VectorXd& at) {
    const double off = at(1) - at(0) * at(0);
    return LogDensity{-0.5 * at(0) * at(0) - 0.5 * off * off,
                      Vector2d(-at(0) + 2.0 * at(0) * off, -off)};
  };
  const auto draws = four_chains(banana, 2.0, 0.95);
  check_mean(
      draws, [](const VectorXd& at) { return at(0); }, 0.0);
  check_mean(
      draws, [](const VectorXd& at) { return at(0) * at(0); }, 1.0);
  check_mean(
      draws, [](const VectorXd& at) { return at(1); }, 1.0);
  check_mean(
      draws, [](const VectorXd& at) { return (at(1) - 1.0) * (at(1) - 1.0); }, 3.0);
  check_mean(
      draws, [](const VectorXd& at) { return at(0) * at(0) * at(1); }, 3.0);
}

TEST_CASE("nuts: where there is no density nothing is drawn", "[calib]") {
  // Half of a normal distribution in x, a full one in y.
  const LogDensityOf half = [](const VectorXd& at) {
    if (at(0) < 0.0) return LogDensity{};
    return LogDensity{-0.5 * at.squaredNorm(), -at};
  };
  NutsOptions options;
  ChainState state = state_at(Vector2d(0.5, 0.5));
  state.step = 0.3;
  const auto draws = sample(half, 8000, options, state);
  double mean = 0.0;
  for (const Draw& draw : draws) {
    REQUIRE(draw.position(0) >= 0.0);
    mean += draw.position(0) / 8000.0;
  }
  CHECK_THAT(mean, WithinAbs(std::sqrt(2.0 / M_PI), 0.05));
  ChainState outside = state_at(Vector2d(-1.0, 0.0));
  CHECK_THROWS_AS(warm_up(half, 10, options, outside), std::invalid_argument);
}

TEST_CASE("nuts: steps that are nearly too long cost draws, not the truth", "[calib]") {
  // With this step the leapfrog's own invariant distribution has a variance of 1 / (1 - 1.6^2 / 4)
  // = 2.8; only the weights of the points make it that of the density.
  const LogDensityOf density = [](const VectorXd& x) {
    return LogDensity{-0.5 * x.squaredNorm(), -x};
  };
  NutsOptions options;
  options.seed = 5;
  ChainState state = state_at(Vector2d(0.5, 0.5));
  state.step = 1.6;
  double variance = 0.0;
  constexpr int kMany = 8000;
  for (const Draw& draw : sample(density, kMany, options, state))
    variance += draw.position.squaredNorm() / (2.0 * kMany);
  CHECK_THAT(variance, WithinAbs(1.0, 0.1));
}

TEST_CASE("nuts: stretches are the draws of one run", "[calib]") {
  const MatrixXd precision = narrow().inverse();
  const LogDensityOf density = [&](const VectorXd& x) {
    return normal_density(x, precision, Vector2d(1.0, -2.0));
  };
  NutsOptions options;
  options.seed = 11;
  ChainState begun = state_at(Vector2d(0.3, 0.1));
  REQUIRE(warm_up(density, 150, options, begun));
  ChainState whole = begun;
  ChainState parts = begun;
  const auto all = sample(density, 60, options, whole);
  auto pieces = sample(density, 17, options, parts);
  for (const Draw& draw : sample(density, 43, options, parts)) pieces.push_back(draw);
  REQUIRE(pieces.size() == all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(pieces[i].position == all[i].position);
    CHECK(pieces[i].energy == all[i].energy);
  }
  SECTION("another chain, and another seed, draw other numbers") {
    for (const auto& [seed, chain] : {std::pair{11, 1}, std::pair{12, 0}}) {
      NutsOptions other = options;
      other.seed = static_cast<std::uint64_t>(seed);
      other.chain = chain;
      ChainState state = begun;
      CHECK(sample(density, 1, other, state)[0].position != all[0].position);
    }
  }
}

TEST_CASE("nuts: steps that are much too long diverge, and it can be stopped", "[calib]") {
  const LogDensityOf density = [](const VectorXd& x) {
    return LogDensity{-0.5 * x.squaredNorm(), -x};
  };
  NutsOptions options;
  ChainState state = state_at(Vector2d(0.5, 0.5));
  state.step = 300.0;
  for (const Draw& draw : sample(density, 20, options, state)) {
    CHECK(draw.diverged);
    CHECK(draw.position == Vector2d(0.5, 0.5));
  }
  state.step = 1e-4;
  options.most_doublings = 3;
  for (const Draw& draw : sample(density, 5, options, state)) {
    CHECK_FALSE(draw.diverged);
    CHECK(draw.doublings == 3);
  }
  int asked = 0;
  options.stop = [&asked] { return ++asked == 4; };
  CHECK(sample(density, 20, options, state).size() == 3);
  asked = 0;
  CHECK_FALSE(warm_up(density, 100, options, state));
  CHECK(asked == 4);
}

}  // namespace rigcal::calib
