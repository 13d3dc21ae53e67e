#include "model/signal/signal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace rigcal::model {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Largest distance from an edge, in half periods, at which a time counts as at the edge, because
/// sample times are rounded.
constexpr double kEdgeTolerance = 1e-9;
/// Minimum number of steps per period, so that no step skips an oscillation.
constexpr double kStepsPerPeriod = 8.0;

void require_frequency(double frequency_hz) {
  if (!(frequency_hz >= 0.0 && std::isfinite(frequency_hz))) {
    throw std::invalid_argument("Signal: a frequency must be finite and not negative");
  }
}

void require_samples(const std::vector<double>& time_s, const std::vector<double>& value) {
  if (time_s.empty() || time_s.size() != value.size()) {
    throw std::invalid_argument("Signal: times and values must have the same size, at least 1");
  }
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1])) {
      throw std::invalid_argument("Signal: times must increase");
    }
  }
}

}  // namespace

Signal Signal::constant(double value) {
  Signal s;
  s.offset_ = value;
  return s;
}

Signal Signal::sine(double amplitude, double frequency_hz) {
  return ripple(0.0, amplitude, frequency_hz, 0.0);
}

Signal Signal::ripple(double offset, double amplitude, double frequency_hz, double phase_rad) {
  require_frequency(frequency_hz);
  Signal s;
  s.kind_ = Kind::sine;
  s.offset_ = offset;
  s.amplitude_ = amplitude;
  s.frequency_hz_ = frequency_hz;
  s.phase_rad_ = phase_rad;
  return s;
}

Signal Signal::square(double amplitude, double frequency_hz) {
  require_frequency(frequency_hz);
  Signal s;
  s.kind_ = Kind::square;
  s.amplitude_ = amplitude;
  s.frequency_hz_ = frequency_hz;
  return s;
}

Signal Signal::shaped(const PeriodicShape& shape, double amplitude, double frequency_hz) {
  require_frequency(frequency_hz);
  Signal s;
  s.kind_ = Kind::shaped;
  s.amplitude_ = amplitude;
  s.frequency_hz_ = frequency_hz;
  s.shape_ = &shape;
  return s;
}

Signal Signal::chirp(double amplitude, double start_hz, double end_hz, double sweep_s,
                     bool logarithmic) {
  require_frequency(start_hz);
  require_frequency(end_hz);
  if (!(sweep_s > 0.0)) throw std::invalid_argument("Signal::chirp: sweep_s must be positive");
  if (logarithmic && !(start_hz > 0.0 && end_hz > 0.0)) {
    throw std::invalid_argument("Signal::chirp: a logarithmic sweep needs positive frequencies");
  }
  Signal s;
  s.kind_ = Kind::chirp;
  s.amplitude_ = amplitude;
  s.frequency_hz_ = start_hz;
  s.end_frequency_hz_ = end_hz;
  s.sweep_s_ = sweep_s;
  s.logarithmic_ = logarithmic && start_hz != end_hz;
  return s;
}

Signal Signal::held(std::vector<double> time_s, std::vector<double> value) {
  require_samples(time_s, value);
  Signal s;
  s.kind_ = Kind::held;
  s.time_s_ = std::make_shared<const std::vector<double>>(std::move(time_s));
  s.value_ = std::make_shared<const std::vector<double>>(std::move(value));
  return s;
}

Signal Signal::linear(std::vector<double> time_s, std::vector<double> value) {
  Signal s = held(std::move(time_s), std::move(value));
  s.kind_ = Kind::linear;
  return s;
}

Signal Signal::linear(std::vector<double> time_s, std::vector<double> value,
                      const Repetition& repetition) {
  Signal s = linear(std::move(time_s), std::move(value));
  s.repetition_ = repetition;
  return s;
}

// Segments of each kind:
//   square        segment k is half period k; segment 0 also covers t < 0
//   shaped        as square, with pieces instead of half periods
//   chirp         the sweep, then the constant end frequency
//   hold, linear  segment 0 before the first sample, then k + 1 from sample k
std::size_t Signal::segment_at(double t) const {
  switch (kind_) {
    case Kind::constant:
    case Kind::sine:
      return 0;
    case Kind::square: {
      const double half_periods = 2.0 * frequency_hz_ * t + kEdgeTolerance;
      return half_periods <= 0.0 ? 0 : static_cast<std::size_t>(half_periods);
    }
    case Kind::shaped: {
      const double pieces = shape_->pieces * frequency_hz_ * t + kEdgeTolerance;
      return pieces <= 0.0 ? 0 : static_cast<std::size_t>(pieces);
    }
    case Kind::chirp:
      return t < sweep_s_ ? 0 : 1;
    case Kind::held:
    case Kind::linear: {
      const auto& times = *time_s_;
      return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), t) -
                                      times.begin());
    }
  }
  return 0;
}

