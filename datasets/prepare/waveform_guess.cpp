#include "datasets/prepare/waveform_guess.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "metrics/fundamental.hpp"

namespace rigcal::datasets {
namespace {

constexpr double kHysteresis = 0.2;         // fraction of the amplitude
constexpr double kSteadyPeriods = 0.03;     // largest relative distance of a period from the mean
constexpr double kSineVariance = 0.98;      // fraction explained by the fundamental
constexpr double kSquareShare = 0.9;        // fraction of samples at the two levels
constexpr double kChirpRatio = 1.3;         // ratio of the longest period to the shortest
constexpr double kLeastStep = 0.1;          // fraction of the amplitude, between two samples
constexpr std::size_t kFewestPlateau = 50;  // samples per step, on average
constexpr double kPhaseTolerance_rad = 0.1;
constexpr double kOffsetTolerance = 0.02;  // fraction of the amplitude

struct Level {
  double middle = 0.0;
  double amplitude = 0.0;
};

Level level_of(std::span<const double> signal) {
  const auto [low, high] = std::minmax_element(signal.begin(), signal.end());
  return {0.5 * (*low + *high), 0.5 * (*high - *low)};
}

/// Returns the times at which the signal crosses the middle upwards, interpolated between samples.
std::vector<double> upward_crossings(std::span<const double> time_s, std::span<const double> signal,
                                     const Level& level) {
  std::vector<double> crossings;
  bool armed = false;
  double last_s = 0.0;
  for (std::size_t i = 1; i < signal.size(); ++i) {
    const double before = signal[i - 1] - level.middle;
    const double now = signal[i] - level.middle;
    if (before < -kHysteresis * level.amplitude) armed = true;
    if (before < 0.0 && now >= 0.0)
      last_s = time_s[i - 1] + (time_s[i] - time_s[i - 1]) * before / (before - now);
    if (armed && now > kHysteresis * level.amplitude) {
      crossings.push_back(last_s);
      armed = false;
    }
  }
  return crossings;
}

std::vector<double> differences(const std::vector<double>& x) {
  std::vector<double> result;
  for (std::size_t i = 1; i < x.size(); ++i) result.push_back(x[i] - x[i - 1]);
  return result;
}

bool is_square(std::span<const double> signal, const Level& level) {
  const auto at_level = std::count_if(signal.begin(), signal.end(), [&](double x) {
    return std::abs(std::abs(x - level.middle) - level.amplitude) < 0.1 * level.amplitude;
  });
  return static_cast<double>(at_level) >= kSquareShare * static_cast<double>(signal.size());
}

double variance_of(std::span<const double> signal) {
  const double n = static_cast<double>(signal.size());
  const double mean = std::accumulate(signal.begin(), signal.end(), 0.0) / n;
  return std::accumulate(signal.begin(), signal.end(), 0.0,
                         [mean](double sum, double x) { return sum + (x - mean) * (x - mean); }) /
         n;
}

void judge_periodic(std::span<const double> time_s, std::span<const double> signal,
                    const Level& level, WaveformGuess& guess) {
  const double f = *guess.frequency_hz;
  const auto found = metrics::fundamental(time_s, signal, f);
  const bool square = is_square(signal, level);
  const double explained = 0.5 * found.amplitude * found.amplitude / variance_of(signal);
  if (!square && explained < kSineVariance) {
    guess.description = fmt::format("periodic, {:.4g} Hz, neither sine nor square", f);
    return;
  }
  guess.waveform = square ? Waveform::square : Waveform::sine;
  guess.amplitude = square ? level.amplitude : found.amplitude;
  const bool centred = std::abs(level.middle) < kOffsetTolerance * level.amplitude;
  guess.can_be_generated = centred && std::abs(found.phase_rad) < kPhaseTolerance_rad;
  guess.description = fmt::format("a {} of {:.4g} Hz", to_string(guess.waveform), f);
}

/// Describes the steps of a signal that is constant between them; otherwise says that it has no
/// known waveform.
std::string steps_text(std::span<const double> signal, const Level& level) {
  std::size_t steps = 0;
  for (std::size_t i = 1; i < signal.size(); ++i)
    steps += std::abs(signal[i] - signal[i - 1]) > kLeastStep * level.amplitude ? 1 : 0;
  const bool held = steps > 0 && steps <= signal.size() / kFewestPlateau;
  return held ? fmt::format("{} step{}", steps, steps == 1 ? "" : "s")
              : std::string("not a waveform that rigcal can generate");
}

}  // namespace

WaveformGuess guess_waveform(std::span<const double> time_s, std::span<const double> signal) {
  WaveformGuess guess;
  if (signal.empty()) return guess;
  const Level level = level_of(signal);
  if (!(level.amplitude > 0.0)) {
    guess.description = "constant";
    return guess;
  }
  const auto periods = differences(upward_crossings(time_s, signal, level));
  const auto [shortest, longest] = std::minmax_element(periods.begin(), periods.end());
  const double mean = periods.empty() ? 0.0
                                      : std::accumulate(periods.begin(), periods.end(), 0.0) /
                                            static_cast<double>(periods.size());
  if (!periods.empty() && *longest - mean <= kSteadyPeriods * mean &&
      mean - *shortest <= kSteadyPeriods * mean) {
    guess.frequency_hz = 1.0 / mean;
    judge_periodic(time_s, signal, level, guess);
  } else if (periods.size() >= 3 && *longest > kChirpRatio * *shortest &&
             (std::is_sorted(periods.begin(), periods.end()) ||
              std::is_sorted(periods.rbegin(), periods.rend()))) {
    guess.waveform = Waveform::chirp;
    guess.frequency_hz = 1.0 / periods.front();
    guess.end_frequency_hz = 1.0 / periods.back();
    guess.amplitude = level.amplitude;
    guess.description = fmt::format("a chirp from about {:.3g} Hz to {:.3g} Hz",
                                    *guess.frequency_hz, *guess.end_frequency_hz);
  } else {
    guess.description = steps_text(signal, level);
  }
  return guess;
}

}  // namespace rigcal::datasets
