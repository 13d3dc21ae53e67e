#include <Eigen/LU>
#include <catch2/catch.hpp>

#include "calib/search/evaluator.hpp"
#include "calib/search/search.hpp"
#include "calib/trust/prediction_band.hpp"
#include "calib/trust/uncertainty.hpp"
#include "tests/calib/twin.hpp"

namespace rigcal::calib {
namespace {

using datasets::Scope;
using datasets::Waveform;
using Eigen::Index;
using Eigen::MatrixXd;

/// Conditions with one offset each. There is prior knowledge about half of the offsets.
struct Offsets {
  Twin twin;
  std::vector<datasets::Record> records;

  explicit Offsets(int conditions) {
    twin.free("mass", 80.0, 10.0, 500.0);
    twin.free("damping", 900.0, 100.0, 5000.0);
    datasets::ParameterSetting& offset =
        twin.free("position_offset", 0.0, -5e-3, 5e-3, Scope::condition);
    offset.nuisance = true;
    offset.prior = datasets::Prior{0.0, 2e-5};
    for (int i = 0; i < conditions; ++i) {
      const std::string id = "c" + std::to_string(i);
      twin.add(id, Waveform::sine, 3.0 + 0.1 * i, 0.01);
      twin.offsets[id] = {Twin::index("position_offset"), 1e-5 * (i % 7 - 3)};
    }
    records = twin.records(120, 300.0, 4);
  }
};

std::vector<const datasets::Condition*> conditions_of(const Twin& twin) {
  std::vector<const datasets::Condition*> result;
  for (const auto& each : twin.campaign.conditions) result.push_back(&each);
  return result;
}

/// J^T J and J^T r over all unknowns, from the R factors of the conditions.
struct Dense {
  MatrixXd normal;
  Eigen::VectorXd gradient;
};

Dense dense_of(const Problem& problem, const Evaluation& at) {
  const auto n = static_cast<Index>(at.z.size());
  Dense result{MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (std::size_t i = 0; i < at.conditions.size(); ++i) {
    const MatrixXd& r = at.conditions[i].r_factor;
    const std::vector<int>& acting = problem.map.acting(i);
    const MatrixXd jacobian = r.leftCols(r.cols() - 1);
    result.normal(acting, acting) += jacobian.transpose() * jacobian;
    result.gradient(acting) += jacobian.transpose() * r.col(r.cols() - 1);
  }
  for (Index j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    const double slope = problem.map.prior_slope(static_cast<int>(j), at.z[u]);
    result.normal(j, j) += slope * slope;
    result.gradient(j) += slope * problem.map.prior_residual(static_cast<int>(j), at.z[u]);
  }
  return result;
}

}  // namespace

TEST_CASE("own unknowns: few are together with the others, many are apart", "[calib]") {
  for (const int conditions : {30, 31}) {
    const Offsets rig(conditions);
    const ParameterMap map(rig.twin.campaign, conditions_of(rig.twin), false);
    const ArrowLayout& layout = map.layout();
    const bool apart = map.unknowns().size() > kMostTogether;
    CHECK(apart == (conditions == 31));
    CHECK(layout.own.size() == (apart ? 31U : 0U));
    CHECK(layout.shared.size() == (apart ? 2U : 32U));
    for (std::size_t i = 0; i < layout.own.size(); ++i) {
      REQUIRE(layout.own[i].size() == 1);
      CHECK(map.unknowns()[static_cast<std::size_t>(layout.own[i][0])].level ==
            "c" + std::to_string(i));
    }
  }
}

TEST_CASE("own unknowns: system, errors and spread are those of the dense matrix", "[calib]") {
  const Offsets rig(36);
  const Problem problem =
      make_problem(rig.twin.campaign, rig.records, conditions_of(rig.twin), false, nullptr);
  REQUIRE(problem.map.layout().own.size() == 36);
  const Evaluation at = evaluate_at(problem, problem.start(), 1, {Fidelity::full, nullptr, true});
  REQUIRE(at.ok);
  const Dense dense = dense_of(problem, at);
  const Linearisation system = linearise(problem, at);
  const auto n = static_cast<Index>(at.z.size());
  MatrixXd normal(n, n);
  for (Index j = 0; j < n; ++j) normal.col(j) = system.normal() * Eigen::VectorXd::Unit(n, j);
  CHECK((normal - dense.normal).norm() < 1e-12 * dense.normal.norm());
  CHECK((system.gradient() - dense.gradient).norm() < 1e-11 * dense.gradient.norm());
  CHECK(0.5 * system.square() == Approx(at.cost).epsilon(1e-12));

  const Uncertainty found = uncertainty(problem, at, *at.rows, 1, Detail::plain);
  const double sigma = std::sqrt(std::max(1.0, found.reduced_chi_square));
  const MatrixXd inverse = dense.normal.inverse();
  CHECK(found.rank == static_cast<int>(n));
  const auto slope = [&](Index j) {
    return problem.map.slope(static_cast<int>(j), at.z[static_cast<std::size_t>(j)]);
  };
  for (Index j = 0; j < n; ++j) {
    const auto& error = found.standard_error[static_cast<std::size_t>(j)];
    REQUIRE(error);
    CHECK(*error == Approx(sigma * slope(j) * std::sqrt(inverse(j, j))).epsilon(1e-9));
    for (Index k = 0; k < n; ++k) {
      CHECK(found.correlation(j, k) ==
            Approx(inverse(j, k) / std::sqrt(inverse(j, j) * inverse(k, k))).margin(1e-9));
    }
  }
  const EstimateCovariance spread = estimate_covariance(problem, at.z, found);
  REQUIRE(spread.own.size() == 36);
  REQUIRE(spread.estimates.size() == 2);
  const auto& shared = problem.map.layout().shared;
  for (std::size_t i = 0; i < spread.own.size(); ++i) {
    const EstimateCovariance::Own& own = spread.own[i];
    REQUIRE(own.estimates.size() == 1);
    std::vector<int> unknowns = problem.map.layout().own[i];
    CHECK(own.estimates[0].level ==
          problem.map.unknowns()[static_cast<std::size_t>(unknowns[0])].level);
    unknowns.insert(unknowns.end(), shared.begin(), shared.end());
    const MatrixXd covariance = own.root * own.root.transpose();
    for (Index a = 0; a < 3; ++a) {
      for (Index b = 0; b < 3; ++b) {
        const Index j = unknowns[static_cast<std::size_t>(a)];
        const Index k = unknowns[static_cast<std::size_t>(b)];
        const double expected = sigma * sigma * slope(j) * slope(k) * inverse(j, k);
        const double size = sigma * sigma * std::abs(slope(j) * slope(k)) *
                            std::sqrt(inverse(j, j) * inverse(k, k));
        CHECK(std::abs(covariance(a, b) - expected) < 1e-9 * size);
      }
    }
  }
}

TEST_CASE("own unknowns: a fit finds them, and stores correlations of the shared ones", "[calib]") {
  const Offsets rig(36);
  const Fit found = fit(rig.twin.campaign, rig.records, {});
  REQUIRE(found.status == FitStatus::converged);
  CHECK(found.correlation.names == std::vector<std::string>{"mass_kg", "damping_n_s_per_m"});
  CHECK(found.correlation.matrix.rows() == 2);
  CHECK(found.correlation.matrix(0, 1) == found.correlation.matrix(1, 0));
  int beyond = 0;  // number of 95 % intervals that miss the true value
  for (const FittedParameter& each : found.parameters) {
    if (!each.fitted) continue;
    REQUIRE(each.ci95);
    CHECK(each.correlated == (each.scope == Scope::rig));
    const double truth = each.scope == Scope::condition
                             ? rig.twin.offsets.at(each.level.value()).second
                             : rig.twin.truth.setting(each.index)->value;
    beyond += truth < each.ci95->low || truth > each.ci95->high;
    CHECK(each.robust_standard_error.value() > 0.5 * each.standard_error.value());
    CHECK(each.robust_standard_error.value() < 2.0 * each.standard_error.value());
  }
  CHECK(beyond <= 7);  // 2 of 38 expected; P(more) = 2e-3 if they are independent
}

}  // namespace rigcal::calib
