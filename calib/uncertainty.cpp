#include "calib/uncertainty.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/SVD>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "calib/optimum.hpp"
#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

/// Share of a null direction above which a parameter counts as part of it: in what the outputs feel
/// of it, or in how far it moves in the box against the one that moves most.
constexpr double kFelt = 0.1;
constexpr double kMoves = 0.05;
constexpr Eigen::Index kBlocksPerCondition = 20;

/// J^T r of each block of one condition, shape (blocks, unknowns).
Eigen::MatrixXd block_gradients(const Problem& problem, std::size_t condition,
                                std::span<const double> z) {
  ConditionRows rows;
  if (!evaluate_condition(problem, condition, z, nullptr, &rows).ok()) return {};
  const auto samples = static_cast<Eigen::Index>(problem.conditions[condition].rows.size());
  const auto channels = static_cast<Eigen::Index>(problem.conditions[condition].channels.size());
  const Eigen::Index blocks = std::min(kBlocksPerCondition, samples);
  const std::vector<int>& acting = problem.map.acting(condition);
  Eigen::MatrixXd gradients =
      Eigen::MatrixXd::Zero(blocks, static_cast<Eigen::Index>(problem.map.unknowns().size()));
  for (Eigen::Index b = 0; b < blocks; ++b) {
    const Eigen::Index first = b * samples / blocks;
    const Eigen::Index count = (b + 1) * samples / blocks - first;
    for (Eigen::Index k = 0; k < channels; ++k) {
      const Eigen::VectorXd g = rows.jacobian.middleRows(k * samples + first, count).transpose() *
                                rows.residual.segment(k * samples + first, count);
      for (std::size_t j = 0; j < acting.size(); ++j)
        gradients(b, acting[j]) += g(static_cast<Eigen::Index>(j));
    }
  }
  return gradients;
}

/// Sum over blocks of g g^T with the small-sample factor; empty where there are too few blocks.
Eigen::MatrixXd meat(const Problem& problem, std::span<const double> z, int threads) {
  std::vector<Eigen::MatrixXd> gradients(problem.conditions.size());
  parallel_for(gradients.size(), threads,
               [&](std::size_t i) { gradients[i] = block_gradients(problem, i, z); });
  const auto unknowns = static_cast<Eigen::Index>(z.size());
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(unknowns, unknowns);
  Eigen::Index blocks = 0;
  for (const Eigen::MatrixXd& each : gradients) {
    if (each.size() == 0) return {};
    sum += each.transpose() * each;
    blocks += each.rows();
  }
  if (blocks <= unknowns) return {};
  return sum * (static_cast<double>(blocks) / static_cast<double>(blocks - unknowns));
}

std::string null_reason(const Problem& problem, const std::vector<std::size_t>& members,
                        std::size_t unknown) {
  std::vector<std::string> partners;
  for (const std::size_t member : members) {
    if (member != unknown) partners.push_back(problem.name(member));
  }
  if (partners.empty())
    return fmt::format("no output of these conditions responds to {}", problem.name(unknown));
  return fmt::format("these conditions determine {} only in a combination with {}, not by itself",
                     problem.name(unknown), fmt::join(partners, ", "));
}

}  // namespace

Uncertainty uncertainty(const Problem& problem, const Evaluation& optimum, int threads) {
  const Linearisation system = linearise(problem, optimum);
  const auto n = static_cast<Eigen::Index>(optimum.z.size());
  const Eigen::VectorXd norms = system.jacobian.colwise().norm();
  Eigen::VectorXd inverse_norms(n);
  for (Eigen::Index j = 0; j < n; ++j) inverse_norms(j) = norms(j) > 0.0 ? 1.0 / norms(j) : 0.0;
  const Eigen::MatrixXd scaled = system.jacobian * inverse_norms.asDiagonal();
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinU | Eigen::ComputeFullV);
  svd.setThreshold(rank_threshold(problem.tolerance));
  const Eigen::Index rank = svd.rank();
  const Eigen::VectorXd s = svd.singularValues();
  const Eigen::MatrixXd& V = svd.matrixV();

  Uncertainty result;
  result.rank = static_cast<int>(rank);
  result.singular_values.assign(s.data(), s.data() + s.size());
  const double freedom = static_cast<double>(problem.residual_count() - rank);
  result.reduced_chi_square = freedom > 0.0 ? 2.0 * optimum.cost / freedom : 0.0;
  result.student_t = boost::math::quantile(boost::math::students_t(std::max(freedom, 1.0)), 0.975);

  // (J^T J)^-1 in the unit box, on the directions that the data determine.
  const Eigen::MatrixXd root =
      inverse_norms.asDiagonal() * V.leftCols(rank) * s.head(rank).cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse = root * root.transpose();
  const double sigma = std::sqrt(std::max(1.0, result.reduced_chi_square));
  const Eigen::MatrixXd scatter = meat(problem, optimum.z, threads);
  Eigen::MatrixXd sandwich;
  if (scatter.size() > 0) sandwich = inverse * scatter * inverse;

  // A parameter is named with those that share a null direction with it.
  std::vector<std::vector<std::size_t>> directions;
  for (Eigen::Index k = rank; k < n; ++k) {
    std::vector<std::size_t>& members = directions.emplace_back();
    const Eigen::VectorXd moves = (inverse_norms.array() * V.col(k).array()).abs();
    for (Eigen::Index j = 0; j < n; ++j) {
      if (std::abs(V(j, k)) > kFelt || moves(j) > kMoves * moves.maxCoeff())
        members.push_back(static_cast<std::size_t>(j));
    }
  }
  result.standard_error.resize(optimum.z.size());
  result.robust_standard_error.resize(optimum.z.size());
  result.reason.resize(optimum.z.size());
  result.correlation = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto u = static_cast<std::size_t>(j);
    if (norms(j) == 0.0) {
      result.reason[u] = null_reason(problem, {}, u);
      continue;
    }
    const auto direction =
        std::find_if(directions.begin(), directions.end(), [u](const auto& members) {
          return std::find(members.begin(), members.end(), u) != members.end();
        });
    if (direction != directions.end()) {
      result.reason[u] = null_reason(problem, *direction, u);
      continue;
    }
    const double slope = problem.map.slope(static_cast<int>(j), optimum.z[u]);
    result.standard_error[u] = sigma * slope * std::sqrt(inverse(j, j));
    if (sandwich.size() > 0)
      result.robust_standard_error[u] = slope * std::sqrt(std::max(0.0, sandwich(j, j)));
    for (Eigen::Index k = 0; k < n; ++k) {
      const double scale = std::sqrt(inverse(j, j) * inverse(k, k));
      if (k != j && scale > 0.0)
        result.correlation(j, k) = std::clamp(inverse(j, k) / scale, -1.0, 1.0);
    }
  }
  return result;
}

}  // namespace rigcal::calib
