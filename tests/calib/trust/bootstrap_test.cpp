#include "calib/trust/bootstrap.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "calib/score/scorecard.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;

/// A rig whose only unknown, the offset of its position sensor, is the mean of measured minus
/// simulated. The replicates therefore estimate exactly what was drawn.
struct OffsetAlone {
  Twin twin;
  std::vector<datasets::Record> records;
  Uncertainty found;
  Fit fit;

  OffsetAlone() {
    twin.noise_sd_m = 0.0;
    twin.free("position_offset", 0.0, -5e-3, 5e-3);
    twin.add("sine", datasets::Waveform::sine, 5.0, 0.01);
    records = twin.records(50, 500.0, 1);
    found.root = Eigen::MatrixXd::Identity(1, 1);
    ScoreContribution& scatter = found.scatter.emplace_back();
    scatter.covariance = Eigen::MatrixXd::Identity(1, 1);
    scatter.freedom = Eigen::VectorXd::Constant(1, 40.0);
    scatter.noise.emplace_back();
    fit.parameters.resize(1);
  }

  datasets::Series& position() { return records[0].channels[datasets::Channel::position]; }

  BootstrapSpread draw(int replicates) {
    const Problem problem = problem_of(twin, records);
    Evaluation optimum;
    optimum.z = problem.start();
    FitOptions options;
    options.bootstrap = replicates;
    Budget budget;
    bootstrap(problem, optimum, found, score_conditions(problem, optimum.z, 1), options, fit,
              budget);
    CHECK(fit.bootstrap.value().replicates == replicates);
    return fit.parameters[0].bootstrap.value();
  }
};

}  // namespace

TEST_CASE("bootstrap: blocks of a first-order process", "[calib]") {
  // G / gamma_0 = 2 phi / (1 - phi)^2 and sum gamma_h / gamma_0 = (1 + phi) / (1 - phi), so that
  // the length is (6 phi^2 / (1 - phi^2)^2 n)^(1/3).
  for (const auto& [phi, samples] : {std::pair{0.5, 1000.0}, std::pair{0.5, 64000.0},
                                     std::pair{0.9, 2000.0}, std::pair{-0.6, 3000.0}}) {
    CAPTURE(phi, samples);
    const double root = phi / (1.0 - phi * phi);
    CHECK(block_length({{phi}, 1.0}, static_cast<std::size_t>(samples)) ==
          static_cast<std::size_t>(std::cbrt(6.0 * root * root * samples)));
  }
}

TEST_CASE("bootstrap: three repeats that differ by their offset", "[calib]") {
  OffsetAlone rig;
  constexpr double kUnit = 5e-4;
  for (const double size : {2.0, -1.0, -1.0})
    rig.position().deviations.emplace_back(50, size * kUnit);
  const BootstrapSpread spread = rig.draw(300);
  // Three draws from 2, -1, -1, scaled by sqrt(3 / 2), have means of 2 (once in 27), 1, 0 and -1
  // (eight times). Their standard deviation is that of the mean of three repeats, sqrt(3 / 3).
  const double enlarged = std::sqrt(1.5) * kUnit;
  CHECK_THAT(spread.standard_error, WithinRel(kUnit, 0.1));
  CHECK(spread.freedom == 2.0);
  // Both ends are the extremes of that distribution, multiplied by t for two degrees of freedom
  // over the normal quantile (scipy.stats: 4.302652730 / 1.959963985).
  constexpr double kWidened = 2.195271;
  CHECK_THAT(spread.ci95->low, WithinRel(-enlarged * kWidened, 1e-3));
  CHECK_THAT(spread.ci95->high, WithinRel(2.0 * enlarged * kWidened, 1e-3));
}

TEST_CASE("bootstrap: the standard deviation has one degree of freedom less", "[calib]") {
  OffsetAlone rig;
  constexpr double kUnit = 5e-4;
  for (const double size : {2.0, -1.0, -1.0})
    rig.position().deviations.emplace_back(50, size * kUnit);
  constexpr int kDrawn = 21;
  const BootstrapSpread spread = rig.draw(kDrawn);
  // Replicates are integer multiples of this step. In units of it, their sum and their sum of
  // squares are therefore integers, too.
  const double step = std::sqrt(1.5) * kUnit;
  const double sum = kDrawn * spread.bias / step;
  const double squares =
      (kDrawn - 1) * std::pow(spread.standard_error / step, 2.0) + sum * sum / kDrawn;
  CAPTURE(sum, squares);
  CHECK_THAT(sum, WithinAbs(std::round(sum), 0.01));
  CHECK_THAT(squares, WithinAbs(std::round(squares), 0.01));
}

TEST_CASE("bootstrap: the bias is mean of the replicates minus estimate", "[calib]") {
  // Without repeats, residuals are drawn. Here each residual is 1 mm, because the estimate was not
  // adapted.
  OffsetAlone rig;
  for (double& each : rig.position().mean) each += 1e-3;
  const BootstrapSpread spread = rig.draw(20);
  CHECK_THAT(spread.bias, WithinRel(1e-3, 1e-3));
  CHECK(spread.standard_error < 1e-6);
  CHECK_THAT(spread.freedom, WithinRel(40.0, 1e-12));
}

TEST_CASE("bootstrap: the degrees of freedom of equal conditions add up", "[calib]") {
  OffsetAlone rig;
  rig.twin.add("again", datasets::Waveform::sine, 5.0, 0.01);
  rig.records = rig.twin.records(50, 500.0, 1);
  rig.found.scatter.push_back(rig.found.scatter[0]);
  // Satterthwaite: (v + v)^2 / (v^2 / 40 + v^2 / 40)
  CHECK_THAT(rig.draw(20).freedom, WithinRel(80.0, 1e-12));
}

TEST_CASE("bootstrap: residuals that belong together are drawn together", "[calib]") {
  OffsetAlone rig;
  constexpr double kResidual = 1e-3;
  auto& measured = rig.position().mean;
  for (std::size_t t = 0; t < 50; ++t) measured[t] += t < 25 ? kResidual : -kResidual;
  rig.found.scatter[0].noise[0] = {{0.9}, 1.0};
  REQUIRE(block_length(rig.found.scatter[0].noise[0], 50) == 18);
  // In a square wave of +-1 with a period of 50, the sum of 18 samples from a random one on has a
  // mean square of 169.0, that of 14 samples 123.2. A replicate has two blocks of 18 and one of 14,
  // so the standard deviation of its mean is sqrt(461.2) / 50 = 0.43. Drawn one by one, it is
  // 1 / sqrt(50) = 0.14.
  CHECK_THAT(rig.draw(300).standard_error, WithinRel(0.43 * kResidual, 0.2));
}

TEST_CASE("bootstrap: an interval ends at the limit of its parameter", "[calib]") {
  OffsetAlone rig;
  rig.twin.setting("position_offset").fit = false;
  rig.twin.free("leakage_coefficient", 0.002, 0.0, 2.0);
  rig.twin.truth = rig.twin.campaign;
  rig.twin.noise_sd_m = 5e-4;
  rig.records = rig.twin.records(50, 500.0, 1);
  rig.fit.parameters[0].value = 0.002;
  // The noise is so large that many replicates find no leak. Widened by t for 40 degrees of freedom
  // over the normal quantile, their distance from the estimate would lead below zero.
  const BootstrapSpread spread = rig.draw(40);
  CHECK(spread.standard_error > 0.002);
  CHECK(spread.ci95->low == 0.0);
}

}  // namespace rigcal::calib
