#pragma once

#include <optional>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "calib/problem/scaled_svd.hpp"

namespace rigcal::calib {

/// ScaledSvd of a system whose own unknowns are eliminated condition by condition. The rows of each
/// condition are decomposed separately, and so is the remaining system for the shared unknowns (the
/// Schur complement, as an R factor). Columns are scaled by their length over all rows. Without own
/// unknowns the result is that of ScaledSvd.
class ArrowSvd {
 public:
  /// @param threshold  as for ScaledSvd; relative to 1 if all singular values are smaller
  ArrowSvd(const Linearisation& system, double threshold);

  Eigen::Index rank() const;
  /// Singular values of all blocks, descending.
  Eigen::VectorXd singular_values() const;
  /// Squared norm of the component of the residual that a step can remove.
  double explained() const;
  /// x that minimises |J x + residual| and has no component in undetermined directions.
  Eigen::VectorXd step() const;
  /// R such that R R^T is the inverse of J^T J on the determined directions.
  ArrowRoot root() const;
  /// S such that S S^T = factor^2 (J^T J)^-1 in all directions. Singular values below `least` are
  /// raised to `least`. Undetermined directions come last among the own and among the shared ones.
  ArrowRoot covariance_root(double factor, double least) const;
  /// 1 / length of the column of each unknown, or 0 for a column of zeros.
  const Eigen::VectorXd& inverse_lengths() const { return inverse_lengths_; }

  /// A direction of unit length in scaled coordinates.
  struct Direction {
    std::vector<int> unknowns;
    Eigen::VectorXd parts;  ///< one component per unknown
    double singular_value = 0.0;
  };
  /// Directions that the system does not determine.
  std::vector<Direction> undetermined() const;
  /// Returns the determined direction along which the full step is longest, in scaled coordinates.
  /// Returns std::nullopt if there is none.
  std::optional<Direction> longest_way() const;

 private:
  struct Block {
    std::vector<int> unknowns;
    std::optional<ScaledSvd> svd;  ///< absent if there are no unknowns
    Eigen::MatrixXd coupling;      ///< U^T times the system's coupling, shape (rank, shared)
    Eigen::VectorXd explained;     ///< U^T times the system's residual, shape (rank)
  };

  /// How the own unknowns of a block respond to the shared ones, shape (own, shared).
  Eigen::MatrixXd follow(const Block& block) const;
  Direction shared_direction(Eigen::Index k) const;
  ArrowRoot root_with(const std::optional<double>& floor, double factor) const;
  ArrowLayout layout() const;

  std::vector<Block> blocks_;
  std::vector<int> shared_;  ///< indices of the shared unknowns
  std::optional<ScaledSvd> svd_;
  Eigen::VectorXd explained_;  ///< U^T times the shared residual, shape (rank)
  Eigen::VectorXd inverse_lengths_;
};

}  // namespace rigcal::calib
