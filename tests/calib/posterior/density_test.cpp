#include "calib/posterior/density.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "calib/consider/consider.hpp"
#include "calib/posterior/effect_step.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using Eigen::VectorXd;

/// A rig with all kinds of unknowns: a logarithmic one with a stated prior (mass), a linear one
/// with a prior (damping), one without a prior, and one for each leak level.
struct Scene {
  Twin twin;
  std::vector<datasets::Record> records;
  Problem problem;
  Evaluation optimum;
  Uncertainty found;
  std::vector<FittedParameter> parameters;

  static Twin rig(double tolerance, bool priors) {
    Twin twin;
    twin.campaign.simulation.tolerance = tolerance;
    auto& mass = twin.free("mass", 58.0, 20.0, 400.0);
    if (priors) mass.prior = datasets::Prior{55.0, 10.0};
    auto& damping = twin.free("damping", 1000.0, 200.0, 1900.0);
    if (priors) damping.prior = datasets::Prior{950.0, 200.0};
    twin.free("valve_gain", 0.04e-3, 0.01e-3, 0.2e-3);
    twin.free("leakage_coefficient", 0.3, 0.0, 3.0, datasets::Scope::leak_level);
    twin.level_leakage = {{"open", 0.35}, {"shut", 0.1}};
    twin.add("square", datasets::Waveform::square, 2.0, 0.01, "open");
    twin.add("sine", datasets::Waveform::sine, 3.0, 0.02, "shut");
    return twin;
  }

  explicit Scene(double tolerance = 1e-10, bool priors = true)
      : twin(rig(tolerance, priors)),
        records(twin.records(150, 300.0, 5)),
        problem(problem_of(twin, records)) {
    // The optimum is at the true values, where the residuals are noise.
    std::vector<double> z;
    for (std::size_t j = 0; j < problem.map.unknowns().size(); ++j) {
      const Unknown& unknown = problem.map.unknowns()[j];
      double value = unknown.start;
      for (const auto& each : twin.truth.parameters) {
        if (each.index == unknown.index) value = each.value;
      }
      if (!unknown.level.empty()) value = twin.level_leakage.at(unknown.level);
      z.push_back(problem.map.to_unit(static_cast<int>(j), value));
    }
    look_at(z);
  }

  /// Sets the point around which the density is built; the standard errors are those for white
  /// noise.
  void look_at(const std::vector<double>& z) {
    optimum = evaluate_at(problem, z, 1, {Fidelity::full, nullptr, true});
    REQUIRE(optimum.ok);
    found = uncertainty(problem, optimum, *optimum.rows, 1);
    found.reduced_chi_square = 1.0;
    parameters.assign(z.size(), FittedParameter());
    for (std::size_t j = 0; j < z.size(); ++j) {
      parameters[j].ci95_from = std::optional(IntervalSource::standard_error);
      found.standard_error[j] = white_error(j);
    }
  }
  double white_error(std::size_t j) const {
    const auto row = static_cast<Eigen::Index>(j);
    return std::sqrt(found.root.product(row, row)) *
           problem.map.slope(static_cast<int>(j), optimum.z[j]);
  }
  PosteriorDensity density() const { return {problem, optimum, found, parameters}; }
};

/// Returns what the records of a scene say about the small effects that its model leaves out.
EffectLikelihood effects_in(const Scene& scene) {
  Fit fit;
  fit.parameters = scene.parameters;
  std::optional<EffectLikelihood> found;
  consider_effects(scene.problem, scene.optimum.z, scene.found, 1, nullptr, fit, &found);
  REQUIRE(found);
  REQUIRE(std::count(found->one_sided.begin(), found->one_sided.end(), true) > 0);
  REQUIRE(std::count(found->one_sided.begin(), found->one_sided.end(), false) > 0);
  return *found;
}

/// Compares the gradient at a point with central differences of the value.
void check_gradient(const PosteriorDensity& density, const VectorXd& y, const VectorXd& e,
                    double margin) {
  const LogDensity at = density.at(y, e);
  for (Eigen::Index j = 0; j < y.size(); ++j) {
    CAPTURE(j);
    const double step = 1e-4;
    VectorXd above = y;
    VectorXd below = y;
    above(j) += step;
    below(j) -= step;
    const double slope = (density.at(above, e).value - density.at(below, e).value) / (2.0 * step);
    CHECK_THAT(at.gradient(j), WithinRel(slope, 2e-4) || WithinAbs(slope, margin));
  }
}

double log_jacobian(const std::vector<double>& z) {
  double sum = 0.0;
  for (const double each : z) sum += std::log(each) + std::log1p(-each);
  return sum;
}

}  // namespace

