#include "metrics/frequency_response.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <unsupported/Eigen/FFT>

#include "metrics/distributions.hpp"
#include "metrics/moments.hpp"
#include "metrics/shared_transform.hpp"

namespace rigcal::metrics {
namespace {

using Amplitude = std::complex<double>;

constexpr int kLastHarmonic = 15;
constexpr double kLeastHarmonic = 1e-2;  // fraction of the fundamental
constexpr std::size_t kLeastPerPeriod = 8;
constexpr std::size_t kLeastSamplesOfRecord = 64;
/// Fraction tapered at either end, by a split cosine bell. Bloomfield, Fourier Analysis of Time
/// Series, 1976.
constexpr double kTaper = 0.1;
constexpr double kResponseBinsPerDecade = 12.0;
constexpr std::size_t kLeastLines = 8;
constexpr double kLeastDensity = 1e-6;
/// Differences between samples represent the signal only up to this fraction of half the sampling
/// rate.
constexpr double kShareOfNyquist = 0.8;

/// Sums over pairs of complex amplitudes.
struct Products {
  double input = 0.0;   ///< sum of |U|^2
  double output = 0.0;  ///< sum of |Y|^2
  Amplitude cross;      ///< sum of conj(U) Y
  double pairs = 0.0;

  void add(const Amplitude& u, const Amplitude& y) {
    input += std::norm(u);
    output += std::norm(y);
    cross += std::conj(u) * y;
    pairs += 1.0;
  }
};

/// Complex regression of Y on U. The variance of H is that of the residual divided by the power of
/// the input, with half of it in each direction. Bendat and Piersol, Random Data, 4th ed., Wiley
/// 2010, 9.2.
///
/// @param independent  effective number of independent pairs
ResponsePoint point_of(double frequency_hz, const Products& sums, double independent) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  ResponsePoint point;
  point.frequency_hz = frequency_hz;
  const Amplitude ratio = sums.cross / sums.input;
  point.gain = std::abs(ratio);
  point.phase_deg = std::arg(ratio) * kDegrees;
  point.coherence = std::min(1.0, std::norm(sums.cross) / (sums.input * sums.output));
  point.independent = independent;
  if (independent < 2.0 || point.coherence == 0.0) return point;
  const double freedom = 2.0 * (independent - 1.0);
  const double relative = student_t_quantile(0.975, freedom) *
                          std::sqrt((1.0 - point.coherence) / (point.coherence * freedom));
  point.interval =
      ResponseInterval{point.gain * std::max(0.0, 1.0 - relative), point.gain * (1.0 + relative),
                       relative < 1.0 ? std::asin(relative) * kDegrees : 180.0};
  return point;
}

void check_sizes(const char* function, std::size_t samples, std::size_t input, std::size_t output) {
  if (input == samples && output == samples) return;
  throw std::invalid_argument(
      fmt::format("{}: {} sample times, {} samples of the input and {} of the output, expected as "
                  "many of each",
                  function, samples, input, output));
}

/// Amplitudes of a signal's harmonics in one period, fitted by least squares together with its
/// mean.
class Harmonics {
 public:
  Harmonics(std::span<const double> time_s, double frequency_hz, const std::vector<int>& numbers)
      : columns_(static_cast<Eigen::Index>(time_s.size()),
                 static_cast<Eigen::Index>(2 * numbers.size() + 1)) {
    for (Eigen::Index i = 0; i < columns_.rows(); ++i) {
      const double turns = (time_s[static_cast<std::size_t>(i)] - time_s.front()) * frequency_hz;
      const double angle = 2.0 * std::numbers::pi * turns;
      // Uses powers of one number, because a sine and a cosine for each harmonic would take most of
      // the time.
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      double cosine = 1.0;
      double sine = 0.0;
      columns_(i, 0) = 1.0;
      int at = 0;
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        for (; at < numbers[k]; ++at) {
          const double next = cosine * c - sine * s;
          sine = sine * c + cosine * s;
          cosine = next;
        }
        columns_(i, static_cast<Eigen::Index>(2 * k + 1)) = cosine;
        columns_(i, static_cast<Eigen::Index>(2 * k + 2)) = sine;
      }
    }
    solver_.compute(columns_.transpose() * columns_);
  }

  std::vector<Amplitude> of(std::span<const double> signal) const {
    const Eigen::Map<const Eigen::VectorXd> values(signal.data(),
                                                   static_cast<Eigen::Index>(signal.size()));
    // Removes the mean, which would cost precision in the variation.
    const Eigen::VectorXd moving = values.array() - values.mean();
    const Eigen::VectorXd solution = solver_.solve(columns_.transpose() * moving);
    std::vector<Amplitude> amplitudes;
    for (Eigen::Index k = 1; k < solution.size(); k += 2)
      amplitudes.emplace_back(solution[k], -solution[k + 1]);
    return amplitudes;
  }

