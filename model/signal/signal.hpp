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

/// Value of the drive before its first sample.
enum class Before {
  hold,    ///< equal to its first value; the rig starts from its initial state
  rest,    ///< neutral: no command, or the reference at which the piston rests
  steady,  ///< equal to its first value, at which the rig had settled
};

/// One period of a signal with amplitude 1, in pieces of equal length. The signal is smooth within
/// a piece. To add a waveform, add a shape and a row in datasets/campaign/waveform.cpp.
struct PeriodicShape {
  int pieces = 1;  ///< number of pieces; a simulation ends a step at the end of each
  /// @param piece  index within the period, from 0
  /// @param phase  within the period, in periods; negative before t = 0, where the piece is the
  ///               first
  /// @return       value, and slope per period
  SignalSample (*at)(int piece, double phase) = nullptr;
  bool reverses = false;  ///< after half a period the signal repeats with the opposite sign
};

/// From `from_s` on, a signal has the same value `period_s` later, or the opposite one.
struct Repetition {
  double from_s = 0.0;
  double period_s = 0.0;
  bool reversed = false;
};

/// A scalar function of time that is smooth between breakpoints. A simulation ends a step at every
/// breakpoint and evaluates the signal segment by segment, so that it neither smears nor skips an
/// edge.
class Signal {
 public:
  /// c for all t.
  static Signal constant(double value);
  /// A sin(2 pi f t).
  static Signal sine(double amplitude, double frequency_hz);
  /// A sgn(sin(2 pi f t)), +A at t = 0. At an edge it has the value of the new half period.
  static Signal square(double amplitude, double frequency_hz);
  /// A times a shape that repeats f times a second. The shape must outlive the signal.
  static Signal shaped(const PeriodicShape& shape, double amplitude, double frequency_hz);
  /// A sin(phase), with a frequency that sweeps from f0 to f1 over `sweep_s` and then stays at f1.
  static Signal chirp(double amplitude, double start_hz, double end_hz, double sweep_s,
                      bool logarithmic);
  /// Zero-order hold: each sample lasts until the next one. The first sample also applies before
  /// its time.
  static Signal held(std::vector<double> time_s, std::vector<double> value);
  /// Samples joined by straight lines; constant before the first and after the last.
  static Signal linear(std::vector<double> time_s, std::vector<double> value);
  /// The same, where it is known that the samples repeat.
  static Signal linear(std::vector<double> time_s, std::vector<double> value,
                       const Repetition& repetition);
  /// offset + A sin(2 pi f t + phase).
  static Signal ripple(double offset, double amplitude, double frequency_hz, double phase_rad);

  /// Segment at time t. At a breakpoint it is the later one.
  std::size_t segment_at(double t) const;
  /// End of a segment; infinity for the last one.
  double segment_end(std::size_t segment) const;
  /// Value and slope at t, computed with the formula of `segment`.
  SignalSample sample(std::size_t segment, double t) const;
  /// Value without the slope, which is cheaper.
  double value(std::size_t segment, double t) const;
  /// Value at t.
  double value(double t) const { return value(segment_at(t), t); }
  /// Time after which the signal repeats; 0 for a constant, std::nullopt if it does not repeat.
  std::optional<double> period_s() const;
  /// How samples repeat, if that is known.
  const std::optional<Repetition>& repetition() const { return repetition_; }
  /// Whether straight lines join samples, so that the value does not jump at a breakpoint.
  bool joined() const { return kind_ == Kind::linear; }
  /// Whether the signal changes its sign after half a period.
  bool reverses() const;
  /// Longest step that cannot skip an oscillation; infinity if the breakpoints prevent this
  /// already.
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
  std::optional<Repetition> repetition_;
};

}  // namespace rigcal::model
