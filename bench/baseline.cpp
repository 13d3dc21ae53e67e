#include "bench/baseline.hpp"

#include <ceres/cost_function.h>
#include <ceres/jet.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <algorithm>
#include <boost/numeric/odeint/algebra/array_algebra.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace rigcal::bench::baseline {
namespace {

using Jet = ceres::Jet<double, kFree>;

/// Position in strokes, velocity in m/s, and load pressure as a fraction of the supply pressure,
/// all of order one.
template <typename T>
using State = std::array<T, 3>;
constexpr double kStroke = 0.0508;
constexpr double kSupply = 6.2e6;

/// The paper's rig with a P controller.
template <typename T>
struct Rig {
  T mass, bulk_modulus, valve_gain, leakage;
  double reference_m = 0.0;
  double amplitude_m = 0.0;
  double omega = 0.0;  ///< angular frequency of a sine; 0 if the reference is a straight line
  double slope = 0.0;  ///< slope of the line that begins at begin_s [m/s]
  double begin_s = 0.0;

  T signed_root(const T& p) const { return p / sqrt(sqrt(p * p + 1e8)); }

  void operator()(const State<T>& x, State<T>& dx, double t) const {
    constexpr double kArea = 1.62e-3;
    constexpr double kVolume = kArea * 0.1524;
    constexpr double kDensity = 847.0;
    const double r =
        omega > 0.0 ? amplitude_m * std::sin(omega * t) : reference_m + slope * (t - begin_s);
    const T position = x[0] * kStroke;
    const T pressure = x[2] * kSupply;
    T u = 400.0 * (r - position);
    if (u > 10.0) u = T(10.0);
    if (u < -10.0) u = T(-10.0);
    const T head = u < 0.0 ? T(kSupply + pressure) : T(kSupply - pressure);
    const T servo = 0.6 * 20.75e-3 / std::sqrt(kDensity) * (valve_gain * u * signed_root(head));
    const T leak = 5e-7 * std::sqrt(2.0 / kDensity) * (leakage * signed_root(pressure));
    dx[0] = x[1] * (1.0 / kStroke);
    dx[1] = (kArea * pressure - 1000.0 * x[1] - 75e3 * position) / mass;
    dx[2] = 4.0 / kVolume / kSupply * (bulk_modulus * (servo - leak - kArea * x[1]));
  }
};

double error_of(double e, double x, double tolerance) {
  return std::abs(e) / (tolerance * (1.0 + std::abs(x)));
}
double error_of(const Jet& e, const Jet& x, double tolerance) {
  double worst = error_of(e.a, x.a, tolerance);
  for (int j = 0; j < kFree; ++j)
    worst = std::max(worst, error_of(e.v[j], x.v[j], 10.0 * tolerance));
  return worst;
}

/// Timing of a drive, which is smooth within each segment.
struct Drive {
  double duration_s = 0.0;
  double segment_s = 0.0;
  double longest_step_s = std::numeric_limits<double>::infinity();
  /// Upper limit for the first step of a segment.
  double first_step_s = std::numeric_limits<double>::infinity();
};

Drive drive_of(const Reference& signal) {
  if (signal.waveform == "sine")
    return {signal.duration_s, signal.duration_s, 1.0 / (8.0 * signal.frequency_hz), 1e-4};
  return {signal.duration_s, 0.5 / signal.frequency_hz, std::numeric_limits<double>::infinity(),
          1e-4};
}
Drive drive_of(const Recorded& recorded) {
  return {static_cast<double>(recorded.reference_m.size() - 1) / 1000.0, 1e-3};
}

template <typename T>
void begin_segment(const Reference& signal, long segment, Rig<T>& rig) {
  rig.amplitude_m = signal.amplitude_m;
  if (signal.waveform == "sine") rig.omega = 2.0 * std::numbers::pi * signal.frequency_hz;
  rig.reference_m = segment % 2 == 0 ? signal.amplitude_m : -signal.amplitude_m;
}
template <typename T>
void begin_segment(const Recorded& recorded, long segment, Rig<T>& rig) {
  const auto k = static_cast<std::size_t>(segment);
  rig.begin_s = static_cast<double>(segment) / 1000.0;
  rig.reference_m = recorded.reference_m[k];
  if (recorded.linear) rig.slope = (recorded.reference_m[k + 1] - recorded.reference_m[k]) * 1000.0;
}

/// Integrates with Dormand-Prince and dense output, restarting at each edge of the reference.
template <typename T, typename Signal, typename Emit>
void integrate(const Signal& signal, const std::array<T, kFree>& factors, double tolerance,
               const Emit& emit) {
  namespace odeint = boost::numeric::odeint;
  const Values true_values = truth();
  Rig<T> rig{factors[0] * true_values[0], factors[1] * true_values[1], factors[2] * true_values[2],
             factors[3] * true_values[3]};
  const Drive drive = drive_of(signal);

  odeint::runge_kutta_dopri5<State<T>, double, State<T>, double, odeint::array_algebra> stepper;
  const auto samples = static_cast<long>(drive.duration_s * 1000.0 + 0.5) + 1;
  State<T> x{T(0.0), T(0.0), T(0.0)};
  State<T> x_new, f, f_new, error, between;
  double t = 0.0;
  double h = 1e-5;
  long next = 0;
  for (long segment = 0; next < samples; ++segment) {
    begin_segment(signal, segment, rig);
    const double stop =
        std::min(drive.duration_s, drive.segment_s * static_cast<double>(segment + 1));
    h = std::min(h, drive.first_step_s);
    rig(x, f, t);
    while (t < stop) {
      const double step = std::min({h, drive.longest_step_s, stop - t});
      const bool cut_short = step == stop - t;
      const double t_new = cut_short ? stop : t + step;
      stepper.do_step(rig, x, f, t, x_new, f_new, step, error);
      double worst = 0.0;
      for (std::size_t i = 0; i < 3; ++i)
        worst = std::max(worst, error_of(error[i], x_new[i], tolerance));
      const double after =
          step * std::clamp(0.9 * std::pow(std::max(worst, 1e-10), -0.2), 0.2, 5.0);
      h = cut_short && worst <= 1.0 ? std::max(h, after) : after;
      if (!(worst <= 1.0)) continue;
      for (; next < samples && static_cast<double>(next) / 1000.0 <= t_new; ++next) {
        stepper.calc_state(static_cast<double>(next) / 1000.0, between, x, f, t, x_new, f_new,
                           t_new);
        emit(next, between[0] * kStroke);
      }
      x = x_new;
      f = f_new;
      t = t_new;
    }
    if (stop >= drive.duration_s) break;
  }
}

template <typename Signal>
std::vector<double> positions(const Signal& signal, const Values& factors, double tolerance) {
  std::vector<double> result(static_cast<std::size_t>(drive_of(signal).duration_s * 1000.0 + 1.5));
  integrate<double>(signal, factors, tolerance,
                    [&](long i, double x) { result[static_cast<std::size_t>(i)] = x; });
  return result;
}

template <typename Signal>
std::vector<double> rows_of(const Signal& signal, const Values& factors, double tolerance) {
  const auto samples = static_cast<std::size_t>(drive_of(signal).duration_s * 1000.0 + 1.5);
  std::vector<double> rows(samples * (1 + kFree));
  std::array<Jet, kFree> jets;
  for (int j = 0; j < kFree; ++j)
    jets[static_cast<std::size_t>(j)] = Jet(factors[static_cast<std::size_t>(j)], j);
  integrate<Jet>(signal, jets, tolerance, [&](long i, const Jet& x) {
    double* row = rows.data() + i * (1 + kFree);
    row[0] = x.a;
    for (int j = 0; j < kFree; ++j) row[1 + j] = x.v[j];
  });
  return rows;
}

template <typename Signal>
class Residuals final : public ceres::CostFunction {
 public:
  Residuals(const Signal& signal, const std::vector<double>& measured, double sd, double tolerance,
            Fit& counts)
      : signal_(signal), measured_(measured), sd_(sd), tolerance_(tolerance), counts_(counts) {
    mutable_parameter_block_sizes()->push_back(kFree);
    set_num_residuals(static_cast<int>(measured.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    if (jacobians == nullptr || jacobians[0] == nullptr) {
      ++counts_.residuals;
      Values factors;
      for (std::size_t j = 0; j < kFree; ++j) factors[j] = std::exp(parameters[0][j]);
      integrate<double>(signal_, factors, tolerance_, [&](long i, double x) {
        residuals[i] = (x - measured_[static_cast<std::size_t>(i)]) / sd_;
      });
      return true;
    }
    ++counts_.jacobians;
    std::array<Jet, kFree> factors;
    for (int j = 0; j < kFree; ++j)
      factors[static_cast<std::size_t>(j)] = exp(Jet(parameters[0][j], j));
    integrate<Jet>(signal_, factors, tolerance_, [&](long i, const Jet& x) {
      residuals[i] = (x.a - measured_[static_cast<std::size_t>(i)]) / sd_;
      for (int j = 0; j < kFree; ++j) jacobians[0][i * kFree + j] = x.v[j] / sd_;
    });
    return true;
  }

 private:
  const Signal& signal_;
  const std::vector<double>& measured_;
  double sd_;
  double tolerance_;
  Fit& counts_;
};

template <typename Signal>
Fit fit_of(const std::vector<Signal>& signals, const std::vector<std::vector<double>>& measured,
           double noise_sd_m, double tolerance) {
  Fit result;
  Values z{std::log(0.6), std::log(1.5), std::log(0.7), std::log(2.0)};
  ceres::Problem problem;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    problem.AddResidualBlock(
        new Residuals<Signal>(signals[i], measured[i], noise_sd_m, tolerance, result), nullptr,
        z.data());
  }
  for (int j = 0; j < kFree; ++j) {
    problem.SetParameterLowerBound(z.data(), j, -std::log(5.0));
    problem.SetParameterUpperBound(z.data(), j, std::log(5.0));
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = 200;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t j = 0; j < kFree; ++j) result.factors[j] = std::exp(z[j]);
  result.cost = summary.final_cost;
  result.converged = summary.termination_type == ceres::CONVERGENCE;
  return result;
}

}  // namespace

Values truth() { return {85.0, 689e6, 4.06e-5, 0.35}; }

std::vector<double> simulate(const Reference& signal, const Values& factors, double tolerance) {
  return positions(signal, factors, tolerance);
}
std::vector<double> simulate(const Recorded& drive, const Values& factors, double tolerance) {
  return positions(drive, factors, tolerance);
}

std::vector<double> simulate_with_sensitivities(const Reference& signal, const Values& factors,
                                                double tolerance) {
  return rows_of(signal, factors, tolerance);
}
std::vector<double> simulate_with_sensitivities(const Recorded& drive, const Values& factors,
                                                double tolerance) {
  return rows_of(drive, factors, tolerance);
}

Fit fit(const std::vector<std::vector<double>>& measured, double noise_sd_m, double tolerance) {
  return fit_of(kSixSignals, measured, noise_sd_m, tolerance);
}
Fit fit(const std::vector<Recorded>& drives, const std::vector<std::vector<double>>& measured,
        double noise_sd_m, double tolerance) {
  return fit_of(drives, measured, noise_sd_m, tolerance);
}

}  // namespace rigcal::bench::baseline
