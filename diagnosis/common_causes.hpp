#pragma once

#include <Eigen/Core>

namespace rigcal::diagnosis {

/// How healthy records of one signal differ: by their own noise, and by causes that change a whole
/// record, such as a supply that varies from run to run.
struct CommonCauses {
  /// Change of a record per standard deviation of each cause, shape (samples, causes). No columns
  /// if the records differ only by noise.
  Eigen::MatrixXd patterns;
  /// Residuals without the causes, scaled up to make up for the noise that was removed with them.
  Eigen::MatrixXd rest;
};

/// Separates principal components that exceed the noise. In noise, the largest component exceeds
/// their mean by a factor of (1 + sqrt(m / n))^2 for m components and n independent samples (V. A.
/// Marchenko and L. A. Pastur, Math. USSR Sbornik 1, 1967).
///
/// @param residuals  each record minus the mean of the others, shape (samples, records), with at
///                   least 3 records
CommonCauses common_causes(const Eigen::MatrixXd& residuals);

}  // namespace rigcal::diagnosis
