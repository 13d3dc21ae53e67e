#include "calib/problem/arrow.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <catch2/catch.hpp>
#include <numeric>
#include <random>

#include "calib/descent/box_step.hpp"
#include "calib/problem/arrow_svd.hpp"
#include "calib/trust/sandwich.hpp"

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A system of several conditions, in which each condition's own unknowns are placed between the
/// shared ones, and the same system as a dense one.
struct RandomSystem {
  std::mt19937 random;
  Linearisation arrow;
  Linearisation dense;
  static constexpr Index kShared = 3;

  /// @param counts  number of own unknowns for each condition
  RandomSystem(unsigned seed, const std::vector<int>& counts) : random(seed) {
    const int all = std::accumulate(counts.begin(), counts.end(), static_cast<int>(kShared));
    std::vector<int> order(static_cast<std::size_t>(all));
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), random);
    arrow.shared.assign(order.begin(), order.begin() + kShared);
    std::sort(arrow.shared.begin(), arrow.shared.end());
    auto next = order.begin() + kShared;
    for (const int count : counts) {
      Linearisation::Own& own = arrow.own.emplace_back();
      own.unknowns.assign(next, next + count);
      std::sort(own.unknowns.begin(), own.unknowns.end());
      next += count;
      own.jacobian = draw(count, count) + 3.0 * MatrixXd::Identity(count, count);
      own.coupling = draw(count, kShared);
      own.residual = draw(count, 1);
    }
    arrow.jacobian = draw(kShared + 1, kShared);
    arrow.residual = draw(kShared + 1, 1);
    flatten();
  }

  MatrixXd draw(Index rows, Index columns) {
    std::normal_distribution<double> normal;
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
  }

  void flatten() {
    const Index n = arrow.unknowns();
    dense.jacobian = MatrixXd::Zero(n + 1, n);
    dense.residual = VectorXd::Zero(n + 1);
    Index row = 0;
    for (const Linearisation::Own& own : arrow.own) {
      const auto count = static_cast<Index>(own.unknowns.size());
      auto rows = dense.jacobian.middleRows(row, count);
      for (Index j = 0; j < count; ++j)
        rows.col(own.unknowns[static_cast<std::size_t>(j)]) = own.jacobian.col(j);
      for (Index j = 0; j < kShared; ++j) rows.col(arrow.shared_unknown(j)) = own.coupling.col(j);
      dense.residual.segment(row, count) = own.residual;
      row += count;
    }
    for (Index j = 0; j < kShared; ++j)
      dense.jacobian.col(arrow.shared_unknown(j)).tail(kShared + 1) = arrow.jacobian.col(j);
    dense.residual.tail(kShared + 1) = arrow.residual;
  }
};

double distance(const MatrixXd& a, const MatrixXd& b) {
  return (a - b).norm() / std::max(1e-300, b.norm());
}

/// Returns all entries of R R^T.
MatrixXd all_products(const ArrowRoot& root) {
  const Index n = root.unknowns();
  return MatrixXd::NullaryExpr(n, n, [&](Index i, Index k) { return root.product(i, k); });
}

const std::vector<std::vector<int>> kShapes = {{1, 1, 1, 1}, {2, 0, 3}, {1}, {4, 4, 1, 2, 0, 1}};
constexpr double kSame = 1e-12;

}  // namespace

TEST_CASE("arrow: gradient, normal matrix and products are those of the dense system", "[calib]") {
  for (unsigned seed = 0; seed < 8; ++seed) {
    RandomSystem system(seed, kShapes[seed % kShapes.size()]);
    const Index n = system.arrow.unknowns();
    const MatrixXd normal = system.dense.jacobian.transpose() * system.dense.jacobian;
    const ArrowSquare square = system.arrow.normal();
    const VectorXd x = system.draw(n, 1);
    CHECK(system.arrow.square() == Approx(system.dense.residual.squaredNorm()).epsilon(kSame));
    CHECK(distance(system.arrow.gradient(), system.dense.gradient()) < kSame);
    CHECK(distance(square.diagonal(), normal.diagonal()) < kSame);
    CHECK(distance(square * x, normal * x) < kSame);
    std::vector<Index> kept;
    for (Index j = 0; j < n; ++j) {
      if (j % 3 != 1) kept.push_back(j);
    }
    const auto count = static_cast<Index>(kept.size());
    const VectorXd scale = VectorXd::LinSpaced(count, 0.5, 2.0);
    const VectorXd y = system.draw(count, 1);
    const MatrixXd part = scale.asDiagonal() * normal(kept, kept) * scale.asDiagonal();
    CHECK(distance(square.part(kept, scale) * y, part * y) < kSame);
  }
}