 private:
  Eigen::MatrixXd columns_;
  Eigen::LDLT<Eigen::MatrixXd> solver_;
};

struct Window {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// Whole periods counted from the end of the record, in order of time. A sample represents the
/// interval before it.
std::vector<Window> whole_periods(std::span<const double> time_s, double frequency_hz) {
  const double last = time_s.back();
  const double step = (last - time_s.front()) / static_cast<double>(time_s.size() - 1);
  const double slack = 1e-3 * step;
  auto periods = static_cast<int>((last - time_s.front() + step + slack) * frequency_hz);
  if (periods < 1)
    throw std::invalid_argument(
        fmt::format("periodic_response: the record covers {} s, expected at least one period of {} "
                    "s",
                    last - time_s.front() + step, 1.0 / frequency_hz));
  if (periods >= 3) periods -= 1;
  const auto first_after = [&](double time) {
    return static_cast<std::size_t>(std::upper_bound(time_s.begin(), time_s.end(), time + slack) -
                                    time_s.begin());
  };
  std::vector<Window> windows;
  for (int k = periods; k > 0; --k) {
    const Window window{first_after(last - k / frequency_hz),
                        first_after(last - (k - 1) / frequency_hz)};
    if (window.end - window.begin < kLeastPerPeriod)
      throw std::invalid_argument(
          fmt::format("periodic_response: {} samples in a period of {} s, expected at least {}",
                      window.end - window.begin, 1.0 / frequency_hz, kLeastPerPeriod));
    windows.push_back(window);
  }
  return windows;
}

/// Tapers and transforms the differences of a signal.
std::vector<Amplitude> tapered_lines(std::span<const double> signal, std::size_t length,
                                     const std::vector<double>& taper) {
  std::vector<double> values(length);
  double mean = 0.0;
  for (std::size_t i = 0; i < length; ++i) {
    values[i] = signal[i + 1] - signal[i];
    mean += values[i] / static_cast<double>(length);
  }
  for (std::size_t i = 0; i < length; ++i) values[i] = (values[i] - mean) * taper[i];
  Eigen::FFT<double> fft;
  std::vector<Amplitude> lines;
  fft.fwd(lines, values);
  return lines;
}

std::vector<double> split_cosine_bell(std::size_t length) {
  std::vector<double> taper(length, 1.0);
  const auto edge = static_cast<std::size_t>(kTaper * static_cast<double>(length));
  for (std::size_t i = 0; i < edge; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(edge);
    taper[i] = taper[length - 1 - i] = 0.5 * (1.0 - std::cos(std::numbers::pi * share));
  }
  return taper;
}

/// Returns a length with only small prime factors, for which the transform is fast.
std::size_t quick_length(std::size_t most) {
  for (std::size_t length = most;; --length) {
    std::size_t rest = length;
    for (const std::size_t prime : {2U, 3U, 5U}) {
      while (rest % prime == 0) rest /= prime;
    }
    if (rest == 1) return length;
  }
}

}  // namespace

std::vector<ResponsePoint> periodic_response(std::span<const double> time_s,
                                             std::span<const double> input,
                                             std::span<const double> output, double frequency_hz) {
  check_sizes("periodic_response", time_s.size(), input.size(), output.size());
  if (!std::isfinite(frequency_hz) || frequency_hz <= 0.0)
    throw std::invalid_argument(fmt::format(
        "periodic_response: the frequency is {} Hz, expected a positive finite one", frequency_hz));
  if (time_s.size() < kLeastPerPeriod)
    throw std::invalid_argument(fmt::format("periodic_response: {} samples, expected at least {}",
                                            time_s.size(), kLeastPerPeriod));
  require_increasing(time_s, "periodic_response");
  if (finite_range(input, "periodic_response", "input").constant() ||
      finite_range(output, "periodic_response", "output").constant())
    return {};

  const std::vector<Window> windows = whole_periods(time_s, frequency_hz);
  std::size_t fewest = time_s.size();
  for (const Window& window : windows) fewest = std::min(fewest, window.end - window.begin);
  std::vector<int> numbers;
  for (int k = 1; k <= kLastHarmonic && 4 * static_cast<std::size_t>(k) <= fewest; k += 2)
    numbers.push_back(k);
  std::vector<Products> sums(numbers.size());
  for (const Window& window : windows) {
    const std::size_t count = window.end - window.begin;
    const Harmonics harmonics(time_s.subspan(window.begin, count), frequency_hz, numbers);
    const std::vector<Amplitude> u = harmonics.of(input.subspan(window.begin, count));
    const std::vector<Amplitude> y = harmonics.of(output.subspan(window.begin, count));
    for (std::size_t k = 0; k < numbers.size(); ++k) sums[k].add(u[k], y[k]);
  }
  std::vector<ResponsePoint> points;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const bool strong =
        sums[k].input > 0.0 && sums[k].input >= kLeastHarmonic * kLeastHarmonic * sums[0].input;
    if (strong && sums[k].output > 0.0)
      points.push_back(point_of(numbers[k] * frequency_hz, sums[k], sums[k].pairs));
  }
  return points;
}

