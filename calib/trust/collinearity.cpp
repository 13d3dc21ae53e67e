#include "calib/trust/collinearity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

#include "common/significant.hpp"

namespace rigcal::calib {
namespace {

/// Above this correlation, the best combination of two estimates is known at least ten times as
/// precisely as either of them (its variance is 1 - r).
constexpr double kCombination = 0.99;
/// Above this correlation, the variance of an estimate is more than five times as large as it would
/// be if the other one were known (1 / (1 - r^2)).
constexpr double kMadeUp = 0.9;
constexpr double kInflated = 10.0;

}  // namespace

Eigen::VectorXd variance_inflation(const Eigen::MatrixXd& correlation) {
  constexpr double kSingular = 1e-12;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(correlation);
  const Eigen::VectorXd& values = solved.eigenvalues();
  const Eigen::MatrixXd squares = solved.eigenvectors().cwiseAbs2();
  Eigen::VectorXd result = Eigen::VectorXd::Zero(correlation.rows());
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    for (Eigen::Index j = 0; j < result.size(); ++j) {
      if (values(k) > kSingular) {
        result(j) += squares(j, k) / values(k);
      } else if (squares(j, k) > kSingular) {
        result(j) = std::numeric_limits<double>::infinity();
      }
    }
  }
  return result;
}

std::string collinearity_words(const std::vector<std::string>& names,
                               const Eigen::MatrixXd& correlation) {
  const Eigen::Index n = correlation.rows();
  if (n < 2 || static_cast<Eigen::Index>(names.size()) != n || !correlation.allFinite()) return {};
  Eigen::Index first = 0;
  Eigen::Index second = 1;
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j) {
      if (std::abs(correlation(i, j)) > std::abs(correlation(first, second))) {
        first = j;
        second = i;
      }
    }
  }
  const double strongest = correlation(first, second);
  const auto name = [&](Eigen::Index i) { return names[static_cast<std::size_t>(i)]; };
  std::string text = fmt::format("Strongest correlation: {:.3f} between {} and {}", strongest,
                                 name(first), name(second));
  if (std::abs(strongest) > kCombination) {
    text += ": the records determine a combination of the two far better than either alone";
  } else if (std::abs(strongest) > kMadeUp) {
    text += ": an error of one is mostly compensated by the other";
  }
  const Eigen::VectorXd inflation = variance_inflation(correlation);
  std::vector<std::string> inflated;
  for (Eigen::Index j = 0; j < n; ++j) {
    if (!(inflation(j) > kInflated)) continue;
    inflated.push_back(std::isfinite(inflation(j))
                           ? fmt::format("{} {} times", name(j), significant(inflation(j), 2))
                           : fmt::format("{} without limit", name(j)));
  }
  if (!inflated.empty()) {
    text += fmt::format(
        "; not separable from all others together (variance relative to that with the others "
        "known): {}",
        fmt::join(inflated, ", "));
  } else if (std::abs(strongest) <= kMadeUp) {
    text += "; all can be separated";
  }
  return text + ".";
}

}  // namespace rigcal::calib
