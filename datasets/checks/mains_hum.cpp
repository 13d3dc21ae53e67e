#include "datasets/checks/mains_hum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "metrics/shared_transform.hpp"

namespace rigcal::datasets {
namespace {

// Thresholds for the row "hum of the mains" in docs/campaign-records.md. The mains frequency varies
// by less than half a hertz.
constexpr double kLineHalfWidthHz = 0.5;
constexpr double kSideShare = 0.45;  ///< neighbours are within this fraction of the frequency
constexpr double kSideLobes = 3.0;   ///< width of a smeared line, in multiples of 1 / record length
constexpr double kAboveNeighbours = 10.0;  ///< ratio of powers
constexpr double kLeastShareOfVariance = 0.2;

/// Sum of the periodograms of all repeats, with the quantities needed to scale it.
struct Spectrum {
  std::vector<double> power;  ///< sum of |X|^2 over the repeats
  double step_hz = 0.0;
  double length = 0.0;   ///< length of the transform
  double samples = 0.0;  ///< samples in one repeat
  double squares = 0.0;  ///< sum over all samples of all repeats
};

Spectrum spectrum_of(const std::vector<std::vector<double>>& deviations, double rate_hz) {
  const std::size_t samples = deviations.front().size();
  std::size_t length = 1;
  while (length < samples) length *= 2;
  Spectrum result;
  result.power.assign(length / 2 + 1, 0.0);
  result.step_hz = rate_hz / static_cast<double>(length);
  result.length = static_cast<double>(length);
  result.samples = static_cast<double>(samples);
  std::vector<std::complex<double>> transform;
  for (std::vector<double> row : deviations) {
    for (double& value : row) {
      if (std::isnan(value)) value = 0.0;
      result.squares += value * value;
    }
    row.resize(length, 0.0);
    metrics::shared_transform().fwd(transform, row);
    for (std::size_t k = 0; k < result.power.size(); ++k)
      result.power[k] += std::norm(transform[k]);
  }
  return result;
}

/// Returns the largest power on either side of a frequency, between two distances from it.
double largest(const Spectrum& spectrum, double frequency_hz, double from_hz, double to_hz) {
  double most = 0.0;
  for (std::size_t k = 0; k < spectrum.power.size(); ++k) {
    const double away = std::abs(static_cast<double>(k) * spectrum.step_hz - frequency_hz);
    if (from_hz <= away && away <= to_hz) most = std::max(most, spectrum.power[k]);
  }
  return most;
}

/// Returns the total power of a spectral line, which may fall between two frequencies of the
/// spectrum.
double total(const Spectrum& spectrum, double frequency_hz, double within_hz) {
  double sum = 0.0;
  for (std::size_t k = 0; k < spectrum.power.size(); ++k) {
    const double away = std::abs(static_cast<double>(k) * spectrum.step_hz - frequency_hz);
    if (away <= within_hz) sum += spectrum.power[k];
  }
  return sum;
}

/// Whether a harmonic of the drive is at this frequency, and the neighbouring harmonics are too far
/// away to reveal that it is one.
bool hidden_by_drive(double frequency_hz, double drive_hz, double line_hz) {
  if (!(drive_hz > 0.0)) return false;
  const double nearest = std::round(frequency_hz / drive_hz) * drive_hz;
  // A square wave has only odd harmonics.
  return std::abs(nearest - frequency_hz) <= line_hz && 2.0 * drive_hz > kSideShare * frequency_hz;
}

}  // namespace

std::optional<MainsHum> mains_hum(const std::vector<std::vector<double>>& deviations,
                                  double rate_hz, double drive_hz) {
  if (deviations.size() < 2 || deviations.front().empty()) return std::nullopt;
  std::optional<Spectrum> spectrum;
  std::optional<MainsHum> found;
  for (const double frequency_hz : {50.0, 60.0}) {
    const double resolution_hz = rate_hz / static_cast<double>(deviations.front().size());
    const double line_hz = std::max(kLineHalfWidthHz, resolution_hz);
    const double near_hz = line_hz + kSideLobes * resolution_hz;
    const double far_hz = kSideShare * frequency_hz;
    // The comparison is negated because the rate of a record with one sample is NaN.
    if (!(0.5 * rate_hz >= frequency_hz + far_hz) || !(2.0 * near_hz <= far_hz)) continue;
    if (hidden_by_drive(frequency_hz, drive_hz, line_hz)) continue;
    if (!spectrum) spectrum = spectrum_of(deviations, rate_hz);
    const double line = largest(*spectrum, frequency_hz, 0.0, line_hz);
    if (!(line > kAboveNeighbours * largest(*spectrum, frequency_hz, near_hz, far_hz))) continue;
    // Parseval's theorem. The factor of 2 accounts for the negative frequencies.
    const double squares = 2.0 * total(*spectrum, frequency_hz, line_hz) / spectrum->length;
    const double share = squares / spectrum->squares;
    // Subtracting the mean removed a fraction 1/R of the power.
    const auto repeats = static_cast<double>(deviations.size());
    const double amplitude = std::sqrt(2.0 * squares / spectrum->samples / (repeats - 1.0));
    if (share < kLeastShareOfVariance || (found && found->amplitude > amplitude)) continue;
    found = MainsHum{frequency_hz, amplitude};
  }
  return found;
}

}  // namespace rigcal::datasets