TEST_CASE("arrow: step, rank and covariance are those of the dense system", "[calib]") {
  for (unsigned seed = 0; seed < 8; ++seed) {
    const RandomSystem system(seed, kShapes[seed % kShapes.size()]);
    const ScaledSvd dense(system.dense.jacobian, 1e-8);
    const ArrowSvd arrow(system.arrow, 1e-8);
    CHECK(arrow.rank() == dense.rank());
    CHECK(distance(arrow.step(), dense.step(system.dense.residual)) < 1e-11);
    CHECK(arrow.explained() ==
          Approx(dense.explained(system.dense.residual).squaredNorm()).epsilon(kSame));
    CHECK(distance(arrow.inverse_lengths(), dense.inverse_lengths()) < kSame);
    const MatrixXd inverse = dense.root() * dense.root().transpose();
    CHECK(distance(all_products(arrow.root()), inverse) < 1e-11);
    CHECK(distance(all_products(arrow.covariance_root(2.0, 1e-9)), 4.0 * inverse) < 1e-11);
    // Compares the volume of the covariance, computed from the singular values.
    CHECK(arrow.singular_values().array().log().sum() ==
          Approx(dense.singular_values().array().log().sum()));
    CHECK(arrow.undetermined().empty());
  }
}

TEST_CASE("arrow: combinations of two rows and quadratic forms are those of all directions",
          "[calib]") {
  RandomSystem system(9, {2, 2, 1});
  const ArrowRoot root = ArrowSvd(system.arrow, 1e-8).root();
  const MatrixXd inverse = all_products(root);
  ArrowMatrix identity = root.zero();
  for (std::size_t i = 0; i < identity.own.size(); ++i) identity.own[i].setIdentity();
  identity.shared.setIdentity();
  for (Index i = 0; i < root.unknowns(); ++i) {
    CHECK(root.quadratic(i, identity) == Approx(inverse(i, i)).epsilon(kSame));
    for (Index k = 0; k < root.unknowns(); ++k) {
      const double expected = 4.0 * inverse(i, i) - 12.0 * inverse(i, k) + 9.0 * inverse(k, k);
      CHECK(root.square(i, 2.0, k, -3.0) == Approx(expected).epsilon(1e-10));
    }
  }
}

TEST_CASE("arrow: an own unknown that nothing tells is left out, its rows tell the others",
          "[calib]") {
  RandomSystem system(3, {2, 1, 2});
  Linearisation::Own& own = system.arrow.own[0];
  own.jacobian.col(1) = 2.0 * own.jacobian.col(0);
  system.flatten();
  const ScaledSvd dense(system.dense.jacobian, 1e-8);
  const ArrowSvd arrow(system.arrow, 1e-8);
  REQUIRE(arrow.rank() == dense.rank());
  CHECK(arrow.rank() == system.arrow.unknowns() - 1);
  const VectorXd step = arrow.step();
  CHECK(distance(step, dense.step(system.dense.residual)) < 1e-11);
  REQUIRE(arrow.undetermined().size() == 1);
  CHECK(arrow.undetermined()[0].unknowns == own.unknowns);
  const VectorXd open = arrow.undetermined()[0].parts.cwiseAbs();
  CHECK(open(0) == Approx(open(1)));  // for columns of length 1
}

TEST_CASE("arrow: a shared unknown that own ones replace is undetermined with them", "[calib]") {
  RandomSystem system(5, {1, 1, 1, 1});
  // An offset common to all records, in addition to that of each record.
  system.arrow.jacobian.col(1).setZero();
  for (Linearisation::Own& own : system.arrow.own) own.coupling.col(1) = own.jacobian.col(0);
  system.flatten();
  const ScaledSvd dense(system.dense.jacobian, 1e-8);
  const ArrowSvd arrow(system.arrow, 1e-8);
  REQUIRE(arrow.rank() == dense.rank());
  const auto open = arrow.undetermined();
  REQUIRE(open.size() == 1);
  VectorXd direction = VectorXd::Zero(system.arrow.unknowns());
  direction(open[0].unknowns) = open[0].parts;
  CHECK(std::abs(direction.dot(dense.V().rightCols(1).col(0))) == Approx(1.0));
  CHECK((system.dense.jacobian * arrow.step() + system.dense.residual).norm() ==
        Approx((system.dense.jacobian * dense.step(system.dense.residual) + system.dense.residual)
                   .norm()));
}

TEST_CASE("arrow: what is held takes no part", "[calib]") {
  RandomSystem system(7, {2, 1, 2});
  std::vector<bool> held(static_cast<std::size_t>(system.arrow.unknowns()), false);
  held[static_cast<std::size_t>(system.arrow.shared[1])] = true;
  held[static_cast<std::size_t>(system.arrow.own[2].unknowns[0])] = true;
  system.arrow.hold(held);
  system.dense.hold(held);
  const ArrowSvd arrow(system.arrow, 1e-8);
  const VectorXd step = arrow.step();
  CHECK(step(system.arrow.shared[1]) == 0.0);
  CHECK(step(system.arrow.own[2].unknowns[0]) == 0.0);
  CHECK(distance(step, ScaledSvd(system.dense.jacobian, 1e-8).step(system.dense.residual)) < 1e-11);
}

