#include "datasets/prepare/recognised_drive.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "datasets/checks/equal_runs.hpp"
#include "datasets/prepare/waveform_guess.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr std::size_t kFewestToRecognise = 32;
constexpr double kOfStep = 0.75;    // a rounded value is off by half a step at most
constexpr double kMostStep = 0.02;  // fraction of the amplitude; a coarser record shows no waveform
constexpr double kExact = 1e-9;     // fraction of the amplitude: rounding errors in the computation
constexpr double kMostErrors = 5.0;  // in standard deviations of the stated noise
constexpr double kMostRms = 1.2;     // in standard deviations of the stated noise
constexpr int kMostSteps = 30;       // Gauss-Newton steps
constexpr int kMostDigits = 12;

/// A recorded drive, with the tolerance for recognising it.
struct Recorded {
  std::span<const double> time_s;
  std::span<const double> drive;
  double sd = 0.0;
  double step = 0.0;  ///< resolution of its converter or digits

  std::size_t size() const { return drive.size(); }
  double tolerance() const { return kOfStep * step + kMostErrors * sd; }
};

/// Returns the largest deviation of a sample; std::nullopt if any sample is outside the tolerance.
std::optional<double> farthest_from(const Recorded& record, const model::Signal& signal,
                                    double amplitude) {
  double farthest = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double e = std::abs(record.drive[i] - signal.value(record.time_s[i]));
    farthest = std::max(farthest, e);
    squares += e * e;
  }
  if (!(farthest <= record.tolerance() + kExact * amplitude)) return std::nullopt;
  const double rms = std::sqrt(squares / static_cast<double>(record.size()));
  const double stated = std::hypot(record.sd, record.step / std::sqrt(12.0));
  if (record.sd > 0.0 && rms > kMostRms * stated) return std::nullopt;
  return farthest;
}

double rounded(double value, int digits) {
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
}

/// Fits a few parameters of a signal by Gauss-Newton.
///
/// @param model  returns the signal at a time and its derivatives with respect to the parameters
/// @return       false if the steps diverge
template <int N>
bool solve(const Recorded& record, Eigen::Vector<double, N>& p,
           const std::function<double(double, const Eigen::Vector<double, N>&,
                                      Eigen::Vector<double, N>&)>& model) {
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::Matrix<double, N, N> normal = Eigen::Matrix<double, N, N>::Zero();
    Eigen::Vector<double, N> right = Eigen::Vector<double, N>::Zero();
    Eigen::Vector<double, N> slope;
    for (std::size_t i = 0; i < record.size(); ++i) {
      const double value = model(record.time_s[i], p, slope);
      normal += slope * slope.transpose();
      right += slope * (record.drive[i] - value);
    }
    // Scales each parameter, because frequencies and amplitudes differ by orders of magnitude.
    const Eigen::Vector<double, N> scale = normal.diagonal().cwiseSqrt().cwiseMax(1e-300);
    const Eigen::Matrix<double, N, N> scaled =
        scale.cwiseInverse().asDiagonal() * normal * scale.cwiseInverse().asDiagonal();
    const Eigen::Vector<double, N> change =
        scaled.ldlt().solve(right.cwiseQuotient(scale)).cwiseQuotient(scale);
    if (!change.allFinite()) return false;
    p += change;
    if (change.cwiseProduct(scale).norm() <= 1e-13 * p.cwiseProduct(scale).norm()) return true;
  }
  return p.allFinite();
}

std::optional<RecognisedDrive> named(const Recorded& record, model::Signal signal, double amplitude,
                                     std::string name) {
  const auto farthest = farthest_from(record, signal, amplitude);
  if (!farthest) return std::nullopt;
  return RecognisedDrive{std::move(signal), std::move(name), *farthest, record.tolerance()};
}

