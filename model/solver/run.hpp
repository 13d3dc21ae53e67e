#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "model/plant/rig.hpp"
#include "model/plant/system.hpp"
#include "model/signal/known_periods.hpp"
#include "model/signal/same_instant.hpp"
#include "model/solver/dormand_prince.hpp"
#include "model/solver/error_norm.hpp"
#include "model/solver/repeated_steps.hpp"
#include "model/solver/rosenbrock.hpp"
#include "model/solver/sampled_period.hpp"
#include "model/solver/simulation.hpp"
#include "model/solver/steady_state.hpp"

namespace rigcal::model {

/// Integrates a system from the first sample to the last. Steps are chosen by error control, and
/// each ends no later than the next breakpoint of an input or tick of the controller. Samples
/// within a step are read from the dense output. Internally, time counts from the first sample.
template <typename Plant, int N, int P>
class Run {
 public:
  using Sys = System<Plant, N, P>;
  using X = State<N, P>;
  using C = Active<P>;

  Run(Sys system, const std::array<double, static_cast<std::size_t>(P)>& parameter_scale,
      std::span<const double> times_s, std::span<const Output> outputs,
      const SimulationOptions& options, const std::optional<SampledPeriod>& period,
      std::chrono::steady_clock::time_point started)
      : system_(std::move(system)),
        norm_(system_.layout().states, floors(system_.layout()), parameter_scale, options.tolerance,
              options.sensitivity_looseness),
        times_s_(times_s),
        outputs_(outputs),
        options_(options),
        started_(started),
        steady_state_(period, times_s.back() - times_s.front()),
        steps_(period),
        observed_(outputs.size()),
        observed_states_(Sys::observed_states(outputs)),
        implicit_(options.method != Method::dopri5) {
    for (const Output output : outputs) {
      const auto state = Plant::state_of(output);
      states_alone_ = states_alone_ && state.has_value();
      state_of_output_.push_back(static_cast<std::size_t>(state.value_or(0)));
    }
    period_s_ = system_.layout().sampled() ? system_.parameters().sample_time_s
                                           : std::numeric_limits<double>::infinity();
    h_max_ = std::numeric_limits<double>::infinity();
    for_each_track([this](InputTrack& track) { h_max_ = std::min(h_max_, track.max_step()); });
  }

  /// Writes the outputs at every sample into `result`, whose matrices already have their sizes.
  /// Sensitivities go into `columns` columns from `first_column` on.
  /// @param start  state at the first sample
  void operator()(const X& start, Simulation& result, int first_column, int columns) {
    result_ = &result;
    first_column_ = first_column;
    columns_ = columns;
    x_ = start;
    if (system_.layout().sampled()) system_.tick(x_, t_);
    norm_.see(x_);
    h_ = first_step(sample_time(times_s_.size() - 1));
    emit_present();
    while (next_sample_ < times_s_.size()) {
      const double stop = next_event();
      while (t_ < stop) {
        if (!step_towards(stop)) return;
      }
      pass_events();
      emit_present();
      if (at(steady_state_.next_look_s(), t_) && steady_state_.look(x_, norm_)) go_on_as_foreseen();
    }
  }

  /// State at the last sample, unless the end of the run was extrapolated.
  const X& state() const { return x_; }

  /// Size below which each state counts as zero.
  static std::array<double, static_cast<std::size_t>(N)> floors(const Layout& layout) {
    return state_floors<Plant, static_cast<std::size_t>(N)>(layout);
  }

 private:
  /// At a kink, the Dormand-Prince formula underestimates its error more than the Rosenbrock
  /// formula. At a fifth of the tolerance, both are equally accurate on the six signals in bench/.
  static constexpr double kCare = 5.0;
  /// A step stops being forced if its error is below this value, because a step half as long again
  /// would then be accepted.
  static constexpr double kStillForced = 0.1;
  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

  template <typename F>
  void for_each_track(F f) {
    f(system_.drive());
    if (system_.external_load()) f(*system_.external_load());
    if (system_.supply_pressure()) f(*system_.supply_pressure());
    if (system_.tank_pressure()) f(*system_.tank_pressure());
    if (system_.spool_error()) f(*system_.spool_error());
    if (system_.base_acceleration()) f(*system_.base_acceleration());
    if (system_.oil_temperature()) f(*system_.oil_temperature());
  }

  double sample_time(std::size_t sample) const { return times_s_[sample] - times_s_.front(); }

