#pragma once

#include <cstddef>
#include <utility>

#include "model/signal/signal.hpp"

namespace rigcal::model {

/// A signal as a simulation walks along it: the segment that holds now, and when it ends. Times
/// count from the first sample, so that long time stamps cost no digits; the signal may be delayed
/// by a dead time.
class InputTrack {
 public:
  /// @param before    other than `hold`, it waits as long as the signal has not begun
  /// @param begins_s  when it does, on its own clock
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
  /// Whether the signal has yet to begin: value() and sample() are then of no use.
  bool waits() const { return waits_; }
  double first_value() const { return signal_.value(begins_s_); }

 private:
  Signal signal_;
  double shift_s_ = 0.0;   ///< time of the signal at the first sample
  double begins_s_ = 0.0;  ///< time of the signal at its own first sample
  bool waits_ = false;
  std::size_t segment_ = 0;
};

}  // namespace rigcal::model
