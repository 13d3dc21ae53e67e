#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace rigcal::calib {

/// Which unknowns a condition has for itself (scope `condition`: its offset, its initial state) and
/// which are shared. No residual depends on the own unknowns of two conditions, so that J^T J has
/// the shape of an arrow: a block for each condition, the shared unknowns beside and below them
/// (docs/decisions/0042-own-unknowns.md).
struct ArrowLayout {
  std::vector<int> shared;            ///< positions among the unknowns, ascending
  std::vector<std::vector<int>> own;  ///< per condition; empty: all unknowns are shared
};

/// Symmetric matrix in the shape of an arrow: of unknowns, or of directions.
struct ArrowMatrix {
  Eigen::MatrixXd shared;                 ///< shape (shared)^2
  std::vector<Eigen::MatrixXd> own;       ///< shape (own)^2 of each condition; may be empty
  std::vector<Eigen::MatrixXd> coupling;  ///< shape (own, shared)

  ArrowMatrix() = default;
  template <typename Matrix>  // NOLINTNEXTLINE(google-explicit-constructor): an arrow without
                              // blocks
  ArrowMatrix(const Eigen::EigenBase<Matrix>& all) : shared(all.derived()) {}

  /// What a condition sees of it: its own rows and columns, then the shared ones.
  Eigen::MatrixXd of(std::size_t condition) const;
  /// Adds such a part.
  void add(std::size_t condition, const Eigen::MatrixXd& part);
};

/// That of unknowns, which it knows by their positions.
struct ArrowSquare {
  ArrowLayout layout;  ///< without `own` all unknowns are shared, in their order
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
  /// (A + B) / 2 of two with one layout.
  ArrowSquare mean(const ArrowSquare& other) const;
  /// S (rows and columns of some unknowns) S.
  ///
  /// @param kept   ascending
  /// @param scale  diagonal of S, shape (kept)
  ArrowSquare part(const std::vector<Eigen::Index>& kept, const Eigen::VectorXd& scale) const;
};

/// Least-squares system |J x + r|^2 of all conditions and priors at one point, as R factors. Half
/// the squared norm of its residuals is the cost.
struct Linearisation {
  /// Rows that depend on the unknowns of one condition and on shared ones.
  struct Own {
    std::vector<int> unknowns;  ///< positions among all
    Eigen::MatrixXd jacobian;   ///< shape (own)^2, unit-box coordinates
    Eigen::MatrixXd coupling;   ///< shape (own, shared)
    Eigen::VectorXd residual;   ///< shape (own)
  };

  Eigen::MatrixXd jacobian;      ///< shape (any, shared): what is left once the others are out
  Eigen::VectorXd residual;      ///< shape (any)
  std::vector<int> shared = {};  ///< unknowns of its columns; not looked at where `own` is empty
  std::vector<Own> own = {};     ///< per condition; empty: all unknowns are shared, in their order

  Eigen::Index unknowns() const;
  double square() const;             ///< sum over all residuals
  Eigen::VectorXd gradient() const;  ///< J^T r
  ArrowSquare normal() const;        ///< J^T J
  /// Takes the unknowns that are marked for known.
  void hold(const std::vector<bool>& held);
  int shared_unknown(Eigen::Index column) const {
    return own.empty() ? static_cast<int>(column) : shared[static_cast<std::size_t>(column)];
  }
};

/// A row for each unknown over directions, of which some belong to one condition. The row of an own
/// unknown is over the directions of its condition, then the shared ones; that of a shared unknown
/// over these alone. With R R^T = (J^T J)^-1 it is what standard errors are made of.
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
  /// Condition that has the unknown for itself; negative for a shared one.
  int condition_of(Eigen::Index unknown) const { return place(unknown).condition; }
  /// Among the unknowns of its condition, or among the shared ones.
  Eigen::Index row_of(Eigen::Index unknown) const { return place(unknown).row; }

  /// Part of a row in the directions of a condition, own and shared.
  Eigen::VectorXd row(Eigen::Index unknown, std::size_t condition) const;
  /// That of some unknowns, and that of all which are its own or shared, in this order.
  Eigen::MatrixXd rows(const std::vector<int>& unknowns, std::size_t condition) const;
  Eigen::MatrixXd rows(std::size_t condition) const;
  /// Count of all directions: those of each condition, one after the other, then the shared ones.
  Eigen::Index directions() const;
  /// Positions in that order of the directions of a condition, own and shared.
  std::vector<Eigen::Index> directions(std::size_t condition) const;
  /// A row times x, shape (all directions, any): shape (any).
  Eigen::VectorXd times(Eigen::Index unknown, const Eigen::MatrixXd& x) const;
  /// |a R_i + b R_k|^2 of two rows.
  double square(Eigen::Index i, double a, Eigen::Index k, double b) const;
  /// Entry (i, k) of R R^T.
  double product(Eigen::Index i, Eigen::Index k) const;
  /// c^T M c of a row.
  double quadratic(Eigen::Index unknown, const ArrowMatrix& matrix) const;
  /// A matrix of its directions, of zeros.
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
