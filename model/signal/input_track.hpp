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
  InputTrack(Signal signal, double start_s, double delay_s)
      : signal_(std::move(signal)), shift_s_(start_s - delay_s) {
    segment_ = signal_.segment_at(shift_s_);
  }

  double segment_end() const { return signal_.segment_end(segment_) - shift_s_; }
  void next_segment() { ++segment_; }
  double value(double t) const { return signal_.value(segment_, t + shift_s_); }
  SignalSample sample(double t) const { return signal_.sample(segment_, t + shift_s_); }
  double max_step() const { return signal_.max_step(); }

 private:
  Signal signal_;
  double shift_s_ = 0.0;  ///< time of the signal at the first sample
  std::size_t segment_ = 0;
};

}  // namespace rigcal::model
