#include "calib/trust/information.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/problem/r_factor.hpp"
#include "calib/problem/scaled_svd.hpp"
#include "calib/search/optimum.hpp"
#include "common/readable.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

/// As in uncertainty(), a parameter is undetermined if its component in an undetermined direction
/// exceeds this value.
constexpr double kLost = 0.1;
constexpr double kTriedPrior = 0.05;      // relative standard deviation of the prior that is tried
constexpr double kPressureNoise = 0.003;  // fraction of the supply pressure (simple sensor)
/// Length of the record that is tried: half a period of the slowest signal, sampled at 1 kHz or
/// less.
constexpr double kTriedSeconds = 5.0;
constexpr std::size_t kMostSamples = 5000;
/// Maximum number of priors to suggest. The reader needs only one, and more would make the sentence
/// long.
constexpr std::size_t kMostPriors = 2;

bool tells(const Problem& problem, std::span<const double> z, const Eigen::MatrixXd& jacobian,
           std::size_t target) {
  const auto sd = cramer_rao(problem, z, jacobian)[target];
  const double value = problem.map.to_physical(static_cast<int>(target), z[target]);
  return relative_half_width(sd, value).value_or(2.0 * kWeak) < kWeak;
}

Eigen::MatrixXd above(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(a.rows() + b.rows(), a.cols());
  both << a, b;
  return both;
}

/// Returns the weighted sensitivities of one output in a condition; empty if it cannot be
/// simulated.
Eigen::MatrixXd tried_rows(const Problem& problem, std::size_t i, std::span<const double> z,
                           const model::SimulationInputs& inputs, std::span<const double> time_s,
                           model::Output output, double sd) {
  const ProblemCondition& condition = problem.conditions[i];
  const std::vector<model::Output> outputs{output};
  const auto run = model::simulate(condition.rig, problem.values_at(i, z), condition.free, inputs,
                                   time_s, outputs, problem.simulation_options());
  if (!run.ok()) return {};
  const std::vector<int>& acting = problem.map.acting(i);
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(time_s.size()),
                                               static_cast<Eigen::Index>(z.size()));
  for (std::size_t j = 0; j < acting.size(); ++j) {
    const double slope = problem.map.slope(acting[j], z[static_cast<std::size_t>(acting[j])]);
    rows.col(acting[j]) =
        run.sensitivities[0].col(static_cast<Eigen::Index>(j)).head(rows.rows()) * slope / sd;
  }
  return rows;
}

Eigen::MatrixXd as_triangle(const Eigen::MatrixXd& rows) {
  RFactor r_factor(rows.cols());
  r_factor.add(rows);
  return r_factor.get();
}

void try_priors(const Problem& problem, std::span<const double> z, const Eigen::MatrixXd& jacobian,
                std::size_t target, std::vector<std::string>& words) {
  for (std::size_t j = 0; j < z.size() && words.size() < kMostPriors; ++j) {
    const Unknown& unknown = problem.map.unknowns()[j];
    const double value = problem.map.to_physical(static_cast<int>(j), z[j]);
    if (unknown.nuisance || unknown.prior || j == target || value == 0.0) continue;
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, jacobian.cols());
    row(0, static_cast<Eigen::Index>(j)) =
        problem.map.slope(static_cast<int>(j), z[j]) / (kTriedPrior * std::abs(value));
    if (tells(problem, z, above(jacobian, row), target))
      words.push_back(fmt::format("a prior on {} ({:g} %)", problem.name(j), 100.0 * kTriedPrior));
  }
}

void try_pressure(const Problem& problem, std::span<const double> z,
                  const Eigen::MatrixXd& jacobian, std::size_t target,
                  std::vector<std::string>& words) {
  Eigen::MatrixXd total = jacobian;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    const ProblemCondition& condition = problem.conditions[i];
    const bool recorded =
        std::any_of(condition.channels.begin(), condition.channels.end(),
                    [](const auto& each) { return each.channel != datasets::Channel::position; });
    if (recorded) return;
    const double sd = kPressureNoise * problem.values_at(i, z)["supply_pressure"];
    const Eigen::MatrixXd rows = tried_rows(problem, i, z, condition.inputs, condition.fit_times(),
                                            model::Output::load_pressure, sd);
    if (rows.size() > 0) total = above(total, as_triangle(rows));
  }
  if (tells(problem, z, total, target)) words.emplace_back("a recorded load pressure");
}

