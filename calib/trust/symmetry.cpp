#include "calib/trust/symmetry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "calib/trust/unit_product.hpp"
#include "common/parallel.hpp"
#include "common/significant.hpp"

namespace rigcal::calib {
namespace {

/// Relative standard error above which the common scale counts as weak (kWeak for the 95 %
/// interval).
constexpr double kScaleKnown = 0.1;
constexpr std::string_view kSmoothing = "leakage_smoothing";  // no physical meaning, so no exponent
constexpr std::string_view kSupply = "supply_pressure";

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
      if (acts && !free && scaling_exponent(table[row]) != 0.0) rows.insert(row);
    }
  }
  std::vector<std::string> names;
  for (const std::size_t row : rows) names.emplace_back(table[row].name);
  // A gas relates pressures to the atmospheric pressure, which cannot be scaled.
  for (const char* key : {"air_fraction", "accumulator_volume"}) {
    const int gas = model::parameter_index(problem.campaign->rig.plant, key);
    const bool holds_gas =
        gas >= 0 &&
        std::any_of(problem.conditions.begin(), problem.conditions.end(),
                    [gas](const ProblemCondition& condition) {
                      return condition.values.value[static_cast<std::size_t>(gas)] != 0.0;
                    });
    if (holds_gas) names.push_back(fmt::format("pressure of the atmosphere ({})", key));
  }
  return names;
}

/// Returns the outputs of one condition, shape (scored samples, channels); empty if it cannot be
/// simulated.
Eigen::MatrixXd outputs_at(const Problem& problem, const ProblemCondition& condition,
                           const model::ParameterValues& values) {
  const auto run =
      model::simulate(condition.rig, values, {}, condition.inputs, condition.fit_times(),
                      condition.outputs, problem.simulation_options());
  if (!run.ok()) return {};
  return run.outputs(condition.rows, Eigen::all);
}

/// Returns the change in the weighted residuals, including priors, per ln s when the unknowns and
/// the smoothing are scaled. It is computed by simulating with scaled values, because the model has
/// no derivative with respect to the smoothing.
double felt_when_scaled(const Problem& problem, std::span<const double> z,
                        const std::vector<std::size_t>& unknowns, int threads) {
  constexpr double kScale = 1.5;  // large enough to make simulation errors negligible
  const int smoothing = model::parameter_index(problem.campaign->rig.plant, kSmoothing);
  std::vector<double> scaled(z.size());
  for (std::size_t j = 0; j < z.size(); ++j)
    scaled[j] = problem.map.to_physical(static_cast<int>(j), z[j]);
  double sum = 0.0;
  for (const std::size_t j : unknowns) {
    const double value = scaled[j];
    scaled[j] *= std::pow(kScale, scaling_exponent(problem.spec(j)));
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

double scaling_exponent(const model::ParameterSpec& spec) {
  using model::ParameterKind;
  // Flows depend on the square root of pressure over density. The density is not scaled, because it
  // is not a force.
  constexpr std::array<std::string_view, 5> kOpenings{
      "valve_gain", "pilot_gain", "leakage_coefficient", "bypass_opening", "return_line_opening"};
  if (std::find(kOpenings.begin(), kOpenings.end(), spec.key) != kOpenings.end()) return -0.5;
  // The recorded pilot pressure is not scaled, and neither are the values that are compared with
  // it.
  constexpr std::array<std::string_view, 6> kStays{
      "density", kSmoothing, "pilot_dead_band", "pilot_range", "return_dead_band", "bypass_range"};
  if (std::find(kStays.begin(), kStays.end(), spec.key) != kStays.end()) return 0.0;
  if (spec.kind == ParameterKind::sensor || spec.kind == ParameterKind::controller) return 0.0;
  return mass_exponent(spec.unit);
}

bool ScalingSymmetry::holds() const { return relative_sd > kScaleKnown; }

std::optional<ScalingSymmetry> scaling_symmetry(const Problem& problem, std::span<const double> z,
                                                double sigma, int threads) {
  if (!positions_alone(problem)) return std::nullopt;
  ScalingSymmetry result;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const int unknown = static_cast<int>(j);
    if (scaling_exponent(problem.spec(j)) == 0.0 || problem.map.to_physical(unknown, z[j]) == 0.0)
      continue;
    result.unknowns.push_back(j);
  }
  // A known supply pressure fixes s through the flow in the orifices. The Jacobian then shows which
  // unknowns are undetermined.
  if (result.unknowns.size() < 2 || !takes_part(problem, result, kSupply)) return std::nullopt;
  result.known = known_and_scaled(problem);
  const double felt = felt_when_scaled(problem, z, result.unknowns, threads);
  result.relative_sd = felt > 0.0 ? sigma / felt : std::numeric_limits<double>::infinity();
  return result;
}

std::string symmetry_remedy(const Problem& problem, const ScalingSymmetry& symmetry) {
  return fmt::format("a prior on {}supply pressure, or a recorded pressure or force",
                     takes_part(problem, symmetry, "mass") ? "mass or " : "");
}

std::string describe(const Problem& problem, const ScalingSymmetry& symmetry) {
  std::vector<std::string> grow;
  std::vector<std::string> fall;
  for (const std::size_t j : symmetry.unknowns) {
    const double exponent = scaling_exponent(problem.spec(j));
    if (exponent > 0.0) grow.push_back(problem.name(j));
    if (exponent < 0.0) fall.push_back(problem.name(j) + (exponent == -0.5 ? " (by sqrt(s))" : ""));
  }
  if (!symmetry.holds() && (symmetry.known.empty() || grow.size() < 2)) return {};
  const std::string scaling =
      fmt::format("multiplying {} by a factor s{}", fmt::join(grow, ", "),
                  fall.empty() ? "" : fmt::format(" and dividing {} by it", fmt::join(fall, ", ")));
  if (symmetry.known.empty()) {
    return fmt::format(
        "scaling symmetry: {} leaves all positions unchanged; not determined without {}", scaling,
        symmetry_remedy(problem, symmetry));
  }
  const std::string known = fmt::format("{}", fmt::join(symmetry.known, ", "));
  if (symmetry.holds()) {
    return fmt::format(
        "scaling symmetry, nearly: {} changes positions only through the fixed {}, which {} s to "
        "no better than {} % (standard error); determining it needs {}",
        scaling, known, symmetry.known.size() == 1 ? "determines" : "determine",
        significant(100.0 * symmetry.relative_sd, 2), symmetry_remedy(problem, symmetry));
  }
  return fmt::format(
      "scaling symmetry: {} changes positions only through the fixed {}: an error of 1 % there "
      "causes one of 1 % here",
      scaling, known);
}

void grade_symmetric(const Problem& problem, const ScalingSymmetry& symmetry,
                     std::vector<FittedParameter>& parameters) {
  if (!symmetry.holds()) return;
  for (const std::size_t j : symmetry.unknowns) {
    FittedParameter& each = parameters[j];
    if (each.nuisance) continue;
    each.identifiability = Identifiability::not_identifiable;
    // The interval is removed, and so is its explanation.
    const std::string known = each.standard_error || each.reason.empty() ? "" : "; " + each.reason;
    each.standard_error.reset();
    each.robust_standard_error.reset();
    each.ci95.reset();
    each.ci95_if_exact.reset();
    each.ci95_from.reset();
    each.reason = fmt::format(
        "not determined because of the scaling symmetry: {}, would make it identifiable{}",
        symmetry_remedy(problem, symmetry), known);
  }
}

}  // namespace rigcal::calib
