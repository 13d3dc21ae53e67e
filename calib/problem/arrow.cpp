#include "calib/problem/arrow.hpp"

#include <algorithm>

namespace rigcal::calib {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

Index ArrowSquare::size() const {
  Index count = blocks.shared.rows();
  for (const auto& each : blocks.own) count += each.rows();
  return count;
}

VectorXd ArrowSquare::diagonal() const {
  VectorXd result(size());
  result(layout.shared) = blocks.shared.diagonal();
  for (std::size_t i = 0; i < layout.own.size(); ++i)
    result(layout.own[i]) = blocks.own[i].diagonal();
  return result;
}

VectorXd ArrowSquare::operator*(const VectorXd& x) const {
  if (layout.own.empty()) return blocks.shared * x;
  VectorXd result(x.size());
  const VectorXd of_shared = x(layout.shared);
  VectorXd sum = blocks.shared * of_shared;
  for (std::size_t i = 0; i < layout.own.size(); ++i) {
    const VectorXd own = x(layout.own[i]);
    sum += blocks.coupling[i].transpose() * own;
    result(layout.own[i]) = blocks.own[i] * own + blocks.coupling[i] * of_shared;
  }
  result(layout.shared) = sum;
  return result;
}

ArrowSquare ArrowSquare::mean(const ArrowSquare& other) const {
  ArrowSquare result(layout, 0.5 * (blocks.shared + other.blocks.shared));
  for (std::size_t i = 0; i < blocks.own.size(); ++i) {
    result.blocks.own.emplace_back(0.5 * (blocks.own[i] + other.blocks.own[i]));
    result.blocks.coupling.emplace_back(0.5 * (blocks.coupling[i] + other.blocks.coupling[i]));
  }
  return result;
}

ArrowSquare ArrowSquare::part(const std::vector<Index>& kept, const VectorXd& scale) const {
  if (layout.own.empty()) {
    return MatrixXd(scale.asDiagonal() * blocks.shared(kept, kept) * scale.asDiagonal());
  }
  std::vector<int> place(static_cast<std::size_t>(size()), -1);
  for (std::size_t k = 0; k < kept.size(); ++k)
    place[static_cast<std::size_t>(kept[k])] = static_cast<int>(k);
  const auto choose = [&](const std::vector<int>& from, std::vector<int>& to) {
    std::vector<Index> rows;
    for (std::size_t j = 0; j < from.size(); ++j) {
      const int at = place[static_cast<std::size_t>(from[j])];
      if (at < 0) continue;
      rows.push_back(static_cast<Index>(j));
      to.push_back(at);
    }
    return rows;
  };
  ArrowSquare result;
  const std::vector<Index> shared = choose(layout.shared, result.layout.shared);
  const VectorXd by_shared = scale(result.layout.shared);
  result.blocks.shared =
      by_shared.asDiagonal() * blocks.shared(shared, shared) * by_shared.asDiagonal();
  for (std::size_t i = 0; i < layout.own.size(); ++i) {
    const std::vector<Index> own = choose(layout.own[i], result.layout.own.emplace_back());
    const VectorXd by_own = scale(result.layout.own.back());
    result.blocks.own.emplace_back(by_own.asDiagonal() * blocks.own[i](own, own) *
                                   by_own.asDiagonal());
    result.blocks.coupling.emplace_back(by_own.asDiagonal() * blocks.coupling[i](own, shared) *
                                        by_shared.asDiagonal());
  }
  return result;
}

Index Linearisation::unknowns() const {
  Index count = jacobian.cols();
  for (const Own& each : own) count += static_cast<Index>(each.unknowns.size());
  return count;
}

double Linearisation::square() const {
  double sum = residual.squaredNorm();
  for (const Own& each : own) sum += each.residual.squaredNorm();
  return sum;
}

VectorXd Linearisation::gradient() const {
  VectorXd of_shared = jacobian.transpose() * residual;
  if (own.empty()) return of_shared;
  VectorXd result(unknowns());
  for (const Own& each : own) {
    of_shared += each.coupling.transpose() * each.residual;
    result(each.unknowns) = each.jacobian.transpose() * each.residual;
  }
  result(shared) = of_shared;
  return result;
}

ArrowSquare Linearisation::normal() const {
  MatrixXd of_shared = jacobian.transpose() * jacobian;
  if (own.empty()) return of_shared;
  ArrowSquare result({shared, {}}, {});
  for (const Own& each : own) {
    of_shared += each.coupling.transpose() * each.coupling;
    result.layout.own.push_back(each.unknowns);
    result.blocks.own.emplace_back(each.jacobian.transpose() * each.jacobian);
    result.blocks.coupling.emplace_back(each.jacobian.transpose() * each.coupling);
  }
  result.blocks.shared = std::move(of_shared);
  return result;
}

void Linearisation::hold(const std::vector<bool>& held) {
  for (Index j = 0; j < jacobian.cols(); ++j) {
    if (!held[static_cast<std::size_t>(shared_unknown(j))]) continue;
    jacobian.col(j).setZero();
    for (Own& each : own) each.coupling.col(j).setZero();
  }
  for (Own& each : own) {
    for (std::size_t j = 0; j < each.unknowns.size(); ++j) {
      if (held[static_cast<std::size_t>(each.unknowns[j])])
        each.jacobian.col(static_cast<Index>(j)).setZero();
    }
  }
}

MatrixXd ArrowMatrix::of(std::size_t condition) const {
  if (condition >= own.size() || own[condition].size() == 0) return shared;
  const Index n = own[condition].rows();
  MatrixXd result(n + shared.rows(), n + shared.rows());
  result << own[condition], coupling[condition], coupling[condition].transpose(), shared;
  return result;
}

void ArrowMatrix::add(std::size_t condition, const MatrixXd& part) {
  const Index n = part.rows() - shared.rows();
  if (n == 0) {
    shared += part;
    return;
  }
  own[condition] += part.topLeftCorner(n, n);
  coupling[condition] += part.topRightCorner(n, shared.cols());
  shared += part.bottomRightCorner(shared.rows(), shared.cols());
}

ArrowRoot::ArrowRoot(const ArrowLayout& layout, MatrixXd shared, std::vector<MatrixXd> own)
    : shared_(std::move(shared)), own_(std::move(own)) {
  std::size_t count = layout.shared.size();
  for (const auto& each : layout.own) count += each.size();
  places_.resize(count);
  const auto put = [&](const std::vector<int>& unknowns, int condition) {
    for (std::size_t row = 0; row < unknowns.size(); ++row)
      places_[static_cast<std::size_t>(unknowns[row])] = {condition, static_cast<Index>(row)};
  };
  put(layout.shared, -1);
  for (std::size_t i = 0; i < layout.own.size(); ++i) put(layout.own[i], static_cast<int>(i));
}

Index ArrowRoot::own_unknowns(std::size_t condition) const {
  return condition < own_.size() ? own_[condition].rows() : 0;
}

Index ArrowRoot::own_directions(std::size_t condition) const {
  return condition < own_.size() ? own_[condition].cols() - shared_.cols() : 0;
}

VectorXd ArrowRoot::own_part(const Place& at) const {
  if (at.condition < 0) return {};
  const auto i = static_cast<std::size_t>(at.condition);
  return own_[i].row(at.row).head(own_directions(i)).transpose();
}

VectorXd ArrowRoot::shared_part(const Place& at) const {
  if (at.condition < 0) return shared_.row(at.row).transpose();
  return own_[static_cast<std::size_t>(at.condition)].row(at.row).tail(shared_.cols()).transpose();
}

VectorXd ArrowRoot::row(Index unknown, std::size_t condition) const {
  const Place& at = place(unknown);
  if (at.condition == static_cast<int>(condition)) return own_[condition].row(at.row).transpose();
  VectorXd result = VectorXd::Zero(own_directions(condition) + shared_.cols());
  result.tail(shared_.cols()) = shared_part(at);
  return result;
}

MatrixXd ArrowRoot::rows(const std::vector<int>& unknowns, std::size_t condition) const {
  MatrixXd result(static_cast<Index>(unknowns.size()), own_directions(condition) + shared_.cols());
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    result.row(static_cast<Index>(j)) = row(unknowns[j], condition).transpose();
  return result;
}

MatrixXd ArrowRoot::rows(std::size_t condition) const {
  const Index own = own_unknowns(condition);
  MatrixXd result =
      MatrixXd::Zero(own + shared_.rows(), own_directions(condition) + shared_.cols());
  if (own > 0) result.topRows(own) = own_[condition];
  result.bottomRightCorner(shared_.rows(), shared_.cols()) = shared_;
  return result;
}

Index ArrowRoot::directions() const {
  Index count = shared_.cols();
  for (std::size_t i = 0; i < own_.size(); ++i) count += own_directions(i);
  return count;
}

std::vector<Index> ArrowRoot::directions(std::size_t condition) const {
  Index first = 0;
  for (std::size_t i = 0; i < std::min(condition, own_.size()); ++i) first += own_directions(i);
  std::vector<Index> result;
  for (Index k = 0; k < own_directions(condition); ++k) result.push_back(first + k);
  for (Index k = directions() - shared_.cols(); k < directions(); ++k) result.push_back(k);
  return result;
}

VectorXd ArrowRoot::times(Index unknown, const MatrixXd& x) const {
  const Place& at = place(unknown);
  VectorXd result = x.bottomRows(shared_.cols()).transpose() * shared_part(at);
  if (at.condition < 0) return result;
  const auto i = static_cast<std::size_t>(at.condition);
  const Index own = own_directions(i);
  if (own > 0) result += x.middleRows(directions(i).front(), own).transpose() * own_part(at);
  return result;
}

double ArrowRoot::square(Index i, double a, Index k, double b) const {
  const Place& first = place(i);
  const Place& second = place(k);
  const double in_shared = (a * shared_part(first) + b * shared_part(second)).squaredNorm();
  if (first.condition >= 0 && first.condition == second.condition)
    return in_shared + (a * own_part(first) + b * own_part(second)).squaredNorm();
  return in_shared + a * a * own_part(first).squaredNorm() + b * b * own_part(second).squaredNorm();
}

double ArrowRoot::product(Index i, Index k) const {
  const Place& first = place(i);
  const Place& second = place(k);
  const double in_shared = shared_part(first).dot(shared_part(second));
  if (first.condition < 0 || first.condition != second.condition) return in_shared;
  return in_shared + own_part(first).dot(own_part(second));
}

double ArrowRoot::quadratic(Index unknown, const ArrowMatrix& matrix) const {
  const Place& at = place(unknown);
  if (at.condition < 0) {
    const VectorXd c = shared_part(at);
    return c.dot(matrix.shared * c);
  }
  const auto i = static_cast<std::size_t>(at.condition);
  const VectorXd c = row(unknown, i);
  return c.dot(matrix.of(i) * c);
}

ArrowMatrix ArrowRoot::zero() const {
  ArrowMatrix result(MatrixXd::Zero(shared_.cols(), shared_.cols()));
  for (std::size_t i = 0; i < own_.size(); ++i) {
    const Index n = own_directions(i);
    result.own.emplace_back(MatrixXd::Zero(n, n));
    result.coupling.emplace_back(MatrixXd::Zero(n, shared_.cols()));
  }
  return result;
}

}  // namespace rigcal::calib