void try_signals(const Problem& problem, std::span<const double> z, const Eigen::MatrixXd& jacobian,
                 std::size_t target, std::vector<std::string>& words) {
  // The record that is tried is like that of the condition in which the most unknowns act, but with
  // another signal.
  std::size_t like = 0;
  for (std::size_t i = 0; i < problem.conditions.size(); ++i) {
    if (problem.map.acting(i).size() > problem.map.acting(like).size()) like = i;
  }
  const ProblemCondition& condition = problem.conditions[like];
  const datasets::Condition& c = *condition.condition;
  const auto& time_s = condition.record->time_s;
  if (!c.amplitude || !c.frequency_hz || time_s.size() < 2) return;
  const double step_s = (time_s.back() - time_s.front()) / static_cast<double>(time_s.size() - 1);
  std::vector<double> times;
  while (times.size() < kMostSamples && step_s * static_cast<double>(times.size()) <= kTriedSeconds)
    times.push_back(step_s * static_cast<double>(times.size()));
  const ProblemChannel& channel = condition.channels.front();
  for (const double frequency_hz : {0.1, 1.0, 10.0}) {
    // The amplitude keeps the speed below the largest one observed.
    const double amplitude = *c.amplitude * std::min(1.0, *c.frequency_hz / frequency_hz);
    for (const bool square : {false, true}) {
      model::SimulationInputs inputs = condition.inputs;
      inputs.drive = square ? model::Signal::square(amplitude, frequency_hz)
                            : model::Signal::sine(amplitude, frequency_hz);
      const Eigen::MatrixXd rows =
          tried_rows(problem, like, z, inputs, times, condition.outputs.front(), channel.sd);
      if (rows.size() == 0 || !tells(problem, z, above(jacobian, as_triangle(rows)), target))
        continue;
      words.push_back(fmt::format(
          "a {} of {:g} Hz (amplitude {}, {})", square ? "square wave" : "sine", frequency_hz,
          readable(amplitude, info(drive_channel(*problem.campaign)).unit, 3),
          readable(times.back(), "s", 3)));
      return;
    }
  }
}

}  // namespace

std::vector<std::optional<double>> cramer_rao(const Problem& problem, std::span<const double> z,
                                              const Eigen::MatrixXd& jacobian) {
  const Eigen::Index n = jacobian.cols();
  std::vector<std::optional<double>> result(static_cast<std::size_t>(n));
  const ScaledSvd svd(jacobian, rank_threshold(problem.tolerance));
  const Eigen::MatrixXd root = svd.root();
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto undetermined = svd.V().row(j).tail(n - svd.rank());
    const bool lost = undetermined.size() > 0 && undetermined.cwiseAbs().maxCoeff() > kLost;
    if (lost || svd.inverse_lengths()(j) == 0.0) continue;
    const auto u = static_cast<std::size_t>(j);
    result[u] = problem.map.slope(static_cast<int>(j), z[u]) * root.row(j).norm();
  }
  return result;
}

std::vector<double> point_at(const Problem& problem,
                             const std::vector<datasets::FittedValue>* values) {
  std::vector<double> z = problem.start();
  if (values == nullptr) return z;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const Unknown& unknown = problem.map.unknowns()[j];
    for (const auto& value : *values) {
      if (value.index == unknown.index && value.level == unknown.level)
        z[j] = problem.map.to_unit(static_cast<int>(j), value.value);
    }
  }
  return z;
}

std::string TestedParameter::label() const {
  return level ? fmt::format("{} ({})", name, *level) : name;
}

TestedParameter parameter_at(const Problem& problem, std::span<const double> z,
                             std::size_t unknown) {
  const Unknown& from = problem.map.unknowns()[unknown];
  const model::ParameterSpec& spec = problem.spec(unknown);
  return {std::string(spec.name), std::string(spec.unit), from.scope, unless_empty(from.level),
          problem.map.to_physical(static_cast<int>(unknown), z[unknown])};
}

Eigen::MatrixXd weighted_jacobian(const Problem& problem, const Evaluation& at,
                                  const std::vector<double>& weights) {
  const auto n = static_cast<Eigen::Index>(at.z.size());
  RFactor total(n);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (weights[i] == 0.0 || !at.conditions[i].ok()) continue;
    const Eigen::MatrixXd part = std::sqrt(weights[i]) * at.conditions[i].r_factor;
    const std::vector<int>& acting = problem.map.acting(i);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(part.rows(), n);
    for (std::size_t j = 0; j < acting.size(); ++j)
      rows.col(acting[j]) = part.col(static_cast<Eigen::Index>(j));
    total.add(rows);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    const double slope =
        problem.map.prior_slope(static_cast<int>(j), at.z[static_cast<std::size_t>(j)]);
    if (slope == 0.0) continue;
    Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, n);
    row(0, j) = slope;
    total.add(row);
  }
  return total.get();
}

std::optional<double> relative_half_width(const std::optional<double>& sd, double value) {
  if (!sd || value == 0.0) return std::nullopt;
  return metrics::kNormal95 * *sd / std::abs(value);
}

std::vector<std::string> remedies(const Problem& problem, std::span<const double> z,
                                  const Eigen::MatrixXd& jacobian, std::size_t target) {
  std::vector<std::string> words;
  try_priors(problem, z, jacobian, target, words);
  try_pressure(problem, z, jacobian, target, words);
  try_signals(problem, z, jacobian, target, words);
  return words;
}

}  // namespace rigcal::calib