TEST_CASE("box_step: an arrow is stepped along as the dense matrix is", "[calib]") {
  for (unsigned seed = 0; seed < 24; ++seed) {
    RandomSystem system(seed, kShapes[seed % kShapes.size()]);
    const Index n = system.arrow.unknowns();
    QuadraticModel arrow{system.arrow.normal(), system.arrow.gradient()};
    if (seed % 3 == 1)
      arrow.hessian.blocks.shared -= 40.0 * MatrixXd::Identity(3, 3);  // indefinite
    if (seed % 3 == 2) arrow.gradient(arrow.hessian.layout.shared).setZero();
    MatrixXd whole(n, n);
    for (Index j = 0; j < n; ++j) whole.col(j) = arrow.hessian * VectorXd::Unit(n, j);
    const QuadraticModel dense{whole, arrow.gradient};
    const VectorXd bound = VectorXd::Constant(n, seed % 2 == 0 ? 10.0 : 0.1);
    const VectorXd scale = whole.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(0.1);
    for (const double radius : {0.2, 2.0, 100.0}) {
      const StepLimits limits{-bound, bound, scale, radius};
      const BoxStep found = box_step(arrow, limits);
      const BoxStep expected = box_step(dense, limits);
      CHECK(found.fall == Approx(expected.fall).epsilon(1e-6));
      CHECK(found.at_radius == expected.at_radius);
    }
    CHECK(distance(damped_step(system.arrow.normal(), arrow.gradient, 0.1),
                   -(MatrixXd(system.dense.jacobian.transpose() * system.dense.jacobian) +
                     0.1 * MatrixXd::Identity(n, n))
                        .llt()
                        .solve(arrow.gradient)) < 1e-11);
  }
}

TEST_CASE("sandwich: own directions tell the same as dense ones", "[calib]") {
  RandomSystem system(11, {1, 2, 1});
  constexpr Index kSamples = 400;
  const Index n = system.arrow.unknowns();
  // Each of the three conditions has a record that depends on its own unknowns and the shared ones.
  std::vector<MatrixXd> jacobians;
  MatrixXd normal = MatrixXd::Zero(n, n);
  std::vector<std::vector<int>> acting;
  for (const Linearisation::Own& own : system.arrow.own) {
    std::vector<int>& unknowns = acting.emplace_back(own.unknowns);
    unknowns.insert(unknowns.end(), system.arrow.shared.begin(), system.arrow.shared.end());
    jacobians.push_back(system.draw(kSamples, static_cast<Index>(unknowns.size())));
    normal(unknowns, unknowns) += jacobians.back().transpose() * jacobians.back();
  }
  const ArrowRoot root = ArrowSvd(system.arrow, 1e-8).root();
  // The same root as a dense matrix over all directions: those of each condition in turn, then the
  // shared ones.
  Index directions = root.shared().cols();
  for (std::size_t i = 0; i < 3; ++i) directions += root.own_directions(i);
  MatrixXd flat = MatrixXd::Zero(n, directions);
  for (Index j = 0; j < n; ++j) {
    Index first = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const VectorXd row = root.row(j, i);
      const Index own = root.own_directions(i);
      flat.row(j).segment(first, own) = row.head(own).transpose();
      flat.row(j).tail(root.shared().cols()) = row.tail(root.shared().cols()).transpose();
      first += own;
    }
  }
  std::vector<ScoreRows> by_arrow;
  std::vector<ScoreRows> by_flat;
  for (std::size_t i = 0; i < 3; ++i) {
    VectorXd residual = system.draw(kSamples, 1);
    for (Index t = 1; t < kSamples; ++t) residual(t) += 0.7 * residual(t - 1);
    by_arrow.push_back({jacobians[i] * root.rows(acting[i], i), residual, 2});
    by_flat.push_back({jacobians[i] * flat(acting[i], Eigen::all), residual, 2});
  }
  ArrowMatrix priors = root.zero();
  MatrixXd flat_priors = MatrixXd::Zero(directions, directions);
  const int own = system.arrow.own[1].unknowns[0];
  priors.add(1, 0.3 * root.row(own, 1) * root.row(own, 1).transpose());
  flat_priors += 0.3 * flat.row(own).transpose() * flat.row(own);
  const auto arrow = score_contributions(by_arrow, priors, root);
  const auto expected = score_contributions(by_flat, flat_priors, flat);
  for (Index j = 0; j < n; ++j) {
    const RobustVariance a = robust_variance(arrow, priors, root, j);
    const RobustVariance b = robust_variance(expected, flat_priors, flat, j);
    CHECK(a.variance == Approx(b.variance).epsilon(1e-11));
    if (root.condition_of(j) < 0) {
      CHECK(a.freedom == Approx(b.freedom).epsilon(1e-11));
      CHECK(a.own == Approx(b.own).epsilon(1e-11));
    } else {
      // Other conditions contribute through the shared unknowns, with the minimum of their degrees
      // of freedom.
      CHECK(a.freedom <= b.freedom * (1.0 + 1e-11));
      CHECK(a.freedom > 0.5 * b.freedom);
      CHECK(a.own <= b.own + 1e-11);
    }
  }
}

}  // namespace rigcal::calib
