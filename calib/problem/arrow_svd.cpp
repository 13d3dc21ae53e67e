#include "calib/problem/arrow_svd.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace rigcal::calib {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd inverse_of(const VectorXd& squares) {
  return squares.unaryExpr(
      [](double square) { return square > 0.0 ? 1.0 / std::sqrt(square) : 0.0; });
}

/// Returns the directions in the coordinates of the unknowns, each divided by its singular value.
MatrixXd over_singular_values(const ScaledSvd& svd, const std::optional<double>& floor,
                              double factor) {
  if (!floor) return factor * svd.root();
  const VectorXd lengths = factor * svd.singular_values().cwiseMax(*floor).cwiseInverse();
  return svd.inverse_lengths().asDiagonal() * svd.V() * lengths.asDiagonal();
}

}  // namespace

ArrowSvd::ArrowSvd(const Linearisation& system, double threshold)
    : inverse_lengths_(system.unknowns()) {
  VectorXd squares = system.jacobian.colwise().squaredNorm().transpose();
  Index left = system.jacobian.rows();
  for (const Linearisation::Own& each : system.own) {
    Block& block = blocks_.emplace_back();
    block.unknowns = each.unknowns;
    if (each.unknowns.empty()) continue;
    squares += each.coupling.colwise().squaredNorm().transpose();
    block.svd.emplace(each.jacobian, threshold);
    inverse_lengths_(block.unknowns) = block.svd->inverse_lengths();
    const MatrixXd turned = block.svd->U().transpose() * each.coupling;
    block.coupling = turned.topRows(block.svd->rank());
    block.explained = block.svd->explained(each.residual);
    left += each.jacobian.rows() - block.svd->rank();
  }
  for (Index j = 0; j < system.jacobian.cols(); ++j) shared_.push_back(system.shared_unknown(j));
  MatrixXd jacobian(left, system.jacobian.cols());
  VectorXd residual(left);
  jacobian.topRows(system.jacobian.rows()) = system.jacobian;
  residual.head(system.jacobian.rows()) = system.residual;
  // The shared unknowns are determined by the residual that a condition's own unknowns cannot
  // remove.
  Index row = system.jacobian.rows();
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    if (!blocks_[i].svd) continue;
    const MatrixXd& u = blocks_[i].svd->U();
    const auto rest = u.rightCols(u.cols() - blocks_[i].svd->rank());
    jacobian.middleRows(row, rest.cols()) = rest.transpose() * system.own[i].coupling;
    residual.segment(row, rest.cols()) = rest.transpose() * system.own[i].residual;
    row += rest.cols();
  }
  if (shared_.empty()) return;
  if (blocks_.empty()) {
    svd_.emplace(jacobian, threshold);
  } else {
    svd_.emplace(jacobian, inverse_of(squares), threshold);
  }
  inverse_lengths_(shared_) = svd_->inverse_lengths();
  explained_ = svd_->explained(residual);
}

Index ArrowSvd::rank() const {
  Index sum = svd_ ? svd_->rank() : 0;
  for (const Block& block : blocks_) sum += block.explained.size();
  return sum;
}

VectorXd ArrowSvd::singular_values() const {
  std::vector<double> all;
  const auto add = [&](const std::optional<ScaledSvd>& svd) {
    if (svd) all.insert(all.end(), svd->singular_values().begin(), svd->singular_values().end());
  };
  add(svd_);
  for (const Block& block : blocks_) add(block.svd);
  std::sort(all.begin(), all.end(), std::greater<>());
  return Eigen::Map<const VectorXd>(all.data(), static_cast<Index>(all.size()));
}

double ArrowSvd::explained() const {
  double sum = explained_.squaredNorm();
  for (const Block& block : blocks_) sum += block.explained.squaredNorm();
  return sum;
}

MatrixXd ArrowSvd::follow(const Block& block) const {
  return -(block.svd->root() * block.coupling);
}

