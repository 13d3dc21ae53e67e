#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace rigcal::model {

/// Value of a signal at one instant and its time derivative within the present segment.
struct SignalSample {
  double value = 0.0;
  double slope = 0.0;
};

/// Drive before its first sample.
enum class Before {
  hold,    ///< its first value; the rig starts from its initial state
  rest,    ///< neutral: no command, or the reference at which the piston rests
  steady,  ///< its first value, at which the rig had settled
};

/// One period of a signal of amplitude 1, in pieces of equal length within which it is smooth. To
/// add a waveform: a shape, and a row of datasets/campaign/waveform.cpp.
struct PeriodicShape {
  int pieces = 1;  ///< at whose ends a simulation ends a step
  /// @param piece  of the period, from 0
  /// @param phase  within the period, in periods; before t = 0 negative, of the first piece
  /// @return       value, and slope per period
  SignalSample (*at)(int piece, double phase) = nullptr;
  bool reverses = false;  ///< half a period later it is the same with the other sign
};

/// A scalar function of time that is smooth between breakpoints. A simulation ends a step at every
/// breakpoint and evaluates the signal by segment, so that no edge is smeared or skipped.
class Signal {
 public:
  /// c for all t.
  static Signal constant(double value);
  /// A sin(2 pi f t).
  static Signal sine(double amplitude, double frequency_hz);
  /// A sgn(sin(2 pi f t)), +A at t = 0; at an edge the value of the new half period.
  static Signal square(double amplitude, double frequency_hz);
  /// A times a shape that repeats itself f times a second; the shape outlives the signal.
  static Signal shaped(const PeriodicShape& shape, double amplitude, double frequency_hz);
  /// A sin(phase) whose frequency goes from f0 to f1 over `sweep_s`, then stays at f1.
  static Signal chirp(double amplitude, double start_hz, double end_hz, double sweep_s,
                      bool logarithmic);
  /// Each sample lasts until the next one (zero-order hold); the first also applies before its
  /// time.
  static Signal held(std::vector<double> time_s, std::vector<double> value);
  /// Samples joined by straight lines, constant outside.
  static Signal linear(std::vector<double> time_s, std::vector<double> value);
  /// offset + A sin(2 pi f t + phase).
  static Signal ripple(double offset, double amplitude, double frequency_hz, double phase_rad);

  /// Segment at time t; the later one at a breakpoint.
  std::size_t segment_at(double t) const;
  /// End of a segment; infinity for the last.
  double segment_end(std::size_t segment) const;
  /// Value and derivatives at t by the formula of `segment`.
  SignalSample sample(std::size_t segment, double t) const;
  /// Value alone, for less.
  double value(std::size_t segment, double t) const;
  /// Value at t.
  double value(double t) const { return value(segment_at(t), t); }
  /// Time after which it repeats itself; 0 for a constant, none if it does not.
  std::optional<double> period_s() const;
  /// Whether the signal changes its sign after half a period.
  bool reverses() const;
  /// Longest step that cannot skip an oscillation; infinity if the segments are that.
  double max_step() const;

 private:
  enum class Kind { constant, sine, square, shaped, chirp, held, linear };
  Kind kind_ = Kind::constant;
  double amplitude_ = 0.0;
  double offset_ = 0.0;
  double frequency_hz_ = 0.0;
  double end_frequency_hz_ = 0.0;
  double sweep_s_ = 0.0;
  double phase_rad_ = 0.0;
  bool logarithmic_ = false;
  const PeriodicShape* shape_ = nullptr;
  std::shared_ptr<const std::vector<double>> time_s_;
  std::shared_ptr<const std::vector<double>> value_;
};

}  // namespace rigcal::model
