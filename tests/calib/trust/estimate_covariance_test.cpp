#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "calib/trust/prediction_band.hpp"
#include "tests/calib/twin.hpp"

// Covariance of the estimates and band around a prediction, compared with hand calculations.

namespace rigcal::calib {
namespace {

using Catch::WithinAbs;
using Catch::WithinRel;
using datasets::Channel;
using datasets::Scope;
using Eigen::Index;
using Eigen::MatrixXd;

/// Two unknowns, the first with an optional prior, and the inputs for their uncertainty.
struct Scene {
  Twin twin;
  std::vector<datasets::Record> records;
  Problem problem;
  std::vector<double> z{0.3, 0.4};
  Uncertainty uncertainty;

  explicit Scene(bool prior = false)
      : twin(twin_with(prior)),
        records(twin.records(40, 500.0, 1)),
        problem(problem_of(twin, records)) {
    uncertainty.root = MatrixXd::Identity(2, 2);
    uncertainty.covariance_root = MatrixXd::Identity(2, 2);
    uncertainty.reduced_chi_square = 1.0;
    uncertainty.standard_error.resize(2);
    uncertainty.robust_standard_error.resize(2);
    uncertainty.robust_quantile = {0.0, 0.0};
  }

  static Twin twin_with(bool prior) {
    Twin twin;
    twin.free("valve_gain", 4e-5, 1e-5, 2e-4);
    auto& bulk = twin.free("bulk_modulus", 8e8, 1e8, 3e9);
    if (prior) bulk.prior = datasets::Prior{7e8, 5e7};
    twin.add("a", datasets::Waveform::square, 2.0, 0.01);
    return twin;
  }

  double slope(int j) const {
    return std::abs(problem.map.slope(j, z[static_cast<std::size_t>(j)]));
  }
  /// Returns the standard deviations of the estimates in the unit box, that is, in SI divided by
  /// the slopes.
  std::pair<double, double> in_box() const {
    const MatrixXd& root = estimate_covariance(problem, z, uncertainty).root;
    return {root.row(0).norm() / slope(0), root.row(1).norm() / slope(1)};
  }
  /// Converts a standard error from the unit box to SI.
  std::optional<double> error(int j, double boxed) const { return boxed * slope(j); }

