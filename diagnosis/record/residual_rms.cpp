#include "diagnosis/record/residual_rms.hpp"

#include <algorithm>
#include <cmath>

namespace rigcal::diagnosis {

double rms(const std::vector<double>& x) {
  double squares = 0.0;
  for (const double value : x) squares += value * value;
  return x.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(x.size()));
}

double noise_rms(const std::vector<double>& x) {
  double squares = 0.0;
  for (std::size_t i = 1; i < x.size(); ++i) squares += (x[i] - x[i - 1]) * (x[i] - x[i - 1]);
  return x.size() < 2 ? 0.0 : std::sqrt(0.5 * squares / static_cast<double>(x.size() - 1));
}

double structured_rms(double all, double noise) {
  return std::sqrt(std::max(0.0, all * all - noise * noise));
}

}  // namespace rigcal::diagnosis