TEST_CASE("posterior density: white noise of known size gives the cost of the fit", "[calib]") {
  const Scene scene;
  const PosteriorDensity density = scene.density();
  CHECK(density.noise() == 1.0);
  const VectorXd y = density.from_unit(scene.optimum.z);
  CHECK_THAT(density.to_unit(y)[2], WithinRel(scene.optimum.z[2], 1e-12));
  const double here = density.at(y).value;
  VectorXd there = y;
  there += 0.05 * VectorXd::LinSpaced(y.size(), -1.0, 1.0);
  const std::vector<double> z = density.to_unit(there);
  const Evaluation other = evaluate_at(scene.problem, z, 1);
  // The prior of the mass is normal in the mass, but the coordinate is its logarithm. The density
  // in this coordinate is the density of the mass times the mass.
  const double scales = std::log(scene.problem.map.to_physical(0, z[0]) /
                                 scene.problem.map.to_physical(0, scene.optimum.z[0]));
  CHECK_THAT(density.at(there).value - here,
             WithinAbs(scene.optimum.cost - other.cost + scales + log_jacobian(z) -
                           log_jacobian(scene.optimum.z),
                       1e-6));
}

TEST_CASE("posterior density: its gradient is that of its value", "[calib]") {
  // The simulations are as accurate as possible, so that finite differences are accurate.
  Scene scene(1e-12);
  // Correlated residuals make each unknown less certain than white noise would, by its own factor.
  const double stretched[] = {1.5, 1.2, 3.0, 2.0, 1.1};
  for (std::size_t j = 0; j < scene.parameters.size(); ++j)
    scene.found.standard_error[j] = stretched[j] * scene.white_error(j);
  const PosteriorDensity density = scene.density();
  const VectorXd centre = density.from_unit(scene.optimum.z);
  for (const double off : {0.0, 0.1, -0.4}) {
    CAPTURE(off);
    VectorXd y = centre;
    y += off * VectorXd::LinSpaced(y.size(), 1.0, -0.5);
    check_gradient(density, y, VectorXd(), 2e-3);
  }
}

TEST_CASE("posterior density: its curvature is that of the errors that the fit states", "[calib]") {
  Scene scene;
  const std::size_t j = 2;  // index of the valve gain
  // The search direction fixes all unknowns but one. The curvature along that unknown is the
  // inverse of the covariance, whose shape does not change if all unknowns are scaled alike.
  const auto curvature = [&](const PosteriorDensity& density) {
    const VectorXd centre = density.from_unit(scene.optimum.z);
    const double step = 2e-3;
    VectorXd above = centre;
    VectorXd below = centre;
    above(2) += step;
    below(2) -= step;
    return -(density.at(above).value + density.at(below).value - 2.0 * density.at(centre).value) /
           (step * step);
  };
  const double plain = curvature(scene.density());
  for (std::size_t k = 0; k < scene.parameters.size(); ++k)
    scene.found.standard_error[k] = 3.0 * scene.white_error(k);
  const PosteriorDensity wide = scene.density();
  CHECK_THAT(wide.noise(), WithinRel(9.0, 1e-6));
  // The curvature of the transform itself, 2 z (1 - z), is not scaled.
  const double z = scene.optimum.z[j];
  const double own = 2.0 * z * (1.0 - z);
  CHECK_THAT((plain - own) / (curvature(wide) - own), WithinRel(9.0, 0.02));
  // The robust error is used if the interval is based on it.
  for (FittedParameter& each : scene.parameters)
    each.ci95_from = std::optional(IntervalSource::robust_standard_error);
  for (std::size_t k = 0; k < scene.parameters.size(); ++k)
    scene.found.robust_standard_error[k] = 2.0 * scene.white_error(k);
  CHECK_THAT((plain - own) / (curvature(scene.density()) - own), WithinRel(4.0, 0.25));
}

TEST_CASE("posterior density: the normal approximation is that of the density", "[calib]") {
  Scene scene;
  const bool is_white = GENERATE(true, false);
  CAPTURE(is_white);
  // Otherwise each unknown is less certain than white noise would make it, by its own factor.
  const double stretched[] = {1.5, 1.2, 3.0, 2.0, 1.1};
  for (std::size_t j = 0; j < scene.parameters.size() && !is_white; ++j)
    scene.found.standard_error[j] = stretched[j] * scene.white_error(j);
  const PosteriorDensity density = scene.density();
  const VectorXd centre = density.centre();
  // Compares the gradient along a small step, which is almost linear, with what the covariance
  // predicts.
  const Eigen::LLT<Eigen::MatrixXd> factor(density.covariance());
  const Eigen::MatrixXd lower = factor.matrixL();
  const VectorXd base = density.at(centre).gradient;
  for (Eigen::Index k = 0; k < centre.size(); ++k) {
    CAPTURE(k);
    const VectorXd step = 0.1 * lower.col(k);
    const VectorXd change = lower.transpose() * (density.at(centre + step).gradient - base);
    CHECK_THAT(change(k), WithinRel(-0.1, 0.3));
  }
}