  void add_scatter(double first, double second, double both = 0.0) {
    ScoreContribution each;
    each.covariance.resize(2, 2);
    each.covariance << first, both, both, second;
    uncertainty.scatter.push_back(each);
  }
};

void require_box(const Scene& scene, double first, double second) {
  const auto [a, b] = scene.in_box();
  CHECK_THAT(a, WithinRel(first, 1e-9));
  CHECK_THAT(b, WithinRel(second, 1e-9));
}

}  // namespace

TEST_CASE("estimate_covariance: without scatter, sigma^2 (J^T J)^-1 of the misfit", "[calib]") {
  Scene scene;
  require_box(scene, 1.0, 1.0);
  scene.uncertainty.root = (Eigen::Matrix2d() << 2.0, 0.0, 0.0, 3.0).finished();
  require_box(scene, 2.0, 3.0);
  // If the residuals exceed the noise, standard deviations grow with the square root of chi-square.
  scene.uncertainty.reduced_chi_square = 4.0;
  require_box(scene, 4.0, 6.0);
  scene.uncertainty.reduced_chi_square = 1.0001;
  require_box(scene, 2.0 * std::sqrt(1.0001), 3.0 * std::sqrt(1.0001));
  // The noise is known, so residuals below it carry no information.
  scene.uncertainty.reduced_chi_square = 0.25;
  require_box(scene, 2.0, 3.0);
}

TEST_CASE("estimate_covariance: estimates with whose they are, and their correlation", "[calib]") {
  Scene scene;
  scene.uncertainty.root = (Eigen::Matrix2d() << 1.0, 0.0, -2.0, 1.0).finished();
  const EstimateCovariance spread = estimate_covariance(scene.problem, scene.z, scene.uncertainty);
  REQUIRE(spread.estimates.size() == 2);
  CHECK(spread.estimates[0].index == Twin::index("bulk_modulus"));
  CHECK(spread.estimates[1].index == Twin::index("valve_gain"));
  CHECK(spread.estimates[0].scope == Scope::rig);
  REQUIRE(spread.root.rows() == 2);
  const MatrixXd covariance = spread.root * spread.root.transpose();
  CHECK_THAT(covariance(0, 1), WithinRel(-2.0 * scene.slope(0) * scene.slope(1), 1e-9));
  CHECK_THAT(covariance(1, 1), WithinRel(5.0 * scene.slope(1) * scene.slope(1), 1e-9));
}

TEST_CASE("estimate_covariance: with scatter, the sum of that of all conditions", "[calib]") {
  Scene scene;
  scene.uncertainty.reduced_chi_square = 100.0;  // no effect in this case
  scene.add_scatter(4.0, 1.0);
  require_box(scene, 2.0, 1.0);
  scene.add_scatter(5.0, 24.0);
  require_box(scene, 3.0, 5.0);
  scene.uncertainty.root = (Eigen::Matrix2d() << 2.0, 0.0, 0.0, 3.0).finished();
  require_box(scene, 6.0, 15.0);
  scene.add_scatter(0.0, 0.0, 9.0);
  const EstimateCovariance spread = estimate_covariance(scene.problem, scene.z, scene.uncertainty);
  const MatrixXd covariance = spread.root * spread.root.transpose();
  CHECK_THAT(covariance(0, 1), WithinRel(2.0 * 9.0 * 3.0 * scene.slope(0) * scene.slope(1), 1e-9));
}

TEST_CASE("estimate_covariance: a prior is one more source of scatter", "[calib]") {
  Scene scene(true);
  const double weight = scene.problem.map.prior_slope(0, scene.z[0]);
  REQUIRE(weight > 0.0);
  scene.add_scatter(4.0, 9.0);
  require_box(scene, std::sqrt(4.0 + weight * weight), 3.0);
  scene.uncertainty.scatter.clear();
  require_box(scene, 1.0, 1.0);  // J^T J already includes it
}

TEST_CASE("estimate_covariance: as wide as the widest interval by its own error", "[calib]") {
  Scene scene;
  scene.uncertainty.root = (Eigen::Matrix2d() << 2.0, 0.0, 0.0, 3.0).finished();
  scene.uncertainty.standard_error[0] = scene.error(0, 1.5);  // less than 2
  require_box(scene, 2.0, 3.0);
  scene.uncertainty.standard_error[0] = scene.error(0, 5.0);
  require_box(scene, 5.0, 7.5);  // one factor for all, so that correlations do not change
  scene.uncertainty.standard_error[1] = scene.error(1, 6.0);
  require_box(scene, 5.0, 7.5);
  scene.uncertainty.standard_error[1] = scene.error(1, 9.0);
  require_box(scene, 6.0, 9.0);
  // Without score covariances, robust errors and quantiles have no effect.
  scene.uncertainty.robust_standard_error[0] = scene.error(0, 50.0);
  scene.uncertainty.robust_quantile = {20.0, 20.0};
  require_box(scene, 6.0, 9.0);
}

TEST_CASE("estimate_covariance: by few degrees of freedom as wide as the quantile asks",
          "[calib]") {
  Scene scene;
  scene.add_scatter(4.0, 9.0);
  scene.uncertainty.standard_error = {scene.error(0, 100.0), scene.error(1, 100.0)};
  require_box(scene, 2.0, 3.0);
  scene.uncertainty.robust_standard_error[0] = scene.error(0, 2.0);
  scene.uncertainty.robust_quantile[0] = 1.96;
  require_box(scene, 2.0, 3.0);
  scene.uncertainty.robust_quantile[0] = 3.92;
  require_box(scene, 4.0, 6.0);
  scene.uncertainty.robust_standard_error[0] = scene.error(0, 3.0);
  require_box(scene, 6.0, 9.0);
  scene.uncertainty.robust_quantile[0] = 0.0;  // unknown
  require_box(scene, 3.0, 4.5);
  // The quantile of another estimate has no effect on this one.
  scene.uncertainty.robust_quantile[1] = 12.71;
  require_box(scene, 3.0, 4.5);
}

TEST_CASE("estimate_covariance: known values add theirs, unwidened", "[calib]") {
  Scene scene;
  scene.uncertainty.known.names = {"supply_pressure"};
  scene.uncertainty.known.response.resize(2, 1);
  scene.uncertainty.known.response << 3.0, -4.0;
  require_box(scene, std::hypot(1.0, 3.0), std::hypot(1.0, 4.0));
  const EstimateCovariance spread = estimate_covariance(scene.problem, scene.z, scene.uncertainty);
  const MatrixXd covariance = spread.root * spread.root.transpose();
  CHECK_THAT(covariance(0, 1), WithinRel(-12.0 * scene.slope(0) * scene.slope(1), 1e-9));
  // The known value contributes 3 to the error of 5, so the records contribute 4: four times 1.
  scene.uncertainty.standard_error[0] = scene.error(0, 5.0);
  require_box(scene, 5.0, std::hypot(4.0, 4.0));
  // An error smaller than the contribution of known values does not widen anything.
  scene.uncertainty.standard_error[0] = scene.error(0, 2.0);
  require_box(scene, std::hypot(1.0, 3.0), std::hypot(1.0, 4.0));
}

TEST_CASE("estimate_covariance: directions that are not determined have the spread of the least",
          "[calib]") {
  Scene scene;
  scene.uncertainty.root = Eigen::Vector2d(1.0, 0.0);
  scene.uncertainty.covariance_root = (Eigen::Matrix2d() << 1.0, 0.0, 0.0, 7.0).finished();
  require_box(scene, 1.0, 7.0);
  // This widens only the determined direction.
  scene.uncertainty.standard_error[0] = scene.error(0, 3.0);
  require_box(scene, 3.0, 7.0);
  scene.uncertainty.standard_error[1] = scene.error(1, 100.0);
  require_box(scene, 3.0, 7.0);
}

TEST_CASE("are_correlations: no combination of parameters has a negative variance", "[calib]") {
  const auto with = [](double ab, double ac, double bc) {
    return (Eigen::Matrix3d() << 1.0, ab, ac, ab, 1.0, bc, ac, bc, 1.0).finished();
  };
  CHECK(are_correlations(with(0.9, 0.9, 0.9)));
  CHECK(are_correlations(with(1.0, 1.0, 1.0)));  // one direction is all that is determined
  // The variance of a - b - c would be 3 - 2 (0.9 + 0.9 + 0.9).
  CHECK_FALSE(are_correlations(with(0.9, 0.9, -0.9)));
  CHECK_FALSE(are_correlations(with(1.1, 0.0, 0.0)));
  MatrixXd lopsided = with(0.9, 0.9, 0.9);
  lopsided(0, 1) = 0.5;
  CHECK_FALSE(are_correlations(lopsided));
  MatrixXd stretched = with(0.0, 0.0, 0.0);
  stretched(2, 2) = 2.0;
  CHECK_FALSE(are_correlations(stretched));
}

namespace {

/// The prediction band of a condition for given estimates.
struct Band {
  Twin twin;
  std::vector<datasets::Record> records;
  Problem problem;