std::optional<RecognisedDrive> as_sine(const Recorded& record, double frequency_hz,
                                       const std::string& unit) {
  using P = Eigen::Vector<double, 4>;  // offset, sine, cosine, frequency
  P p(0.0, 0.0, 0.0, frequency_hz);
  const auto model = [](double t, const P& at, P& slope) {
    const double s = std::sin(kTwoPi * at(3) * t);
    const double c = std::cos(kTwoPi * at(3) * t);
    slope = P(1.0, s, c, kTwoPi * t * (at(1) * c - at(2) * s));
    return at(0) + at(1) * s + at(2) * c;
  };
  if (!solve<4>(record, p, model) || !(p(3) > 0.0)) return std::nullopt;
  const double amplitude = std::hypot(p(1), p(2));
  // Takes the simplest frequency within the tolerance: with few digits, the samples repeat from
  // period to period.
  for (int digits = 2; digits <= kMostDigits; ++digits) {
    const double f = rounded(p(3), digits);
    const double a = rounded(amplitude, digits);
    if (auto found =
            named(record, model::Signal::sine(a, f), a,
                  fmt::format("a sine of {:.6g} Hz with an amplitude of {:.6g} {}", f, a, unit)))
      return found;
  }
  for (int digits = 2; digits <= kMostDigits; ++digits) {
    const double f = rounded(p(3), digits);
    const double phase = std::atan2(p(2), p(1)) + kTwoPi * (p(3) - f) * record.time_s[0];
    if (auto found = named(record, model::Signal::ripple(p(0), amplitude, f, phase), amplitude,
                           fmt::format("a sine of {:.6g} Hz with an amplitude of {:.6g} {} about "
                                       "{:.4g} {}",
                                       f, amplitude, unit, p(0), unit)))
      return found;
  }
  return std::nullopt;
}

/// Returns the number in [low, high] that has the fewest digits.
double roundest_between(double low, double high) {
  for (int digits = 1; digits <= 17; ++digits) {
    const double middle = rounded(0.5 * (low + high), digits);
    if (middle >= low && middle <= high) return middle;
  }
  return 0.5 * (low + high);
}

/// Frequencies at which every edge of a square wave is where a record shows it.
struct SquareFrequencies {
  double low_hz = 0.0;
  double high_hz = std::numeric_limits<double>::infinity();
  long edges = 0;
};

constexpr double kEdgeRounding = 1e-12;  // fraction of a frequency that two samples give alike

/// Edge k of a square wave is at k / (2 f): after the last sample before it, and no later than the
/// first sample after it. Samples between the two levels are not used, like a zero at the
/// beginning.
/// @return  std::nullopt if an edge is not after t = 0
std::optional<SquareFrequencies> square_frequencies(const Recorded& record, double amplitude) {
  SquareFrequencies found;
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!(std::abs(record.drive[i]) >= amplitude - record.tolerance())) continue;
    const auto before = std::exchange(last, i);
    if (!before || std::signbit(record.drive[i]) == std::signbit(record.drive[*before])) continue;
    if (!(record.time_s[i] > 0.0)) return std::nullopt;
    const double edge = static_cast<double>(++found.edges);
    found.low_hz = std::max(found.low_hz, 0.5 * edge / record.time_s[i]);
    if (record.time_s[*before] > 0.0)
      found.high_hz = std::min(found.high_hz, 0.5 * edge / record.time_s[*before]);
  }
  return found;
}

