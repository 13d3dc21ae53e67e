#pragma once

#include <cstddef>
#include <utility>

#include "model/signal/signal.hpp"

namespace rigcal::model {

/// A signal during a simulation: the current segment and its end. Times count from the first
/// sample, so that long time stamps lose no digits. The signal may be delayed by a dead time.
class InputTrack {
 public:
  /// @param before    unless it is `hold`, the track waits until the signal begins
  /// @param begins_s  time of the signal's first sample, on the signal's own clock
  InputTrack(Signal signal, double start_s, double delay_s, Before before = Before::hold,
             double begins_s = 0.0)
      : signal_(std::move(signal)), shift_s_(start_s - delay_s), begins_s_(begins_s) {
    waits_ = before != Before::hold && shift_s_ < begins_s_;
    segment_ = signal_.segment_at(shift_s_);
  }

  double segment_end() const {
    return (waits_ ? begins_s_ : signal_.segment_end(segment_)) - shift_s_;
  }
  void next_segment() {
    segment_ = waits_ ? signal_.segment_at(begins_s_) : segment_ + 1;
    waits_ = false;
  }
  double value(double t) const { return signal_.value(segment_, t + shift_s_); }
  SignalSample sample(double t) const { return signal_.sample(segment_, t + shift_s_); }
  double max_step() const { return signal_.max_step(); }
  /// Whether the signal has not begun yet. Neither value() nor sample() may be called then.
  bool waits() const { return waits_; }
  /// Whether the value may jump at the end of the segment.
  bool may_jump() const { return waits_ || !signal_.joined(); }
  double first_value() const { return signal_.value(begins_s_); }

 private:
  Signal signal_;
  double shift_s_ = 0.0;   ///< signal time at the first sample of the simulation
  double begins_s_ = 0.0;  ///< signal time at which the signal begins
  bool waits_ = false;
  std::size_t segment_ = 0;
};

}  // namespace rigcal::model