double Signal::segment_end(std::size_t segment) const {
  switch (kind_) {
    case Kind::constant:
    case Kind::sine:
      return kInfinity;
    case Kind::square:
      return static_cast<double>(segment + 1) / (2.0 * frequency_hz_);
    case Kind::shaped:
      return static_cast<double>(segment + 1) / (shape_->pieces * frequency_hz_);
    case Kind::chirp:
      return segment == 0 ? sweep_s_ : kInfinity;
    case Kind::held:
    case Kind::linear:
      return segment < time_s_->size() ? (*time_s_)[segment] : kInfinity;
  }
  return kInfinity;
}

SignalSample Signal::sample(std::size_t segment, double t) const {
  switch (kind_) {
    case Kind::constant:
      return {offset_, 0.0};
    case Kind::sine: {
      const double omega = kTwoPi * frequency_hz_;
      const double s = amplitude_ * std::sin(omega * t + phase_rad_);
      const double c = amplitude_ * std::cos(omega * t + phase_rad_);
      return {offset_ + s, omega * c};
    }
    case Kind::square:
      return {segment % 2 == 0 ? amplitude_ : -amplitude_, 0.0};
    case Kind::shaped: {
      const auto pieces = static_cast<std::size_t>(shape_->pieces);
      const std::size_t period = segment / pieces;
      const double phase = frequency_hz_ * t - static_cast<double>(period);
      const SignalSample unit = shape_->at(static_cast<int>(segment % pieces), phase);
      return {amplitude_ * unit.value, amplitude_ * frequency_hz_ * unit.slope};
    }
    case Kind::chirp: {
      const double f0 = frequency_hz_;
      const double f1 = end_frequency_hz_;
      double cycles = 0.0;
      double f = 0.0;
      if (segment == 0) {
        if (logarithmic_) {
          const double rate = std::log(f1 / f0) / sweep_s_;
          f = f0 * std::exp(rate * t);
          cycles = (f - f0) / rate;
        } else {
          const double rate = (f1 - f0) / sweep_s_;
          f = f0 + rate * t;
          cycles = (f0 + 0.5 * rate * t) * t;
        }
      } else {
        const double swept =
            logarithmic_ ? (f1 - f0) * sweep_s_ / std::log(f1 / f0) : 0.5 * (f0 + f1) * sweep_s_;
        cycles = swept + f1 * (t - sweep_s_);
        f = f1;
      }
      const double s = amplitude_ * std::sin(kTwoPi * cycles);
      const double c = amplitude_ * std::cos(kTwoPi * cycles);
      return {s, kTwoPi * f * c};
    }
    case Kind::held:
      return {(*value_)[segment == 0 ? 0 : segment - 1], 0.0};
    case Kind::linear: {
      const auto& times = *time_s_;
      const auto& values = *value_;
      if (segment == 0) return {values.front(), 0.0};
      if (segment >= times.size()) return {values.back(), 0.0};
      const double slope =
          (values[segment] - values[segment - 1]) / (times[segment] - times[segment - 1]);
      return {values[segment - 1] + slope * (t - times[segment - 1]), slope};
    }
  }
  return {};
}

double Signal::value(std::size_t segment, double t) const {
  if (kind_ == Kind::sine)
    return offset_ + amplitude_ * std::sin(kTwoPi * frequency_hz_ * t + phase_rad_);
  return sample(segment, t).value;
}

std::optional<double> Signal::period_s() const {
  switch (kind_) {
    case Kind::constant:
      return 0.0;
    case Kind::sine:
    case Kind::square:
    case Kind::shaped:
      return frequency_hz_ > 0.0 ? 1.0 / frequency_hz_ : 0.0;
    default:
      return std::nullopt;
  }
}

bool Signal::reverses() const {
  if (kind_ == Kind::shaped) return shape_->reverses;
  return (kind_ == Kind::sine || kind_ == Kind::square) && offset_ == 0.0;
}

double Signal::max_step() const {
  switch (kind_) {
    case Kind::sine:
      return 1.0 / (kStepsPerPeriod * frequency_hz_);
    case Kind::chirp:
      return 1.0 / (kStepsPerPeriod * std::max(frequency_hz_, end_frequency_hz_));
    default:
      return kInfinity;
  }
}

}  // namespace rigcal::model