std::vector<ResponsePoint> broadband_response(double sample_interval_s,
                                              std::span<const double> input,
                                              std::span<const double> output) {
  check_sizes("broadband_response", input.size(), input.size(), output.size());
  if (input.size() < kLeastSamplesOfRecord)
    throw std::invalid_argument(fmt::format("broadband_response: {} samples, expected at least {}",
                                            input.size(), kLeastSamplesOfRecord));
  if (!std::isfinite(sample_interval_s) || sample_interval_s <= 0.0)
    throw std::invalid_argument(
        fmt::format("broadband_response: the sample interval is {} s, expected a positive one",
                    sample_interval_s));
  if (finite_range(input, "broadband_response", "input").constant() ||
      finite_range(output, "broadband_response", "output").constant())
    return {};

  const std::size_t length = quick_length(input.size() - 1);
  const std::vector<double> taper = split_cosine_bell(length);
  const std::vector<Amplitude> u = tapered_lines(input, length, taper);
  const std::vector<Amplitude> y = tapered_lines(output, length, taper);
  // Neighbouring lines of a tapered record share part of their noise.
  double second = 0.0;
  double fourth = 0.0;
  for (const double w : taper) {
    second += w * w;
    fourth += w * w * w * w;
  }
  const double shared = static_cast<double>(length) * fourth / (second * second);

  struct Bin {
    double frequency = 0.0;  ///< sum of the frequencies, weighted by the input's power
    Products sums;
  };
  std::vector<Bin> bins;
  const double line_hz = 1.0 / (sample_interval_s * static_cast<double>(length));
  const auto last = static_cast<std::size_t>(0.5 * kShareOfNyquist * static_cast<double>(length));
  for (std::size_t k = 1; k <= last;) {
    const double upper = static_cast<double>(k) * std::pow(10.0, 1.0 / kResponseBinsPerDecade);
    Bin bin;
    for (; k <= last &&
           (bin.sums.pairs < static_cast<double>(kLeastLines) || static_cast<double>(k) < upper);
         ++k) {
      bin.sums.add(u[k], y[k]);
      bin.frequency += std::norm(u[k]) * static_cast<double>(k) * line_hz;
    }
    if (bin.sums.pairs >= static_cast<double>(kLeastLines)) bins.push_back(bin);
  }
  double largest = 0.0;
  for (const Bin& bin : bins) largest = std::max(largest, bin.sums.input / bin.sums.pairs);
  std::vector<ResponsePoint> points;
  for (const Bin& bin : bins) {
    const bool strong = bin.sums.input / bin.sums.pairs > kLeastDensity * largest;
    if (strong && bin.sums.output > 0.0)
      points.push_back(point_of(bin.frequency / bin.sums.input, bin.sums, bin.sums.pairs / shared));
  }
  return points;
}

BandLevels band_levels(std::span<const double> signal, double rate_hz, double bins_per_decade) {
  BandLevels levels;
  std::vector<double> centred(signal.begin(), signal.end());
  double mean = 0.0;
  for (const double value : centred) mean += value;
  mean /= static_cast<double>(centred.size());
  for (double& value : centred) value -= mean;
  std::vector<Amplitude> lines;
  shared_transform().fwd(lines, centred);
  const auto n = static_cast<double>(centred.size());
  int bin = -1;
  double power = 0.0;
  double sum_hz = 0.0;
  int count = 0;
  const auto close = [&] {
    if (count > 0) {
      levels.frequency_hz.push_back(sum_hz / count);
      levels.rms.push_back(std::sqrt(power));
    }
    power = sum_hz = 0.0;
    count = 0;
  };
  for (std::size_t k = 1; 2 * k < centred.size(); ++k) {
    const double frequency_hz = static_cast<double>(k) * rate_hz / n;
    const int at =
        static_cast<int>(std::floor(bins_per_decade * std::log10(frequency_hz * n / rate_hz)));
    if (at != bin) close();
    bin = at;
    power += 2.0 * std::norm(lines[k]) / (n * n);
    sum_hz += frequency_hz;
    ++count;
  }
  close();
  return levels;
}

}  // namespace rigcal::metrics
