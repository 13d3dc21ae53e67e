#pragma once

#include <Eigen/Core>

namespace rigcal::diagnosis {

/// What healthy records of one signal differ by: noise of their own, and causes that change a whole
/// record, such as a supply that differs from run to run.
struct CommonCauses {
  /// Change of a record per standard deviation of each cause, shape (samples, causes); no columns:
  /// the records differ by noise alone.
  Eigen::MatrixXd patterns;
  /// The residuals without the causes, as large as those of so many records would be.
  Eigen::MatrixXd rest;
};

/// Separates principal components that stand out of the noise (V. A. Marchenko and L. A. Pastur,
/// Math. USSR Sbornik 1, 1967: of noise the largest exceeds their mean by (1 + sqrt(m / n))^2, with
/// m components of n independent samples).
///
/// @param residuals  each record less the mean of the others, shape (samples, records), records >=
/// 3
CommonCauses common_causes(const Eigen::MatrixXd& residuals);

}  // namespace rigcal::diagnosis