TEST_CASE("posterior density: with white noise, effects change the outputs", "[calib]") {
  const Scene scene(1e-10, false);
  EffectLikelihood effects = effects_in(scene);
  effects.covariance.setIdentity();
  const PosteriorDensity exact = scene.density();
  const PosteriorDensity density(scene.problem, scene.optimum, scene.found, scene.parameters,
                                 nullptr, &effects);
  const auto count = effects.taken.cols();
  VectorXd e(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double size = 0.1 + 0.05 * static_cast<double>(k);
    e(k) = effects.one_sided[static_cast<std::size_t>(k)] || k % 2 == 0 ? size : -size;
  }
  std::vector<double> z = scene.optimum.z;
  z[2] += 0.003;
  const Evaluation there = evaluate_at(scene.problem, z, 1, {Fidelity::full, nullptr, true});
  double change = -0.5 * e.squaredNorm();
  for (std::size_t i = 0; i < scene.problem.conditions.size(); ++i) {
    const VectorXd& residual = (*there.rows)[i].residual;
    const VectorXd by_effects = density.changes(i, e);
    REQUIRE(by_effects.norm() > 1.0);
    change -= 0.5 * ((residual + by_effects).squaredNorm() - residual.squaredNorm());
  }
  const VectorXd y = density.from_unit(z);
  CHECK_THAT(density.value(y, e) - exact.value(y), WithinRel(change, 1e-3));
}

TEST_CASE("posterior density: with effects, its gradient is that of its value", "[calib]") {
  Scene scene(1e-12);
  const double stretched[] = {1.5, 1.2, 3.0, 2.0, 1.1};
  for (std::size_t j = 0; j < scene.parameters.size(); ++j)
    scene.found.standard_error[j] = stretched[j] * scene.white_error(j);
  const EffectLikelihood effects = effects_in(scene);
  const PosteriorDensity density(scene.problem, scene.optimum, scene.found, scene.parameters,
                                 nullptr, &effects);
  const VectorXd e = 0.7 * effects.mean + VectorXd::Constant(effects.mean.size(), 0.02);
  for (const double off : {0.0, 0.1}) {
    CAPTURE(off);
    const VectorXd& centre = density.centre();
    check_gradient(density, centre + off * VectorXd::LinSpaced(centre.size(), 1.0, -0.5), e, 5e-3);
  }
}

TEST_CASE("posterior density: sizes of effects change as the density allows", "[calib]") {
  const Scene scene;
  const EffectLikelihood effects = effects_in(scene);
  const PosteriorDensity density(scene.problem, scene.optimum, scene.found, scene.parameters,
                                 nullptr, &effects);
  const SizesBeside& sizes = density.sizes_beside();
  const auto weight = [&](const VectorXd& y, const VectorXd& e) {
    return density.value(y, e) - density.log_volume(y) - sizes.slope.dot(e) +
           0.5 * e.dot(sizes.precision * e);
  };
  auto stream = datasets::random_stream(5, {"steps"});
  // Close to the optimum some steps are accepted, although the short records leave large sizes.
  VectorXd y = density.centre();
  VectorXd e = effects.mean;
  int accepted = 0;
  for (int i = 0; i < 20; ++i) accepted += step_sizes(density, 20, stream, y, e).accepted ? 1 : 0;
  CHECK(accepted > 0);
  // Far from it they are not. A step to a point e^40 times less probable is not accepted.
  y.array() += 1.5;
  int refused = 0;
  for (int i = 0; i < 20; ++i) {
    const double before = weight(y, e);
    const VectorXd last = e;
    const bool moved = step_sizes(density, 20, stream, y, e).accepted;
    refused += moved ? 0 : 1;
    CHECK((e == last) == !moved);
    CHECK(weight(y, e) > before - 40.0);
  }
  CHECK(refused > 5);
}

TEST_CASE("posterior density: there is none where the model cannot be simulated", "[calib]") {
  Scene scene;
  const PosteriorDensity density = scene.density();
  const std::atomic<bool> cancelled = true;
  const PosteriorDensity stopped(scene.problem, scene.optimum, scene.found, scene.parameters,
                                 &cancelled);
  const VectorXd centre = density.centre();
  CHECK(std::isfinite(density.at(centre).value));
  CHECK(stopped.at(centre).value == -HUGE_VAL);
}

}  // namespace rigcal::calib