  /// @param known  whether the valve gain is known in the first condition
  explicit Band(bool known = false)
      : twin(twin_with(known)),
        records(twin.records(60, 500.0, 1)),
        problem(problem_of(twin, records)) {}

  static Twin twin_with(bool known) {
    Twin twin;
    twin.free("bulk_modulus", 8e8, 1e8, 3e9);
    auto& first = twin.add("a", datasets::Waveform::square, 2.0, 0.01, "none");
    if (known) first.overrides.emplace_back(Twin::index("valve_gain"), 4e-5);
    twin.add("b", datasets::Waveform::square, 2.0, 0.01, "large");
    return twin;
  }

  /// Returns the largest standard deviation of the band without noise, divided by the largest
  /// sensitivity to the valve gain.
  double part(std::size_t condition, const std::vector<EstimateCovariance::Estimate>& estimates,
              const std::vector<double>& sds) const {
    EstimateCovariance spread;
    spread.estimates = estimates;
    spread.root = MatrixXd::Zero(static_cast<Index>(sds.size()), static_cast<Index>(sds.size()));
    for (std::size_t j = 0; j < sds.size(); ++j)
      spread.root(static_cast<Index>(j), static_cast<Index>(j)) = sds[j];
    std::vector<ConditionScore> scores(2);
    for (std::size_t i = 0; i < 2; ++i) scores[i].time_s = records[i].time_s;
    const std::vector<double> z{0.4};
    add_prediction_sd(problem, z, spread, {}, 1, scores);
    const auto& band = scores[condition].prediction_sd.at(Channel::position);
    REQUIRE(band.size() == records[condition].time_s.size());
    const double noise = problem.conditions[condition].channels[0].sd;
    const model::Simulation run =
        model::simulate(problem.conditions[condition].rig, problem.values_at(condition, z),
                        std::vector<int>{Twin::index("valve_gain")},
                        problem.conditions[condition].inputs, records[condition].time_s,
                        problem.conditions[condition].outputs, problem.simulation_options());
    REQUIRE(run.ok());
    const double one = run.sensitivities[0].col(0).cwiseAbs().maxCoeff();
    double most = 0.0;
    for (const double sd : band)
      most = std::max(most, std::sqrt(std::max(0.0, sd * sd - noise * noise)));
    return most / one;
  }
};

EstimateCovariance::Estimate gain(Scope scope = Scope::rig, const std::string& level = {}) {
  return {Twin::index("valve_gain"), scope, level};
}

}  // namespace

TEST_CASE("prediction band: an estimate acts by its own sensitivity", "[calib]") {
  const Band band;
  CHECK_THAT(band.part(0, {gain()}, {1e-5}), WithinRel(1e-5, 1e-4));
  CHECK_THAT(band.part(1, {gain()}, {3e-5}), WithinRel(3e-5, 1e-4));
  CHECK_THAT(band.part(0, {}, {}), WithinAbs(0.0, 1e-12));
}

TEST_CASE("prediction band: what acts in a condition, by the scope of the estimate", "[calib]") {
  const Band band;
  for (const auto& [estimate, first, second] :
       {std::tuple{gain(Scope::condition, "a"), true, false},
        std::tuple{gain(Scope::condition, "b"), false, true},
        std::tuple{gain(Scope::condition, "none"), false, false},
        std::tuple{gain(Scope::leak_level, "none"), true, false},
        std::tuple{gain(Scope::leak_level, "large"), false, true},
        std::tuple{gain(Scope::leak_level, "a"), false, false}}) {
    CAPTURE(estimate.level);
    CHECK_THAT(band.part(0, {estimate}, {1e-5}), WithinAbs(first ? 1e-5 : 0.0, 1e-9));
    CHECK_THAT(band.part(1, {estimate}, {1e-5}), WithinAbs(second ? 1e-5 : 0.0, 1e-9));
  }
}

TEST_CASE("prediction band: the value of a condition or level goes before that of the rig",
          "[calib]") {
  const Band band;
  for (const auto& own : {gain(Scope::condition, "a"), gain(Scope::leak_level, "none")}) {
    CAPTURE(own.level);
    CHECK_THAT(band.part(0, {gain(), own}, {1e-5, 2e-5}), WithinRel(2e-5, 1e-4));
    CHECK_THAT(band.part(0, {own, gain()}, {2e-5, 1e-5}), WithinRel(2e-5, 1e-4));
    CHECK_THAT(band.part(1, {gain(), own}, {1e-5, 2e-5}), WithinRel(1e-5, 1e-4));
    CHECK_THAT(band.part(1, {own, gain()}, {2e-5, 1e-5}), WithinRel(1e-5, 1e-4));
  }
}

TEST_CASE("prediction band: a value that a condition knows is not uncertain there", "[calib]") {
  const Band band(true);
  CHECK_THAT(band.part(0, {gain()}, {1e-5}), WithinAbs(0.0, 1e-9));
  CHECK_THAT(band.part(1, {gain()}, {1e-5}), WithinRel(1e-5, 1e-4));
}

TEST_CASE("prediction band: the noise is that of a measured sample of the channel", "[calib]") {
  const Band band;
  std::vector<ConditionScore> scores(2);
  for (std::size_t i = 0; i < 2; ++i) scores[i].time_s = band.records[i].time_s;
  add_prediction_sd(band.problem, std::vector<double>{0.4}, {}, {}, 1, scores);
  for (const double sd : scores[0].prediction_sd.at(Channel::position))
    CHECK_THAT(sd, WithinRel(band.twin.noise_sd_m, 1e-12));
}

}  // namespace rigcal::calib
