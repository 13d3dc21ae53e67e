#include "calib/posterior/nuts.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "datasets/synthetic/noise.hpp"

namespace rigcal::calib {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// An energy error above this value counts as a divergence.
constexpr double kDivergence = 1000.0;
/// Ends of the warm-up windows, as fractions of the warm-up draws. The first window adapts only the
/// step, the next two also estimate the covariance, and the last one adapts the step to the final
/// covariance.
constexpr double kFirstWindow = 0.15;
constexpr double kSecondWindow = 0.45;
constexpr double kLastWindow = 0.85;
/// In the first window, the step search is drawn towards this multiple of the first step, because
/// trying long steps is cheap.
constexpr double kHopeful = 10.0;
/// The previous covariance counts as this many draws.
constexpr double kPriorDraws = 10.0;
constexpr int kMostHalvings = 50;

double log_sum(double a, double b) {
  const double larger = std::max(a, b);
  if (larger == -HUGE_VAL) return larger;
  return larger + std::log(std::exp(a - larger) + std::exp(b - larger));
}

/// A point in phase space, in coordinates in which the mass is one.
struct Phase {
  VectorXd x, momentum, gradient;
  double log_density = -HUGE_VAL;

  double energy() const { return 0.5 * momentum.squaredNorm() - log_density; }
};

/// The density in coordinates x, with position = L x, where L L^T is the inverse mass matrix.
class Whitened {
 public:
  Whitened(const LogDensityOf& density, const MatrixXd& covariance) : density_(density) {
    const Eigen::LLT<MatrixXd> factor(covariance);
    if (factor.info() != Eigen::Success)
      throw std::invalid_argument("nuts: the covariance is not positive definite");
    lower_ = factor.matrixL();
  }

  VectorXd position(const VectorXd& x) const { return lower_ * x; }
  VectorXd coordinates(const VectorXd& position) const {
    return lower_.triangularView<Eigen::Lower>().solve(position);
  }
  void evaluate(Phase& phase) const {
    LogDensity found = density_(position(phase.x));
    phase.log_density = std::isfinite(found.value) ? found.value : -HUGE_VAL;
    if (phase.log_density == -HUGE_VAL) {
      phase.gradient = VectorXd::Zero(phase.x.size());
    } else {
      phase.gradient = lower_.transpose() * found.gradient;
    }
  }
  Phase leap(const Phase& from, double step) const {
    Phase next;
    next.momentum = from.momentum + 0.5 * step * from.gradient;
    next.x = from.x + step * next.momentum;
    evaluate(next);
    next.momentum += 0.5 * step * next.gradient;
    return next;
  }

 private:
  const LogDensityOf& density_;
  MatrixXd lower_;
};

/// A section of a trajectory: its first and last momentum in the order in which they were
/// generated, the sum of all momenta, and one point drawn according to its weight.
struct Stretch {
  VectorXd first, last, sum;
  Phase drawn;
  double log_weight = -HUGE_VAL;
};

bool goes_on(const VectorXd& first, const VectorXd& last, const VectorXd& sum) {
  return first.dot(sum) > 0.0 && last.dot(sum) > 0.0;
}

/// Returns true if two adjacent sections make no U-turn, either over their whole length or from one
/// section to the nearest point of the other.
bool go_on(const Stretch& a, const Stretch& b) {
  const VectorXd sum = a.sum + b.sum;
  return goes_on(a.first, b.last, sum) && goes_on(a.first, b.first, a.sum + b.first) &&
         goes_on(a.last, b.last, b.sum + a.last);
}

/// Extends one trajectory.
class Trajectory {
 public:
  Trajectory(const Whitened& density, double step, const Phase& begin,
             datasets::RandomStream& stream)
      : density_(density), step_(step), energy_(begin.energy()), stream_(stream) {}

