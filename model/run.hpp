#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "model/dormand_prince.hpp"
#include "model/error_norm.hpp"
#include "model/rosenbrock.hpp"
#include "model/simulate.hpp"
#include "model/system.hpp"

namespace rigcal::model {

/// Walks a system from the first sample to the last: steps under error control, each ending at the
/// next breakpoint of an input or tick of the controller at the latest, samples read from the dense
/// output in between. Inside, time counts from the first sample.
///
/// @tparam Stepper  Rosenbrock or DormandPrince
template <typename Plant, int N, int P, template <int, int> class Stepper>
class Run {
 public:
  using Sys = System<Plant, N, P>;
  using State = StateMatrix<N, P>;
  using C = Active<P>;

  Run(Sys system, const std::array<double, static_cast<std::size_t>(P)>& parameter_scale,
      std::span<const double> times_s, std::span<const Output> outputs,
      const SimulationOptions& options, std::chrono::steady_clock::time_point started)
      : system_(std::move(system)),
        norm_(floors(), parameter_scale, options.tolerance),
        times_s_(times_s),
        outputs_(outputs),
        options_(options),
        started_(started),
        observed_(outputs.size()) {
    period_s_ = system_.layout().sampled() ? value_of(system_.parameters().sample_time_s)
                                           : std::numeric_limits<double>::infinity();
    h_max_ = std::numeric_limits<double>::infinity();
    for_each_track([this](InputTrack& track) { h_max_ = std::min(h_max_, track.max_step()); });
  }

  /// Writes the outputs of every sample into `result` (matrices already sized); columns
  /// [first_column, first_column + columns) of the sensitivities.
  void operator()(InitialState initial, Simulation& result, int first_column, int columns) {
    const double t_last = sample_time(times_s_.size() - 1);
    double t = 0.0;
    State x = system_.initial(initial, t);
    if (system_.layout().sampled()) system_.tick(x, t);
    norm_.see(x);
    double h = first_step(x, t, t_last);
    std::size_t next_sample = 0;
    long tick_count = 1;

    const auto emit = [&](const State& state, double time) {
      system_.observe(state, time, outputs_, observed_);
      store(result, next_sample++, first_column, columns);
    };

    while (next_sample < times_s_.size()) {
      const double next_tick = static_cast<double>(tick_count) * period_s_;
      double stop = std::min(t_last, next_tick);
      for_each_track([&stop](InputTrack& track) { stop = std::min(stop, track.segment_end()); });

      // Smooth stretch up to the next event.
      while (t < stop) {
        while (next_sample < times_s_.size() && at(sample_time(next_sample), t)) emit(x, t);
        Linearisation<N, P> lin = system_.linearise(x, t);
        double error = 0.0;
        double t_new = t;
        State x_new;
        State x_err;
        double step = 0.0;
        for (bool accepted = false; !accepted;) {
          if (!within_budget(result, t)) return;
          step = std::min(h, h_max_);
          t_new = t + step;
          if (t_new > stop - 1e-3 * step) {
            t_new = stop;
            step = stop - t;
          }
          stepper_.do_step(system_, lin, x, t, x_new, step, x_err);
          error = norm_(x_err, x_new);
          accepted = error <= 1.0;
          const bool finite = std::isfinite(error);
          const double factor =
              finite
                  ? std::clamp(0.9 * std::pow(std::max(error, 1e-10), -1.0 / Stepper<N, P>::kOrder),
                               0.2, 5.0)
                  : 0.1;
          if (accepted) {
            ++result.steps;
            // A step cut short by an event says nothing against the longer step planned before.
            h = step < 0.99 * h ? std::max(h, step * factor) : step * factor;
          } else {
            ++result.rejected_steps;
            h = step * std::min(factor, 0.9);
            if (h < 16.0 * kEpsilon * std::max(t, 1e-3)) {
              fail(result, finite ? SimulationStatus::step_too_small : SimulationStatus::not_finite,
                   t,
                   finite ? fmt::format("error control asks for steps below {:.1e} s", h)
                          : std::string("the state is no longer finite"));
              return;
            }
          }
        }
        const auto inside = [&] {
          return next_sample < times_s_.size() && sample_time(next_sample) < t_new &&
                 !at(sample_time(next_sample), t_new);
        };
        if (inside()) {
          stepper_.prepare_dense_output();
          State between;
          while (inside()) {
            const double time = sample_time(next_sample);
            stepper_.calc_state(time, between, x, t, x_new, t_new);
            emit(between, time);
          }
        }
        x = x_new;
        t = t_new;
        norm_.see(x);
      }

      // Events at `stop`: inputs jump, then the controller ticks.
      pass_breakpoints(x, t);
      if (at(next_tick, t)) {
        system_.tick(x, t);
        ++tick_count;
      }
      while (next_sample < times_s_.size() && at(sample_time(next_sample), t)) emit(x, t);
    }
  }