  bool at(double a, double b) const { return std::abs(a - b) <= same_instant_s_; }

  /// Estimates a first step from the slope of the state. Error control adjusts it from there.
  double first_step(double span) const {
    X small{};
    add_scaled(small, 1e-6, system_.derivative(x_, t_));
    const double error = norm_.of_states(small, x_);
    const double h = error > 0.0 && std::isfinite(error) ? 1e-6 * std::pow(error, -0.25) : 1e-6;
    return std::clamp(h, 1e-9, std::max(1e-9, 1e-2 * span));
  }

  /// Time of the next event: a breakpoint of an input, a tick of the controller, a check for the
  /// steady state, or the end of the run.
  double next_event() {
    double stop =
        std::min({sample_time(times_s_.size() - 1), next_tick(), steady_state_.next_look_s()});
    for_each_track([&stop](InputTrack& track) { stop = std::min(stop, track.segment_end()); });
    return stop;
  }

  double next_tick() const { return static_cast<double>(ticks_ + 1) * period_s_; }

  /// Makes one accepted step that ends no later than `stop`; returns false if the run has failed.
  bool step_towards(double stop) {
    prepare_step();
    bool rejected = false;
    while (true) {
      if (!within_budget()) return false;
      const RepeatedSteps::Step planned = steps_.follow(t_, std::min(h_, h_max_));
      double step = planned.size_s;
      const bool cut_short = t_ + step > stop - 1e-3 * step;
      if (cut_short) step = stop - t_;
      const double t_new = cut_short ? stop : t_ + step;
      X x_new;
      X x_err;
      const double error = try_step(step, x_new, x_err);
      const double factor = step_factor(error);
      if (error <= 1.0) {
        ++result_->steps;
        // A step that an event cut short does not rule out the longer step that was planned before.
        h_ = cut_short ? std::max(h_, step * factor) : step * factor;
        if (after_jump_) h_after_jump_ = step * factor;
        after_jump_ = false;
        steps_.note(t_new, rejected || (planned.forced && error > kStillForced));
        emit_until(t_new, x_new);
        x_ = x_new;
        t_ = t_new;
        if (!implicit_) slope_ = dormand_prince_.f_new();
        slope_known_ = !implicit_;
        lin_known_ = implicit_ && P > 0;
        if (lin_known_) lin_ = lin_end_;
        norm_.see(x_);
        return true;
      }
      ++result_->rejected_steps;
      rejected = true;
      h_ = step * std::min(factor, 0.9);
      if (h_ < 16.0 * kEpsilon * std::max(t_, 1e-3)) {
        if (std::isfinite(error)) {
          fail(SimulationStatus::step_too_small,
               fmt::format("error control requires steps below {:.1e} s", h_));
        } else {
          fail(SimulationStatus::not_finite, "the state is no longer finite");
        }
        return false;
      }
    }
  }

  /// Tries one step.
  ///
  /// @return  its error in units of the tolerance
  double try_step(double step, X& x_new, X& x_err) {
    if (!implicit_) {
      dormand_prince_.do_step(system_, slope_, x_, t_, x_new, step, x_err);
      return kCare * std::max(norm_.of_states(x_err, x_new), norm_.of_sensitivities(x_err, x_new));
    }
    rosenbrock_.do_step(system_, lin_, x_, t_, x_new, step, x_err);
    double error = norm_.of_states(x_err, x_new);
    if constexpr (P > 0) {
      if (!(error <= 1.0)) return error;
      lin_end_ = rosenbrock_.sensitivities(system_, lin_, x_, t_, x_new, step, x_err);
      const double others = norm_.of_sensitivities(x_err, x_new);
      if (!(others <= error)) error = others;
    }
    return error;
  }

  /// Prepares the next step: computes the linearisation, or the slope for the explicit method.
  void prepare_step() {
    if (implicit_ && !lin_known_) {
      lin_ = system_.linearise(values_of(x_), t_);
      lin_known_ = true;
    }
    if (!implicit_ && !slope_known_) slope_ = system_.derivative(x_, t_);
  }

  double step_factor(double error) const {
    if (!std::isfinite(error)) return 0.1;
    // The error grows as h^4 for the embedded Rosenbrock formula, and as h^5 for Dormand-Prince.
    const double e = std::max(error, 1e-10);
    return std::clamp(0.9 * (implicit_ ? inverse_fourth_root(e) : std::pow(e, -0.2)), 0.2, 5.0);
  }

