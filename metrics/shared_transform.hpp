#pragma once

#include <unsupported/Eigen/FFT>

namespace rigcal::metrics {

/// Fourier transforms of this thread. What depends on the length alone, a sine and cosine for each
/// sample, is computed once: for lengths that come again, as powers of two do.
inline Eigen::FFT<double>& shared_transform() {
  thread_local Eigen::FFT<double> transform;
  return transform;
}

}  // namespace rigcal::metrics
