#pragma once

#include <cstddef>

#include "model/signal.hpp"

namespace rigcal::model {

/// A signal as a simulation walks along it: the segment that holds now, and when it ends. The
/// signal may be delayed by a dead time.
class InputTrack {
 public:
  InputTrack(Signal signal, double start_s, double delay_s)
      : signal_(std::move(signal)), delay_s_(delay_s) {
    segment_ = signal_.segment_at(start_s - delay_s_);
  }

  double segment_end() const { return signal_.segment_end(segment_) + delay_s_; }
  void next_segment() { ++segment_; }
  SignalSample sample(double t) const { return signal_.sample(segment_, t - delay_s_); }
  double max_step() const { return signal_.max_step(); }
  double peak() const { return signal_.peak(); }

 private:
  Signal signal_;
  double delay_s_ = 0.0;
  std::size_t segment_ = 0;
};

}  // namespace rigcal::model