 private:
  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

  static Eigen::Matrix<double, N, 1> floors_of(const Layout& layout) {
    Eigen::Matrix<double, N, 1> floor;
    floor.setConstant(1e-3);  // volts
    for (std::size_t i = 0; i < Plant::kFloor.size(); ++i) {
      floor(static_cast<Eigen::Index>(i)) = Plant::kFloor[i];
    }
    if (layout.valve_order == 2) floor(layout.valve + 1) = 1.0;  // V/s
    if (layout.filter >= 0) floor(layout.filter) = Plant::kFloor[0];
    return floor;
  }
  Eigen::Matrix<double, N, 1> floors() const { return floors_of(system_.layout()); }

  template <typename F>
  void for_each_track(F f) {
    f(system_.drive());
    if (system_.external_force()) f(*system_.external_force());
    if (system_.supply_pressure()) f(*system_.supply_pressure());
  }

  double sample_time(std::size_t sample) const { return times_s_[sample] - times_s_.front(); }

  /// Sample times and edges are rounded: closer than this is the same instant. A nanosecond at
  /// most, unless the time stamps themselves are coarser.
  double same_instant() const {
    const double longest = std::max({1.0, std::abs(times_s_.front()), std::abs(times_s_.back())});
    return std::max(std::min(1e-12 * longest, 1e-9), 8.0 * kEpsilon * longest);
  }
  bool at(double a, double b) const { return std::abs(a - b) <= same_instant_s_; }

  /// A first step from the slope of the state; the error control takes it from there.
  double first_step(const State& x, double t, double span) const {
    const State f = system_.derivative(x, t);
    const double error = norm_(State(f * 1e-6), x);
    const double h = error > 0.0 && std::isfinite(error) ? 1e-6 * std::pow(error, -0.25) : 1e-6;
    return std::clamp(h, 1e-9, std::max(1e-9, 1e-2 * span));
  }

  /// Inputs that end a segment at t go to their next one. Where the jump's time depends on the
  /// transport delay, the sensitivity to it jumps by f(before) - f(after).
  void pass_breakpoints(State& x, double t) {
    if constexpr (P > 0) {
      const int delay = system_.delay_direction();
      if (delay >= 0 && passed(system_.drive(), t)) {
        const State before = system_.derivative(x, t);
        advance(system_.drive(), t);
        x.col(1 + delay) += (before - system_.derivative(x, t)).col(0);
      }
    }
    for_each_track([this, t](InputTrack& track) { advance(track, t); });
  }

  void advance(InputTrack& track, double t) const {
    while (passed(track, t)) track.next_segment();
  }

  bool passed(const InputTrack& track, double t) const {
    const double end = track.segment_end();
    return end <= t || at(end, t);
  }

  bool within_budget(Simulation& result, double t) const {
    const long taken = result.steps + result.rejected_steps;
    if (taken >= options_.max_steps) {
      fail(result, SimulationStatus::too_many_steps, t,
           fmt::format("{} steps were not enough", options_.max_steps));
      return false;
    }
    if (taken % 256 == 0) {
      if (options_.cancel != nullptr && options_.cancel->load(std::memory_order_relaxed)) {
        fail(result, SimulationStatus::cancelled, t, "stopped on request");
        return false;
      }
      const std::chrono::duration<double> used = std::chrono::steady_clock::now() - started_;
      if (used.count() > options_.max_seconds) {
        fail(result, SimulationStatus::out_of_time, t,
             fmt::format("{:g} s of computing were not enough", options_.max_seconds));
        return false;
      }
    }
    return true;
  }

  void fail(Simulation& result, SimulationStatus status, double t, std::string reason) const {
    result.status = status;
    result.failed_at_s = times_s_.front() + t;
    result.reason = std::move(reason);
  }

  void store(Simulation& result, std::size_t sample, int first_column, int columns) const {
    const auto row = static_cast<Eigen::Index>(sample);
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      if (first_column == 0)
        result.outputs(row, static_cast<Eigen::Index>(k)) = value_of(observed_[k]);
      if constexpr (P > 0) {
        for (int j = 0; j < columns; ++j) {
          result.sensitivities[k](row, first_column + j) =
              observed_[k].derivative[static_cast<std::size_t>(j)];
        }
      }
    }
  }

  Sys system_;
  ErrorNorm<N, P> norm_;
  std::span<const double> times_s_;
  std::span<const Output> outputs_;
  const SimulationOptions& options_;
  std::chrono::steady_clock::time_point started_;
  std::vector<C> observed_;
  Stepper<N, P> stepper_;
  double period_s_ = 0.0;
  double h_max_ = 0.0;
  double same_instant_s_ = same_instant();
};

}  // namespace rigcal::model