  /// Emits the samples at the present instant.
  void emit_present() {
    while (next_sample_ < times_s_.size() && at(sample_time(next_sample_), t_)) emit(x_, t_);
  }

  /// Emits the samples strictly between the present and the end of the completed step. A sample at
  /// t_new itself is left for later, because an event there may change its value.
  void emit_until(double t_new, const X& x_new) {
    const double last = t_new - same_instant_s_;
    std::size_t end = next_sample_;
    while (end < times_s_.size() && sample_time(end) < last) ++end;
    if (end == next_sample_) return;
    const Interpolant<N, P> interpolant = implicit_
                                              ? rosenbrock_.dense_output(x_, x_new)
                                              : dormand_prince_.dense_output(x_, x_new, t_new - t_);
    const double rate = 1.0 / (t_new - t_);
    if (states_alone_) {
      for (std::size_t k = 0; k < outputs_.size(); ++k)
        store_polynomial(next_sample_, end, k, interpolant.coefficient[state_of_output_[k]], rate);
      next_sample_ = end;
      return;
    }
    X between = x_new;
    while (next_sample_ < end) {
      const double time = sample_time(next_sample_);
      for (const std::size_t i : observed_states_) between[i] = interpolant(i, (time - t_) * rate);
      emit(between, time);
    }
  }

  /// Stores samples [begin, end) of an output that is a state, given its polynomial over the step.
  /// The polynomial's variable is the fraction of the step.
  void store_polynomial(std::size_t begin, std::size_t end, std::size_t output,
                        const std::array<C, 5> polynomial, double rate) {
    const double origin = times_s_.front() + t_;
    for (std::size_t i = begin; i < end; ++i)
      store(i, output, Interpolant<N, P>::at(polynomial, (times_s_[i] - origin) * rate));
  }

  void emit(const X& x, double time) {
    system_.observe(x, time, outputs_, observed_);
    for (std::size_t k = 0; k < outputs_.size(); ++k) store(next_sample_, k, observed_[k]);
    ++next_sample_;
  }

  /// Switches inputs whose segment ends now to their next one, then lets the controller tick. If
  /// the time of a jump depends on the transport delay, the sensitivity to it jumps by
  /// f(before) - f(after). Recorded samples joined by straight lines have no jump.
  void pass_events() {
    const bool drive_jumped = passed(system_.drive(), t_);
    bool others_jumped = false;
    for_each_track([&](InputTrack& track) {
      if (&track != &system_.drive()) others_jumped = others_jumped || passed(track, t_);
    });
    if constexpr (P > 0) {
      const int delay = system_.delay_direction();
      if (delay >= 0 && drive_jumped && system_.drive().may_jump()) {
        const X before = system_.derivative(x_, t_);
        advance(system_.drive(), t_);
        const X after = system_.derivative(x_, t_);
        const auto column = static_cast<std::size_t>(delay);
        for (std::size_t i = 0; i < N; ++i) {
          const double jump = value_of(before[i]) - value_of(after[i]);
          x_[i].derivative.set(column, x_[i].derivative[column] + jump);
        }
      }
    }
    for_each_track([this](InputTrack& track) { advance(track, t_); });
    if (at(next_tick(), t_)) {
      system_.tick(x_, t_);
      ++ticks_;
      others_jumped = true;
    }
    if (drive_jumped || others_jumped) {
      slope_known_ = false;
      lin_known_ = lin_known_ && !others_jumped && system_.drive_stops_at_valve();
      if (lin_known_) system_.follow_drive(values_of(x_), t_, lin_);
      // The previous jump needed such a short step, so this one will, too. This saves a rejection
      // at each recorded sample.
      h_ = std::min(h_, h_after_jump_);
      after_jump_ = true;
    }
  }

  void advance(InputTrack& track, double t) const {
    while (passed(track, t)) track.next_segment();
  }

  bool passed(const InputTrack& track, double t) const {
    const double end = track.segment_end();
    return end <= t || at(end, t);
  }

