#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace rigcal::calib {

/// Which unknowns belong to a single condition (scope `condition`: its offset, its initial state)
/// and which are shared. No residual depends on the own unknowns of two conditions, so J^T J has
/// the shape of an arrow: one block per condition, and the shared unknowns beside and below them
/// (docs/decisions/0042-own-unknowns.md).
struct ArrowLayout {
  std::vector<int> shared;            ///< indices of the unknowns, ascending
  std::vector<std::vector<int>> own;  ///< per condition; empty: all unknowns are shared
};

/// Symmetric arrow-shaped matrix whose rows and columns are unknowns or directions.
struct ArrowMatrix {
  Eigen::MatrixXd shared;                 ///< shape (shared)^2
  std::vector<Eigen::MatrixXd> own;       ///< shape (own)^2 of each condition; may be empty
  std::vector<Eigen::MatrixXd> coupling;  ///< shape (own, shared)

  ArrowMatrix() = default;
  template <typename Matrix>  // NOLINTNEXTLINE(google-explicit-constructor): an arrow without
                              // blocks
  ArrowMatrix(const Eigen::EigenBase<Matrix>& all) : shared(all.derived()) {}

  /// Submatrix for a condition: its own rows and columns, followed by the shared ones.
  Eigen::MatrixXd of(std::size_t condition) const;
  /// Adds a submatrix to the rows and columns of a condition, in the order used by of().
  void add(std::size_t condition, const Eigen::MatrixXd& part);
};

/// Arrow-shaped matrix whose rows and columns are unknowns, identified by their indices.
struct ArrowSquare {
  ArrowLayout layout;  ///< if `own` is empty, all unknowns are shared, in their order
  ArrowMatrix blocks;

  ArrowSquare() = default;
  template <typename Matrix>  // NOLINTNEXTLINE(google-explicit-constructor): an arrow without
                              // blocks
  ArrowSquare(const Eigen::EigenBase<Matrix>& all) : blocks(all) {
    layout.shared.resize(static_cast<std::size_t>(blocks.shared.rows()));
    std::iota(layout.shared.begin(), layout.shared.end(), 0);
  }
  ArrowSquare(ArrowLayout places, ArrowMatrix matrix)
      : layout(std::move(places)), blocks(std::move(matrix)) {}

  Eigen::Index size() const;
  Eigen::VectorXd diagonal() const;
  Eigen::VectorXd operator*(const Eigen::VectorXd& x) const;
  /// Returns (A + B) / 2 for two matrices with the same layout.
  ArrowSquare mean(const ArrowSquare& other) const;
  /// Returns S A S, where A is restricted to the rows and columns of some unknowns.
  ///
  /// @param kept   indices of these unknowns, ascending
  /// @param scale  diagonal of S, shape (kept)
  ArrowSquare part(const std::vector<Eigen::Index>& kept, const Eigen::VectorXd& scale) const;
};

/// Least-squares system |J x + r|^2 for all conditions and priors at one point, stored as R
/// factors. The cost is half the squared norm of the residuals.
struct Linearisation {
  /// Rows that depend on the own unknowns of one condition and on the shared unknowns.
  struct Own {
    std::vector<int> unknowns;  ///< indices among all unknowns
    Eigen::MatrixXd jacobian;   ///< shape (own)^2, unit-box coordinates
    Eigen::MatrixXd coupling;   ///< shape (own, shared)
    Eigen::VectorXd residual;   ///< shape (own)
  };

  /// Shape (any, shared): the remaining rows, which depend only on shared unknowns.
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;  ///< shape (any)
  /// Unknowns of the columns of `jacobian`; ignored if `own` is empty.
  std::vector<int> shared = {};
  std::vector<Own> own = {};  ///< per condition; empty: all unknowns are shared, in their order

  Eigen::Index unknowns() const;
  double square() const;             ///< sum over all residuals
  Eigen::VectorXd gradient() const;  ///< J^T r
  ArrowSquare normal() const;        ///< J^T J
  /// Treats the marked unknowns as known.
  void hold(const std::vector<bool>& held);
  int shared_unknown(Eigen::Index column) const {
    return own.empty() ? static_cast<int>(column) : shared[static_cast<std::size_t>(column)];
  }
};

/// A matrix R with one row per unknown and one column per direction. Some directions belong to a
/// single condition, the others are shared. The row of an own unknown has components in the
/// directions of its condition and in the shared ones; the row of a shared unknown has components
/// only in the shared ones. If R R^T = (J^T J)^-1, the rows of R give the standard errors.
class ArrowRoot {
 public:
  ArrowRoot() = default;
  template <typename Matrix>
  // NOLINTNEXTLINE(google-explicit-constructor): a matrix has no own directions
  ArrowRoot(const Eigen::EigenBase<Matrix>& all) : shared_(all.derived()) {
    for (Eigen::Index j = 0; j < shared_.rows(); ++j) places_.push_back({-1, j});
  }
  /// @param own  shape (own unknowns, own directions + shared directions) of each condition
  ArrowRoot(const ArrowLayout& layout, Eigen::MatrixXd shared, std::vector<Eigen::MatrixXd> own);

  Eigen::Index unknowns() const { return static_cast<Eigen::Index>(places_.size()); }
  /// Shape (shared unknowns, shared directions).
  const Eigen::MatrixXd& shared() const { return shared_; }
  Eigen::Index own_unknowns(std::size_t condition) const;
  Eigen::Index own_directions(std::size_t condition) const;
  /// Condition to which the unknown belongs; negative if it is shared.
  int condition_of(Eigen::Index unknown) const { return place(unknown).condition; }
  /// Row of the unknown among those of its condition, or among the shared ones.
  Eigen::Index row_of(Eigen::Index unknown) const { return place(unknown).row; }

  /// Components of an unknown's row in the own and shared directions of a condition.
  Eigen::VectorXd row(Eigen::Index unknown, std::size_t condition) const;
  /// Components of the rows of several unknowns. The overload without a list of unknowns returns
  /// the condition's own unknowns, followed by the shared ones.
  Eigen::MatrixXd rows(const std::vector<int>& unknowns, std::size_t condition) const;
  Eigen::MatrixXd rows(std::size_t condition) const;
  /// Total number of directions. The directions of each condition come first, in turn, and the
  /// shared ones last.
  Eigen::Index directions() const;
  /// Indices of a condition's own directions, followed by those of the shared ones.
  std::vector<Eigen::Index> directions(std::size_t condition) const;
  /// Product of an unknown's row and x. Shape of x: (all directions, any); shape of the result:
  /// (any).
  Eigen::VectorXd times(Eigen::Index unknown, const Eigen::MatrixXd& x) const;
  /// |a R_i + b R_k|^2 for two rows.
  double square(Eigen::Index i, double a, Eigen::Index k, double b) const;
  /// Entry (i, k) of R R^T.
  double product(Eigen::Index i, Eigen::Index k) const;
  /// c^T M c for a row c.
  double quadratic(Eigen::Index unknown, const ArrowMatrix& matrix) const;
  /// A zero matrix whose rows and columns are the directions.
  ArrowMatrix zero() const;

 private:
  struct Place {
    int condition = -1;
    Eigen::Index row = 0;
  };

  const Place& place(Eigen::Index unknown) const {
    return places_[static_cast<std::size_t>(unknown)];
  }
  Eigen::VectorXd own_part(const Place& at) const;
  Eigen::VectorXd shared_part(const Place& at) const;

  Eigen::MatrixXd shared_;
  std::vector<Eigen::MatrixXd> own_;
  std::vector<Place> places_;
};

}  // namespace rigcal::calib