  /// Appends 2^doublings points after `end`, which is updated.
  ///
  /// @return  false if the trajectory turned back or diverged
  bool grow(int doublings, double direction, Phase& end, Stretch& grown) {
    if (doublings == 0) {
      end = density_.leap(end, direction * step_);
      const double error = end.energy() - energy_;
      diverged_ = diverged_ || !(error <= kDivergence);
      const double rise = std::isnan(error) ? HUGE_VAL : error;
      acceptance_ += std::min(1.0, std::exp(-rise));
      ++points_;
      grown = {end.momentum, end.momentum, end.momentum, end, -rise};
      return !diverged_;
    }
    Stretch near;
    Stretch far;
    if (!grow(doublings - 1, direction, end, near)) return false;
    if (!grow(doublings - 1, direction, end, far)) return false;
    const bool straight = go_on(near, far);
    grown.log_weight = log_sum(near.log_weight, far.log_weight);
    const bool take_far = chance() < std::exp(far.log_weight - grown.log_weight);
    grown.drawn = std::move(take_far ? far.drawn : near.drawn);
    grown.sum = near.sum + far.sum;
    grown.first = std::move(near.first);
    grown.last = std::move(far.last);
    return straight;
  }

  double chance() { return datasets::uniform(stream_, 0.0, 1.0); }
  bool diverged() const { return diverged_; }
  double acceptance() const { return points_ > 0 ? acceptance_ / points_ : 0.0; }

 private:
  const Whitened& density_;
  double step_;
  double energy_;
  datasets::RandomStream& stream_;
  bool diverged_ = false;
  double acceptance_ = 0.0;
  int points_ = 0;
};

/// Converts a section that was generated backwards to chronological order.
Stretch forwards(const Stretch& stretch) {
  return {stretch.last, stretch.first, stretch.sum, {}, stretch.log_weight};
}

/// Makes one draw, starting from `at`, which is updated.
Draw draw_from(const Whitened& density, double step, int most_doublings,
               datasets::RandomStream& stream, Phase& at) {
  for (double& each : at.momentum) each = datasets::normal(stream, 1.0);
  Draw draw;
  draw.energy = at.energy();
  Trajectory trajectory(density, step, at, stream);
  Phase front = at;
  Phase back = at;
  Stretch whole{at.momentum, at.momentum, at.momentum, at, 0.0};
  while (draw.doublings < most_doublings) {
    const bool ahead = trajectory.chance() < 0.5;
    Stretch grown;
    if (!trajectory.grow(draw.doublings, ahead ? 1.0 : -1.0, ahead ? front : back, grown)) break;
    ++draw.doublings;
    // The new section is favoured, because a draw far from the previous one is worth more.
    if (trajectory.chance() < std::exp(grown.log_weight - whole.log_weight))
      whole.drawn = std::move(grown.drawn);
    const Stretch added = ahead ? std::move(grown) : forwards(grown);
    const bool straight = ahead ? go_on(whole, added) : go_on(added, whole);
    whole.log_weight = log_sum(whole.log_weight, added.log_weight);
    whole.sum += added.sum;
    (ahead ? whole.last : whole.first) = ahead ? added.last : added.first;
    if (!straight) break;
  }
  at = std::move(whole.drawn);
  draw.position = density.position(at.x);
  draw.acceptance = trajectory.acceptance();
  draw.diverged = trajectory.diverged();
  return draw;
}

datasets::RandomStream stream_of(const NutsOptions& options, long iteration) {
  return datasets::random_stream(options.seed, {"posterior", fmt::format("chain {}", options.chain),
                                                fmt::format("draw {}", iteration)});
}

Phase phase_at(const Whitened& density, VectorXd x) {
  Phase phase;
  phase.x = std::move(x);
  phase.momentum = VectorXd::Zero(phase.x.size());
  density.evaluate(phase);
  return phase;
}

/// Finds a step with which the first leap is accepted with about the target probability.
double first_step(const Whitened& density, const NutsOptions& options, long iteration, Phase at) {
  auto stream = stream_of(options, iteration);
  for (double& each : at.momentum) each = datasets::normal(stream, 1.0);
  const auto kept = [&](double step) {
    const double rise = density.leap(at, step).energy() - at.energy();
    return !std::isnan(rise) && std::exp(-rise) > options.target_acceptance;
  };
  double step = 1.0;
  const bool longer = kept(step);
  for (int i = 0; i < kMostHalvings; ++i) {
    const double next = longer ? 2.0 * step : 0.5 * step;
    if (kept(next) != longer) return longer ? step : next;
    step = next;
  }
  return step;
}

/// Nesterov's dual averaging of the logarithm of the step (Hoffman and Gelman 2014, 3.2).
class StepSearch {
 public:
  /// @param first   initial step
  /// @param centre  step that the search is drawn towards
  StepSearch(double first, double centre, double target)
      : target_(target),
        centre_(std::log(centre)),
        log_step_(std::log(first)),
        log_mean_(std::log(first)) {}

