#include "calib/posterior/chains.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "datasets/synthetic/noise.hpp"
#include "tests/support/golden.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using test::golden;

Chains golden_chains(const std::string& name) {
  const std::vector<double> shape = golden(name + ".shape");
  const std::vector<double> all = golden(name);
  const auto draws = static_cast<std::ptrdiff_t>(shape[1]);
  Chains chains;
  for (std::ptrdiff_t c = 0; c < static_cast<std::ptrdiff_t>(shape[0]); ++c)
    chains.emplace_back(all.begin() + c * draws, all.begin() + (c + 1) * draws);
  return chains;
}

}  // namespace

TEST_CASE("chains: as the definitions give them in Python", "[calib]") {
  // From tests/golden/make_statistics_golden.py: slow chains, one chain at a different location,
  // one wider chain, and chains with alternating draws, which are worth more than their number.
  for (const std::string name :
       {"chains.slow", "chains.apart", "chains.spread", "chains.alternating"}) {
    CAPTURE(name);
    const Chains chains = golden_chains(name);
    CHECK_THAT(split_r_hat(chains), WithinRel(golden(name + ".r_hat")[0], 1e-9));
    CHECK_THAT(bulk_effective_draws(chains), WithinRel(golden(name + ".bulk")[0], 1e-9));
    CHECK_THAT(tail_effective_draws(chains), WithinRel(golden(name + ".tail")[0], 1e-9));
    CHECK_THAT(energy_fraction(chains.front()), WithinRel(golden(name + ".energy")[0], 1e-9));
  }
}

TEST_CASE("chains: an autoregression is worth (1 - phi) / (1 + phi) of its draws", "[calib]") {
  for (const double phi : {0.0, 0.5, 0.9}) {
    CAPTURE(phi);
    Chains chains;
    for (const std::string chain : {"a", "b", "c", "d"}) {
      auto stream = datasets::random_stream(3, {chain});
      chains.push_back(datasets::ar1_noise(stream, 20000, 1.0, phi));
    }
    // The estimate itself varies by a few per cent.
    CHECK_THAT(bulk_effective_draws(chains), WithinRel(80000.0 * (1.0 - phi) / (1.0 + phi), 0.1));
    CHECK(split_r_hat(chains) < 1.005);
    // With independent draws, the mean squared change in energy is twice its variance.
    CHECK_THAT(energy_fraction(chains.front()), WithinRel(2.0 * (1.0 - phi), 0.1));
  }
}

TEST_CASE("chains: draws without any spread, and too few of them", "[calib]") {
  const Chains constant(2, std::vector<double>(10, 3.0));
  CHECK(split_r_hat(constant) == 1.0);
  CHECK(bulk_effective_draws(constant) == 20.0);
  const Chains few(4, std::vector<double>{1.0, 2.0, 3.0});
  CHECK(std::isnan(split_r_hat(few)));
  CHECK(std::isnan(bulk_effective_draws(few)));
  CHECK(std::isnan(tail_effective_draws(few)));
  CHECK(std::isnan(energy_fraction({1.0})));
}

TEST_CASE("chains: quantiles are linear between the draws", "[calib]") {
  CHECK(quantile_of({4.0, 1.0, 3.0, 2.0}, 0.5) == 2.5);
  CHECK(quantile_of({4.0, 1.0, 3.0, 2.0}, 0.0) == 1.0);
  CHECK(quantile_of({4.0, 1.0, 3.0, 2.0}, 1.0) == 4.0);
  CHECK_THAT(quantile_of({0.0, 10.0}, 0.975), WithinAbs(9.75, 1e-12));
}

}  // namespace rigcal::calib
