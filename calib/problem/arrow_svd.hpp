#pragma once

#include <optional>
#include <vector>

#include "calib/problem/arrow.hpp"
#include "calib/problem/scaled_svd.hpp"

namespace rigcal::calib {

/// ScaledSvd of a system whose own unknowns are eliminated condition by condition: their rows by
/// one decomposition each, then what is left of the shared unknowns (the Schur complement, as an R
/// factor). Columns are scaled by their whole length. Without own unknowns it is ScaledSvd.
class ArrowSvd {
 public:
  /// @param threshold  as ScaledSvd's; relative to 1 where all singular values are less
  ArrowSvd(const Linearisation& system, double threshold);

  Eigen::Index rank() const;
  /// Singular values of all blocks, descending.
  Eigen::VectorXd singular_values() const;
  /// Square of what a step can take away of the residual.
  double explained() const;
  /// x that makes |J x + residual| least, and has no part in undetermined directions.
  Eigen::VectorXd step() const;
  /// R with R R^T the inverse of J^T J on the determined directions.
  ArrowRoot root() const;
  /// Covariance S S^T = factor^2 (J^T J)^-1 over all directions, those that are not determined with
  /// this for their singular value. They come last among the own directions and the shared ones.
  ArrowRoot spread(double factor, double least) const;
  /// 1 / length of the column of each unknown; 0 of a column of zeros.
  const Eigen::VectorXd& inverse_lengths() const { return inverse_lengths_; }

  /// A direction of unit length in scaled coordinates.
  struct Direction {
    std::vector<int> unknowns;
    Eigen::VectorXd parts;  ///< one per unknown
    double singular_value = 0.0;
  };
  /// Those that the system does not determine.
  std::vector<Direction> undetermined() const;
  /// The determined one along which a full step is the longest, in scaled coordinates; empty where
  /// there is none.
  std::optional<Direction> longest_way() const;

 private:
  struct Block {
    std::vector<int> unknowns;
    std::optional<ScaledSvd> svd;  ///< empty without unknowns
    Eigen::MatrixXd coupling;      ///< U^T of that of the system, shape (rank, shared)
    Eigen::VectorXd explained;     ///< U^T of its residual, shape (rank)
  };

  /// How the own unknowns of a block follow shared ones, shape (own, shared).
  Eigen::MatrixXd follow(const Block& block) const;
  Direction shared_direction(Eigen::Index k) const;
  ArrowRoot root_with(const std::optional<double>& floor, double factor) const;
  ArrowLayout layout() const;

  std::vector<Block> blocks_;
  std::vector<int> shared_;  ///< unknowns
  std::optional<ScaledSvd> svd_;
  Eigen::VectorXd explained_;  ///< part of the shared residual, shape (rank)
  Eigen::VectorXd inverse_lengths_;
};

}  // namespace rigcal::calib
