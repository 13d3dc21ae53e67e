#include "calib/symmetry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "common/parallel.hpp"

namespace rigcal::calib {
namespace {

constexpr double kScaleKnown = 0.1;
constexpr std::string_view kSmoothing = "leakage_smoothing";
constexpr std::string_view kSupply = "supply_pressure";

struct Exponent {
  std::string_view key;
  double exponent;
};

/// m x'' = A P - b x' - k x - friction; P' = (4 beta / V) (Q - A x'); Q = k_sv u C w sqrt(P / rho).
constexpr std::array kExponents{
    Exponent{"mass", 1.0},
    Exponent{"damping", 1.0},
    Exponent{"stiffness", 1.0},
    Exponent{"bulk_modulus", 1.0},
    Exponent{kSupply, 1.0},
    Exponent{"tank_pressure", 1.0},
    Exponent{"coulomb_friction", 1.0},
    Exponent{"stribeck_friction", 1.0},
    Exponent{"external_force", 1.0},
    Exponent{"initial_load_pressure", 1.0},
    Exponent{"initial_pressure_a", 1.0},
    Exponent{"initial_pressure_b", 1.0},
    Exponent{"valve_gain", -0.5},
    Exponent{"leakage_coefficient", -0.5},
    Exponent{"laminar_leakage", -1.0},
    Exponent{"valve_null_leakage", -1.0},
};

bool positions_alone(const Problem& problem) {
  for (const ProblemCondition& condition : problem.conditions) {
    for (const ProblemChannel& channel : condition.channels) {
      if (channel.channel != datasets::Channel::position) return false;
    }
  }
  return true;
}

std::vector<std::string> known_and_scaled(const Problem& problem) {
  const auto table = model::parameter_table(problem.campaign->rig.plant);
  std::set<std::size_t> rows;
  for (const ProblemCondition& condition : problem.conditions) {
    for (std::size_t row = 0; row < table.size(); ++row) {
      const bool acts = condition.values.given[row] && condition.values.value[row] != 0.0;
      const bool free = std::find(condition.free.begin(), condition.free.end(),
                                  static_cast<int>(row)) != condition.free.end();
      if (acts && !free && scaling_exponent(table[row].key) != 0.0) rows.insert(row);
    }
  }
  std::vector<std::string> names;
  for (const std::size_t row : rows) names.emplace_back(table[row].name);
  return names;
}

/// Outputs of one condition, shape (samples that count, channels); empty where it cannot be
/// simulated.
Eigen::MatrixXd outputs_at(const Problem& problem, const ProblemCondition& condition,
                           const model::ParameterValues& values) {
  model::SimulationOptions options;
  options.method = problem.campaign->simulation.method;
  options.tolerance = problem.tolerance;
  options.max_seconds = problem.campaign->simulation.max_seconds;
  const auto run = model::simulate(condition.rig, values, {}, condition.inputs,
                                   condition.fit_times(), condition.outputs, options);
  if (!run.ok()) return {};
  return run.outputs(condition.rows, Eigen::all);
}

/// Change of the weighted residuals, priors included, per ln s where unknowns and smoothing are
/// scaled; measured by scaling them, because the model has no derivative to the smoothing.
double felt_when_scaled(const Problem& problem, std::span<const double> z,
                        const std::vector<std::size_t>& unknowns, int threads) {
  constexpr double kScale = 1.5;  // far enough for the tolerance of the simulations not to count
  const int smoothing = model::parameter_index(problem.campaign->rig.plant, kSmoothing);
  std::vector<double> scaled(z.size());
  for (std::size_t j = 0; j < z.size(); ++j)
    scaled[j] = problem.map.to_physical(static_cast<int>(j), z[j]);
  double sum = 0.0;
  for (const std::size_t j : unknowns) {
    const double value = scaled[j];
    scaled[j] *= std::pow(kScale, scaling_exponent(problem.spec(j).key));
    const auto& prior = problem.map.unknowns()[j].prior;
    if (prior) sum += std::pow((scaled[j] - value) / prior->sd, 2);
  }
  std::vector<double> squares(problem.conditions.size(), 0.0);
  parallel_for(squares.size(), threads, [&](std::size_t i) {
    const ProblemCondition& condition = problem.conditions[i];
    const model::ParameterValues here = problem.values_at(i, z);
    model::ParameterValues there = here;
    for (const int j : problem.map.acting(i)) {
      const auto u = static_cast<std::size_t>(j);
      there.set(problem.map.unknowns()[u].index, scaled[u]);
    }
    there.set(smoothing, kScale * here.value[static_cast<std::size_t>(smoothing)]);
    const Eigen::MatrixXd before = outputs_at(problem, condition, here);
    const Eigen::MatrixXd after = outputs_at(problem, condition, there);
    if (before.size() == 0 || after.size() == 0) return;
    for (std::size_t k = 0; k < condition.channels.size(); ++k) {
      const auto column = static_cast<Eigen::Index>(k);
      squares[i] += (after.col(column) - before.col(column)).squaredNorm() /
                    std::pow(condition.channels[k].sd, 2);
    }
  });
  for (const double each : squares) sum += each;
  return std::sqrt(sum) / std::log(kScale);
}

bool takes_part(const Problem& problem, const ScalingSymmetry& symmetry, std::string_view key) {
  return std::any_of(symmetry.unknowns.begin(), symmetry.unknowns.end(),
                     [&](std::size_t j) { return problem.spec(j).key == key; });
}

}  // namespace

double scaling_exponent(std::string_view key) {
  const auto found = std::find_if(kExponents.begin(), kExponents.end(),
                                  [key](const Exponent& each) { return each.key == key; });
  return found == kExponents.end() ? 0.0 : found->exponent;
}

bool ScalingSymmetry::holds() const { return relative_sd > kScaleKnown; }

std::optional<ScalingSymmetry> scaling_symmetry(const Problem& problem, std::span<const double> z,
                                                const Eigen::MatrixXd& jacobian, double sigma,
                                                int threads) {
  if (!positions_alone(problem)) return std::nullopt;
  ScalingSymmetry result;
  Eigen::VectorXd direction = Eigen::VectorXd::Zero(jacobian.cols());
  for (std::size_t j = 0; j < z.size(); ++j) {
    const int unknown = static_cast<int>(j);
    const double exponent = scaling_exponent(problem.spec(j).key);
    const double value = problem.map.to_physical(unknown, z[j]);
    if (exponent == 0.0 || value == 0.0) continue;
    direction(unknown) = exponent * value / problem.map.slope(unknown, z[j]);
    result.unknowns.push_back(j);
  }
  if (result.unknowns.size() < 2) return std::nullopt;
  result.known = known_and_scaled(problem);
  // A known supply pressure tells s by itself: there is no need to look at the smoothing.
  const double felt = takes_part(problem, result, kSupply)
                          ? felt_when_scaled(problem, z, result.unknowns, threads)
                          : (jacobian * direction).norm();
  result.relative_sd = felt > 0.0 ? sigma / felt : std::numeric_limits<double>::infinity();
  return result;
}

std::string describe(const Problem& problem, const ScalingSymmetry& symmetry) {
  std::vector<std::string> grow;
  std::vector<std::string> fall;
  for (const std::size_t j : symmetry.unknowns)
    (scaling_exponent(problem.spec(j).key) > 0.0 ? grow : fall).push_back(problem.name(j));
  const bool pressure_free = takes_part(problem, symmetry, kSupply) && grow.size() > 1;
  if (!symmetry.holds() && !(pressure_free && !symmetry.known.empty())) return {};
  std::string text =
      fmt::format("scaling symmetry: positions stay as they are where {} {} by a factor s{}",
                  fmt::join(grow, ", "), grow.size() == 1 ? "grows" : "grow",
                  fall.empty() ? ""
                               : fmt::format(" and {} {} by its square root", fmt::join(fall, ", "),
                                             fall.size() == 1 ? "falls" : "fall"));
  if (symmetry.holds()) {
    return text +
           "; one of them must be known (mass or supply pressure, say), or a pressure or force "
           "recorded";
  }
  return text + fmt::format("; only the known {} {} s: an error of 1 % there is one of 1 % here",
                            fmt::join(symmetry.known, ", "),
                            symmetry.known.size() == 1 ? "tells" : "tell");
}

void grade_symmetric(const ScalingSymmetry& symmetry, std::vector<FittedParameter>& parameters) {
  if (!symmetry.holds()) return;
  for (const std::size_t j : symmetry.unknowns) {
    FittedParameter& each = parameters[j];
    if (each.nuisance) continue;
    each.identifiability = Identifiability::not_identifiable;
    // What was said of an interval goes with it.
    const std::string known = each.standard_error || each.reason.empty() ? "" : "; " + each.reason;
    each.standard_error.reset();
    each.robust_standard_error.reset();
    each.ci95.reset();
    each.interval = IntervalSource::none;
    each.reason = fmt::format("left open by the scaling symmetry: {}, would tell it{}",
                              kSymmetryRemedy, known);
  }
}

}  // namespace rigcal::calib