std::optional<RecognisedDrive> as_square(const Recorded& record, double amplitude,
                                         const std::string& unit) {
  const auto bounds = square_frequencies(record, amplitude);
  if (!bounds || bounds->edges < 2 || !std::isfinite(bounds->high_hz)) return std::nullopt;
  const double low_hz = bounds->low_hz * (1.0 - kEdgeRounding);
  if (!(low_hz <= bounds->high_hz)) return std::nullopt;
  const double f = roundest_between(low_hz, std::max(bounds->high_hz, bounds->low_hz));
  const model::Signal signal = model::Signal::square(amplitude, f);
  // A sample at the instant of an edge may have either level, or one between them: a program that
  // simulates writes what its solver has there. It is known to be at that instant at t = 0, and
  // elsewhere if some edges are no later than their sample and others no earlier. If all of them
  // are later, the drive may be.
  const bool is_pinned = !(bounds->low_hz < bounds->high_hz * (1.0 - kEdgeRounding));
  constexpr double kTimeRounding = 1e-9;  // in half periods
  std::vector<double> drive(record.drive.begin(), record.drive.end());
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const double halves = 2.0 * f * record.time_s[i];
    const bool at_edge = std::abs(halves - std::round(halves)) <= kTimeRounding * (1.0 + halves);
    const bool at_start = std::lround(halves) == 0 && drive[i] >= 0.0;
    const bool between = std::abs(drive[i]) <= amplitude + record.tolerance();
    if (at_edge && between && (is_pinned || at_start)) drive[i] = signal.value(record.time_s[i]);
  }
  return named(
      {record.time_s, drive, record.sd, record.step}, signal, amplitude,
      fmt::format("a square wave of {:.6g} Hz with an amplitude of {:.6g} {}", f, amplitude, unit));
}

/// Whether a record has the two levels of a square wave, but for a sample at each edge and the
/// first.
bool has_two_levels(const Recorded& record, double top) {
  const auto at_top = [&](double x) {
    return std::abs(std::abs(x) - top) <= kMostErrors * record.sd;
  };
  std::ptrdiff_t edges = 1;
  for (std::size_t i = 1; i < record.size(); ++i)
    edges += std::signbit(record.drive[i]) == std::signbit(record.drive[i - 1]) ? 0 : 1;
  const auto others =
      std::count_if(record.drive.begin(), record.drive.end(), [&](double x) { return !at_top(x); });
  return others <= edges && others < static_cast<std::ptrdiff_t>(record.size() / 4);
}

/// Returns the zero crossings, interpolated between samples. Consecutive crossings are half a cycle
/// apart.
std::vector<double> crossings_of(const Recorded& record) {
  std::vector<double> crossings;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double before = record.drive[i - 1];
    const double now = record.drive[i];
    if (before == 0.0 || (before < 0.0) == (now < 0.0)) continue;
    crossings.push_back(record.time_s[i - 1] +
                        (record.time_s[i] - record.time_s[i - 1]) * before / (before - now));
  }
  return crossings;
}

/// Returns (0, frequency, rate) for the logarithmic chirp through the middle and the last crossing.
Eigen::Vector<double, 3> logarithmic_start(const std::vector<double>& crossings) {
  const std::size_t middle = crossings.size() / 2;
  const double t1 = crossings[middle];
  const double t2 = crossings.back();
  const double ratio = static_cast<double>(crossings.size()) / static_cast<double>(middle + 1);
  // Bisection works because expm1(rate t2) / expm1(rate t1) increases with the rate.
  double low = -50.0 / t2;
  double high = 49.0 / t2;  // asymmetric, so that no rate tried is zero
  for (int i = 0; i < 200; ++i) {
    const double rate = 0.5 * (low + high);
    (std::expm1(rate * t2) / std::expm1(rate * t1) < ratio ? low : high) = rate;
  }
  const double rate = 0.5 * (low + high);
  return {0.0, 0.5 * static_cast<double>(crossings.size()) * rate / std::expm1(rate * t2), rate};
}

