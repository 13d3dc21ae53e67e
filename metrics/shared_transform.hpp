#pragma once

#include <unsupported/Eigen/FFT>

namespace rigcal::metrics {

/// Returns this thread's Fourier transform. Its table, which depends only on the length (a sine and
/// a cosine per sample), is computed once for lengths that recur, such as powers of two.
inline Eigen::FFT<double>& shared_transform() {
  thread_local Eigen::FFT<double> transform;
  return transform;
}

}  // namespace rigcal::metrics
