#include "metrics/residual_features.hpp"

#include <cmath>
#include <vector>

#include "metrics/moments.hpp"

namespace rigcal::metrics {

ResidualFeatures residual_features(std::span<const double> residual) {
  constexpr std::string_view kFunction = "residual_features";
  finite_range(residual, kFunction, "residual");
  std::vector<double> size(residual.size());
  for (std::size_t i = 0; i < size.size(); ++i) size[i] = std::abs(residual[i]);
  const auto at = [&](std::size_t i) { return wide(size[i]); };
  return {
      to_double(mean_of(size.size(), at), kFunction),
      to_double(std::sqrt(mean_of(size.size(), [&](auto i) { return square(at(i)); })), kFunction),
      to_double(std::sqrt(Centred(size).variance()), kFunction)};
}

}  // namespace rigcal::metrics