  void learn(double acceptance) {
    // Six times the value used by Hoffman and Gelman. With a smaller value the steps vary so much
    // that their mean is too short by a third.
    constexpr double kGamma = 0.3;
    constexpr double kDelay = 10.0;
    constexpr double kForgetting = 0.75;
    ++count_;
    const double share = 1.0 / (count_ + kDelay);
    error_ = (1.0 - share) * error_ + share * (target_ - acceptance);
    log_step_ = centre_ - error_ * std::sqrt(count_) / kGamma;
    const double weight = std::pow(count_, -kForgetting);
    log_mean_ = weight * log_step_ + (1.0 - weight) * log_mean_;
  }
  double step() const { return std::exp(log_step_); }
  double mean() const { return std::exp(log_mean_); }

 private:
  double target_;
  double centre_;
  double count_ = 0.0;
  double error_ = 0.0;
  double log_step_;
  double log_mean_;
};

MatrixXd shrunk_covariance(const std::vector<VectorXd>& draws, const MatrixXd& before) {
  const auto count = static_cast<double>(draws.size());
  if (count < 2.0) return before;
  VectorXd mean = VectorXd::Zero(before.rows());
  for (const VectorXd& each : draws) mean += each / count;
  MatrixXd squares = MatrixXd::Zero(before.rows(), before.cols());
  for (const VectorXd& each : draws) squares += (each - mean) * (each - mean).transpose();
  return (count / (count - 1.0) * squares + kPriorDraws * before) / (count + kPriorDraws);
}

}  // namespace

bool warm_up(const LogDensityOf& density, int draws, const NutsOptions& options,
             ChainState& state) {
  const auto at = [&](double share) { return static_cast<int>(share * draws); };
  const int ends[] = {at(kFirstWindow), at(kSecondWindow), at(kLastWindow), draws};
  int done = 0;
  for (int window = 0; window < 4; ++window) {
    const Whitened whitened(density, state.covariance);
    Phase phase = phase_at(whitened, whitened.coordinates(state.position));
    if (options.stop && options.stop()) return false;  // the last density may be wrong
    if (phase.log_density == -HUGE_VAL)
      throw std::invalid_argument("nuts: the density is zero where the chain begins");
    // Long steps are tried first. For later windows the step is already known, because it hardly
    // changes in coordinates of the covariance. A search that was drawn away from it would end with
    // too short a step.
    const double first =
        window == 0 ? first_step(whitened, options, state.iteration, phase) : state.step;
    StepSearch search(first, window == 0 ? kHopeful * first : first, options.target_acceptance);
    std::vector<VectorXd> window_draws;
    for (; done < ends[window]; ++done) {
      auto stream = stream_of(options, ++state.iteration);
      const Draw draw = draw_from(whitened, search.step(), options.most_doublings, stream, phase);
      search.learn(draw.acceptance);
      state.position = draw.position;
      if (window == 1 || window == 2) window_draws.push_back(draw.position);
      if (options.stop && options.stop()) return false;
    }
    state.step = search.mean();
    state.covariance = shrunk_covariance(window_draws, state.covariance);
  }
  return true;
}

std::vector<Draw> sample(const LogDensityOf& density, int count, const NutsOptions& options,
                         ChainState& state) {
  const Whitened whitened(density, state.covariance);
  std::vector<Draw> draws;
  if (state.whitened.size() == 0) state.whitened = whitened.coordinates(state.position);
  Phase phase = phase_at(whitened, state.whitened);
  for (int i = 0; i < count; ++i) {
    auto stream = stream_of(options, ++state.iteration);
    Draw draw = draw_from(whitened, state.step, options.most_doublings, stream, phase);
    if (options.stop && options.stop()) return draws;
    state.position = draw.position;
    state.whitened = phase.x;
    draws.push_back(std::move(draw));
  }
  return draws;
}

}  // namespace rigcal::calib