  /// Extrapolates the rest of the run from its last two periods.
  [[gnu::cold]] void go_on_as_foreseen() {
    const KnownPeriods known{next_sample_, steady_state_.samples(), steady_state_.sign()};
    const std::size_t to_come = (times_s_.size() - next_sample_ - 1) / known.samples + 1;
    std::vector<double> share(to_come, 0.0);
    std::array<std::vector<double>, static_cast<std::size_t>(P)> slope;
    slope.fill(share);
    for (std::size_t i = 0; i < to_come && !steady_state_.reached(); ++i) {
      const C growth = steady_state_.growth(static_cast<long>(i) + 1);
      share[i] = value_of(growth);
      if constexpr (P > 0) {
        for (std::size_t j = 0; j < P; ++j) slope[j][i] = growth.derivative[j];
      }
    }
    for (std::size_t k = 0; k < outputs_.size(); ++k) {
      const std::span values = column(result_->outputs, static_cast<int>(k));
      // The sensitivities need only the known values, so it does not matter that a later pass finds
      // the values already extrapolated.
      for (int j = 0; j < columns_; ++j) {
        const std::span by = column(result_->sensitivities[k], first_column_ + j);
        continue_periods(known, share, by);
        add_changes(known, slope[static_cast<std::size_t>(j)], values, by);
      }
      if (first_column_ == 0) continue_periods(known, share, values);
    }
    next_sample_ = times_s_.size();
  }

  static std::span<double> column(Eigen::MatrixXd& m, int j) {
    return {m.col(j).data(), static_cast<std::size_t>(m.rows())};
  }

  bool within_budget() {
    const long taken = result_->steps + result_->rejected_steps;
    if (taken >= options_.max_steps) {
      fail(SimulationStatus::too_many_steps,
           fmt::format("not finished after {} steps", options_.max_steps));
      return false;
    }
    if (taken % 256 == 0) {
      if (options_.cancel != nullptr && options_.cancel->load(std::memory_order_relaxed)) {
        fail(SimulationStatus::cancelled, "stopped on request");
        return false;
      }
      const std::chrono::duration<double> used = std::chrono::steady_clock::now() - started_;
      if (used.count() > options_.max_seconds) {
        fail(SimulationStatus::out_of_time,
             fmt::format("not finished after {:g} s of computing time", options_.max_seconds));
        return false;
      }
    }
    return true;
  }

  void fail(SimulationStatus status, std::string reason) {
    result_->status = status;
    result_->failed_at_s = times_s_.front() + t_;
    result_->reason = std::move(reason);
  }

  void store(std::size_t sample, std::size_t output, const C& value) {
    const auto row = static_cast<Eigen::Index>(sample);
    if (first_column_ == 0)
      result_->outputs(row, static_cast<Eigen::Index>(output)) = value_of(value);
    if constexpr (P > 0) {
      Eigen::MatrixXd& sensitivities = result_->sensitivities[output];
      for (int j = 0; j < columns_; ++j) {
        sensitivities(row, first_column_ + j) = value.derivative[static_cast<std::size_t>(j)];
      }
    }
  }

  Sys system_;
  ErrorNorm<N, P> norm_;
  std::span<const double> times_s_;
  std::span<const Output> outputs_;
  const SimulationOptions& options_;
  std::chrono::steady_clock::time_point started_;
  SteadyState<N, P> steady_state_;
  RepeatedSteps steps_;
  std::vector<C> observed_;
  std::vector<std::size_t> observed_states_;  ///< states that the outputs depend on
  bool states_alone_ = true;                  ///< every output is a state
  std::vector<std::size_t> state_of_output_;  ///< index of that state for each output
  Rosenbrock<N, P> rosenbrock_;
  DormandPrince<N, P> dormand_prince_;
  bool implicit_;                ///< whether the method is implicit
  Linearisation<N, P> lin_;      ///< at the present point, if known
  Linearisation<N, P> lin_end_;  ///< at the end of the step just tried
  bool lin_known_ = false;
  X slope_{};  ///< derivative at the present point, for the explicit method, if known
  bool slope_known_ = false;
  Simulation* result_ = nullptr;  ///< owned by the caller; set during one run
  int first_column_ = 0;
  int columns_ = 0;
  double period_s_ = 0.0;  ///< sample time of the controller; infinite for a continuous controller
  long ticks_ = 0;
  double h_max_ = 0.0;
  double t_ = 0.0;
  X x_;
  double h_ = 0.0;  ///< planned step
  double h_after_jump_ = std::numeric_limits<double>::infinity();
  bool after_jump_ = false;
  std::size_t next_sample_ = 0;
  double same_instant_s_ = same_instant_s(times_s_);
};

}  // namespace rigcal::model
