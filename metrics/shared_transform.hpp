#pragma once

#include <unsupported/Eigen/FFT>

namespace rigcal::metrics {

/// Fourier transforms of this thread. The table that depends only on the length (a sine and cosine
/// per sample) is computed once, for lengths that recur, such as powers of two.
inline Eigen::FFT<double>& shared_transform() {
  thread_local Eigen::FFT<double> transform;
  return transform;
}

}  // namespace rigcal::metrics