VectorXd ArrowSvd::step() const {
  VectorXd result(inverse_lengths_.size());
  VectorXd of_shared(static_cast<Index>(shared_.size()));
  if (svd_) of_shared = -(svd_->root() * explained_);
  result(shared_) = of_shared;
  for (const Block& block : blocks_) {
    if (!block.svd) continue;
    result(block.unknowns) = -(block.svd->root() * (block.explained + block.coupling * of_shared));
  }
  return result;
}

ArrowLayout ArrowSvd::layout() const {
  ArrowLayout result{shared_, {}};
  for (const Block& block : blocks_) result.own.push_back(block.unknowns);
  return result;
}

ArrowRoot ArrowSvd::root_with(const std::optional<double>& floor, double factor) const {
  MatrixXd shared(0, 0);
  if (svd_) shared = over_singular_values(*svd_, floor, factor);
  if (blocks_.empty()) return shared;
  std::vector<MatrixXd> own;
  for (const Block& block : blocks_) {
    if (!block.svd) {
      own.emplace_back(MatrixXd(0, shared.cols()));
      continue;
    }
    const MatrixXd directions = over_singular_values(*block.svd, floor, factor);
    MatrixXd& rows = own.emplace_back(directions.rows(), directions.cols() + shared.cols());
    rows.leftCols(directions.cols()) = directions;
    rows.rightCols(shared.cols()) = follow(block) * shared;
  }
  return {layout(), std::move(shared), std::move(own)};
}

ArrowRoot ArrowSvd::root() const { return root_with(std::nullopt, 1.0); }

ArrowRoot ArrowSvd::covariance_root(double factor, double least) const {
  return root_with(least, factor);
}

ArrowSvd::Direction ArrowSvd::shared_direction(Index k) const {
  Direction result;
  result.unknowns.resize(static_cast<std::size_t>(inverse_lengths_.size()));
  std::iota(result.unknowns.begin(), result.unknowns.end(), 0);
  result.singular_value = svd_->singular_values()(k);
  result.parts = VectorXd::Zero(inverse_lengths_.size());
  result.parts(shared_) = svd_->V().col(k);
  if (blocks_.empty()) return result;
  const VectorXd moved = svd_->inverse_lengths().cwiseProduct(svd_->V().col(k));
  for (const Block& block : blocks_) {
    if (!block.svd) continue;
    const VectorXd followed = follow(block) * moved;
    for (std::size_t j = 0; j < block.unknowns.size(); ++j) {
      const double inverse = inverse_lengths_(block.unknowns[j]);
      if (inverse > 0.0)
        result.parts(block.unknowns[j]) = followed(static_cast<Index>(j)) / inverse;
    }
  }
  result.parts.normalize();
  return result;
}

std::vector<ArrowSvd::Direction> ArrowSvd::undetermined() const {
  std::vector<Direction> result;
  for (const Block& block : blocks_) {
    for (Index k = block.explained.size(); k < static_cast<Index>(block.unknowns.size()); ++k) {
      result.push_back({block.unknowns, block.svd->V().col(k), block.svd->singular_values()(k)});
    }
  }
  for (Index k = svd_ ? svd_->rank() : 0; k < static_cast<Index>(shared_.size()); ++k)
    result.push_back(shared_direction(k));
  return result;
}

std::optional<ArrowSvd::Direction> ArrowSvd::longest_way() const {
  double longest = -1.0;
  std::optional<Direction> result;
  const auto longer = [&](const ScaledSvd& svd, const VectorXd& explained, Index k) {
    const double way = std::abs(explained(k)) / svd.singular_values()(k);
    if (way <= longest) return false;
    longest = way;
    return true;
  };
  for (Index k = 0; k < explained_.size(); ++k) {
    if (longer(*svd_, explained_, k)) result = shared_direction(k);
  }
  for (const Block& block : blocks_) {
    if (!block.svd) continue;
    const VectorXd explained =
        block.explained +
        block.coupling * (svd_ ? VectorXd(-(svd_->root() * explained_)) : VectorXd());
    for (Index k = 0; k < explained.size(); ++k) {
      if (longer(*block.svd, explained, k)) {
        result = Direction{block.unknowns, block.svd->V().col(k), block.svd->singular_values()(k)};
      }
    }
  }
  return result;
}

}  // namespace rigcal::calib