/// Recognises a chirp that begins at t = 0 and spans the whole record.
std::optional<RecognisedDrive> as_chirp(const Recorded& record, double amplitude,
                                        const std::string& unit) {
  using P = Eigen::Vector<double, 3>;  // amplitude, frequency, rate
  const auto crossings = crossings_of(record);
  const double end_s = record.time_s.back();
  if (crossings.size() < 8 || std::abs(record.time_s.front()) > 1e-9 * end_s) return std::nullopt;
  // The number of cycles up to a crossing, divided by its time, is the mean frequency so far. Over
  // time it is nearly a straight line.
  double s = 0.0, st = 0.0, stt = 0.0, sy = 0.0, sty = 0.0;
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    const double t = crossings[k];
    const double y = 0.5 * static_cast<double>(k + 1) / t;
    s += 1.0, st += t, stt += t * t, sy += y, sty += t * y;
  }
  const double slope = (s * sty - st * sy) / (s * stt - st * st);
  const double first_hz = (sy - slope * st) / s;
  for (const bool logarithmic : {false, true}) {
    const auto cycles_of = [logarithmic](double t, double f, double rate) {
      if (!logarithmic) return f * t + 0.5 * rate * t * t;
      return std::abs(rate) < 1e-12 ? f * t : f * std::expm1(rate * t) / rate;
    };
    const auto model = [&](double t, const P& at, P& by) {
      const double cycles = cycles_of(t, at(1), at(2));
      const double sine = std::sin(kTwoPi * cycles);
      const double cosine = kTwoPi * at(0) * std::cos(kTwoPi * cycles);
      const double by_f = logarithmic ? cycles / at(1) : t;
      const double by_rate =
          logarithmic ? (at(1) * t * std::exp(at(2) * t) - cycles) / at(2) : 0.5 * t * t;
      by = P(sine, cosine * by_f, cosine * by_rate);
      return at(0) * sine;
    };
    P p(amplitude, first_hz, 2.0 * slope);
    if (logarithmic) p = P(amplitude, 0.0, 0.0) + logarithmic_start(crossings);
    if (crossings.front() > 0.0 && record.drive[1] < 0.0) p(0) = -p(0);
    if (!solve<3>(record, p, model) || !(p(1) > 0.0)) continue;
    const double f1 = logarithmic ? p(1) * std::exp(p(2) * end_s) : p(1) + p(2) * end_s;
    if (!(f1 > 0.0)) continue;
    if (auto found = named(
            record, model::Signal::chirp(p(0), p(1), f1, end_s, logarithmic), std::abs(p(0)),
            fmt::format("a {} chirp from {:.6g} Hz to {:.6g} Hz with an amplitude "
                        "of {:.6g} {}",
                        logarithmic ? "logarithmic" : "linear", p(1), f1, std::abs(p(0)), unit)))
      return found;
  }
  return std::nullopt;
}

}  // namespace

std::optional<RecognisedDrive> recognised_drive(std::span<const double> time_s,
                                                std::span<const double> drive,
                                                const std::string& unit, double sd) {
  if (drive.size() < kFewestToRecognise) return std::nullopt;
  const auto [low, high] = std::minmax_element(drive.begin(), drive.end());
  const double amplitude = 0.5 * (*high - *low);
  if (!(amplitude > 0.0)) return std::nullopt;
  Recorded record{time_s, drive, sd, 0.0};
  if (*low < 0.0 && has_two_levels(record, *high))
    return as_square(record, sd > 0.0 ? amplitude : *high, unit);
  record.step = std::min(resolution(equal_runs(drive)), kMostStep * amplitude);
  const WaveformGuess guess = guess_waveform(time_s, drive);
  if (guess.waveform == Waveform::sine) return as_sine(record, *guess.frequency_hz, unit);
  return as_chirp(record, amplitude, unit);
}

void recognise_drive(const Campaign& campaign, const Condition& condition, Record& record) {
  if (condition.waveform != Waveform::recorded) return;
  const Channel channel = drive_channel(campaign);
  const auto setting = campaign.channels.find(channel);
  const auto series = record.channels.find(channel);
  if (setting == campaign.channels.end() || series == record.channels.end()) return;
  if (!setting->second.recognise || setting->second.in_counts) return;
  const auto found =
      recognised_drive(record.time_s, series->second.mean, std::string(info(channel).unit),
                       setting->second.sd.value_or(0.0));
  if (!found) return;
  record.generated_drive = found->signal;
  record.notes.push_back(fmt::format(
      "the recorded {} is {}: no sample deviates by more than {:.2g} {} (resolution or stated "
      "noise: {:.2g}); it is simulated as such unless the channel has recognise = false",
      info(channel).key, found->name, found->farthest, info(channel).unit, found->tolerance));
}

}  // namespace rigcal::datasets
