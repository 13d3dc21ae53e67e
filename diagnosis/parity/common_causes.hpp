#pragma once

#include <Eigen/Core>

namespace rigcal::diagnosis {

/// How the healthy records of one signal differ: by their own noise, and due to causes that change
/// whole records, such as a supply pressure that varies from run to run.
struct CommonCauses {
  /// Change in a record per standard deviation of each cause, shape (samples, causes). Without
  /// columns if the records differ only by noise.
  Eigen::MatrixXd patterns;
  /// Residuals without the causes, scaled up to compensate for the noise that was removed together
  /// with them.
  Eigen::MatrixXd rest;
};

/// Separates the principal components that exceed the noise. If there is only noise, the variance
/// of the largest component exceeds the mean by a factor of (1 + sqrt(m / n))^2 for m components
/// and n independent samples (V. A. Marchenko and L. A. Pastur, Math. USSR Sbornik 1, 1967).
///
/// @param residuals  each record minus the mean of the others, shape (samples, records); at least 3
///                   records
CommonCauses common_causes(const Eigen::MatrixXd& residuals);

}  // namespace rigcal::diagnosis
