#include "diagnosis/table/fit_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "calib/descent/descend.hpp"
#include "calib/problem/parameter_map.hpp"
#include "calib/problem/scaled_svd.hpp"
#include "calib/search/optimum.hpp"
#include "calib/trust/identifiability.hpp"
#include "common/error.hpp"
#include "diagnosis/table/table_residuals.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::diagnosis {
namespace {

/// Maximum number of iterations. The tables in docs/paper.md need 13 to 32, depending on the last
/// digits of the start values.
constexpr int kMostIterations = 100;
/// Maximum number of descents, each with a different set of unknowns at their bounds.
constexpr int kMostCalls = 10;
/// Limits the first steps, because a full Gauss-Newton step from a distant start would leave the
/// box immediately.
constexpr double kTablesTrustRadius = 10.0;
/// A smaller tolerance is pointless, because the flows are only accurate to 2e-4.
constexpr double kTablesTolerance = 1e-6;
constexpr double kRankThreshold =
    1e-6;  ///< relative to the largest singular value, with columns scaled to length 1

std::vector<double> values_at(const std::vector<calib::UnitInterval>& intervals,
                              std::span<const double> z) {
  std::vector<double> values;
  for (std::size_t j = 0; j < intervals.size(); ++j) values.push_back(intervals[j].value(z[j]));
  return values;
}

/// Solves the least-squares problem from z, which is updated to the optimum. Unknowns at an active
/// bound are fixed for one descent, because a step projected onto the bound is not the right step
/// for the others.
calib::Descent minimise(TableResiduals& residuals,
                        const std::vector<calib::UnitInterval>& intervals, std::vector<double>& z,
                        int& evaluations) {
  std::string failure;
  calib::DescentOptions options;
  options.linearise = [&](std::span<const double> at, bool jacobian) {
    ++evaluations;
    auto found = residuals.evaluate(values_at(intervals, at), jacobian);
    failure = found.failure;
    for (Eigen::Index j = 0; j < found.jacobian.cols(); ++j) {
      const auto u = static_cast<std::size_t>(j);
      found.jacobian.col(j) *= intervals[u].slope(at[u]);
    }
    return failure.empty() ? std::optional(calib::Linearisation{std::move(found.jacobian),
                                                                std::move(found.residuals)})
                           : std::nullopt;
  };
  options.trust_radius = kTablesTrustRadius;
  options.function_tolerance = kTablesTolerance;
  options.parameter_tolerance = kTablesTolerance;
  const auto count = static_cast<Eigen::Index>(residuals.size());
  std::vector<bool> active_bound;
  calib::Descent total;
  for (int call = 0; call < kMostCalls; ++call) {
    const auto start = options.linearise(z, true);
    if (!start) return {false, total.iterations, failure};
    const std::vector<bool> active = active_bounds(*start, z);
    if (total.converged && active == active_bound) return total;
    active_bound = active;
    options.most_iterations = kMostIterations - total.iterations;
    const calib::Descent descent = calib::descend(options, count, active_bound, z);
    total.converged = descent.converged;
    total.iterations += descent.iterations;
    if (!descent.failure.empty()) total.failure = failure.empty() ? descent.failure : failure;
    if (!total.converged) return total;
  }
  total.converged = false;  // the estimate still moves from bound to bound
  return total;
}

/// Adds standard errors, intervals and correlation from the Jacobian at the optimum, SI.
void add_uncertainty(const TableResiduals::Evaluation& optimum, model::PlantKind plant,
                     TablesFit& fit) {
  const calib::ScaledSvd svd(optimum.jacobian, kRankThreshold);
  const auto n = optimum.jacobian.cols();
  const auto freedom = static_cast<double>(optimum.residuals.size() - svd.rank());
  if (freedom < 1.0) return;
  const Eigen::MatrixXd root = svd.root();
  const Eigen::MatrixXd covariance =
      root * root.transpose() * (optimum.residuals.squaredNorm() / freedom);
  // Squared component of each unknown in the directions that the tables do not determine.
  const Eigen::VectorXd open = svd.V().rightCols(n - svd.rank()).rowwise().squaredNorm();
  const double t = metrics::student_t_quantile(0.975, freedom);
  fit.correlation.matrix.setIdentity(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    calib::FittedParameter& parameter = fit.parameters[static_cast<std::size_t>(j)];
    if (open(j) > kRankThreshold || !(covariance(j, j) > 0.0)) continue;
    parameter.standard_error = std::sqrt(covariance(j, j));
    parameter.degrees_of_freedom = std::optional(freedom);
    const double half_width = t * *parameter.standard_error;
    parameter.ci95 = {parameter.value - half_width, parameter.value + half_width};
    parameter.ci95_if_exact = parameter.ci95;
    parameter.ci95_from = std::optional(calib::IntervalSource::standard_error);
    parameter.identifiability =
        calib::grade_of(datasets::assumption_spec(plant, parameter.index), parameter.value,
                        half_width, parameter.lower < 0.0 && parameter.upper > 0.0);
    for (Eigen::Index k = 0; k < n; ++k) {
      if (covariance(k, k) > 0.0) {
        fit.correlation.matrix(j, k) =
            covariance(j, k) / std::sqrt(covariance(j, j) * covariance(k, k));
      }
    }
  }
}

std::string reason_of(const calib::FittedParameter& p) {
  if (p.at_bound) return "at its bound";
  if (!p.standard_error || !p.ci95) return "the published numbers do not determine it";
  if (p.identifiability == calib::Identifiability::identified) return "";
  if (p.identifiability == calib::Identifiability::bounded)
    return "not significantly different from zero";
  return calib::half_width_words(0.5 * (p.ci95->high - p.ci95->low) / std::abs(p.value));
}

std::vector<std::string> left_out(const datasets::LeakTableSettings& settings) {
  std::vector<std::string> texts;
  for (const datasets::PrintedFeatures& row : settings.features) {
    if (row.left_out.empty()) continue;
    std::vector<std::string_view> names;
    for (const datasets::Feature feature : row.left_out) names.push_back(to_string(feature));
    texts.push_back(fmt::format("{} of {}: {}", fmt::join(names, ", "), row.level, row.reason));
  }
  return texts;
}

}  // namespace

TablesFit fit_tables(const datasets::Campaign& campaign,
                     const datasets::LeakTableSettings& settings, const LeakTableOptions& options) {
  const auto started = std::chrono::steady_clock::now();
  TablesFit fit;
  fit.settings = settings;
  fit.left_out = left_out(settings);
  std::vector<int> free;
  std::vector<calib::UnitInterval> intervals;
  std::vector<double> z;
  for (const datasets::Assumption& assumption : settings.assumptions) {
    if (!assumption.fit) continue;
    free.push_back(assumption.index);
    intervals.push_back({assumption.lower, assumption.upper, assumption.lower > 0.0});
    z.push_back(intervals.back().place(assumption.start));
    calib::FittedParameter parameter;
    parameter.index = assumption.index;
    parameter.name_after(datasets::assumption_spec(campaign.rig.plant, assumption.index));
    parameter.fitted = true;
    parameter.identifiability = calib::Identifiability::not_identifiable;
    parameter.start = assumption.start;
    parameter.lower = assumption.lower;
    parameter.upper = assumption.upper;
    fit.correlation.names.push_back(parameter.name);
    fit.parameters.push_back(std::move(parameter));
  }
  if (free.empty()) {
    throw InputError({campaign.file.string()},
                     "no assumption of [leak_table] is to be estimated: expected fit = true in "
                     "[leak_table.assumptions], or --free");
  }
  TableResiduals residuals(campaign, settings, free, options);
  if (residuals.size() < free.size()) {
    throw InputError(
        {campaign.file.string()},
        fmt::format(
            "{} published numbers cannot determine {} values: expected printed coefficients in "
            "[[leak_table.signal]] or rows in [leak_table.features]",
            residuals.size(), free.size()));
  }

  const calib::Descent descent = minimise(residuals, intervals, z, fit.evaluations);
  fit.iterations = descent.iterations;
  const std::vector<double> values = values_at(intervals, z);
  for (std::size_t j = 0; j < free.size(); ++j) {
    calib::FittedParameter& parameter = fit.parameters[j];
    parameter.value = values[j];
    parameter.at_bound = calib::bound_side(z[j]) != calib::BoundSide::inside;
    for (datasets::Assumption& assumption : fit.settings.assumptions) {
      if (assumption.index != free[j]) continue;
      assumption.value = values[j];
      assumption.source = "estimated by fit-tables from the published numbers";
    }
  }
  const bool cancelled =
      options.periodic.simulation.cancel != nullptr && options.periodic.simulation.cancel->load();
  const auto optimum = cancelled ? TableResiduals::Evaluation{"stopped on request", {}, {}}
                                 : residuals.evaluate(values, true);
  if (optimum.failure.empty()) {
    fit.cost = 0.5 * optimum.residuals.squaredNorm();
    fit.rms = std::sqrt(2.0 * *fit.cost / static_cast<double>(residuals.size()));
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double weight = residuals.weight(i);
      fit.residuals.push_back(
          {residuals.name(i), weight, optimum.residuals(static_cast<Eigen::Index>(i)) / weight});
    }
    fit.residual_count = static_cast<long>(fit.residuals.size());
    add_uncertainty(optimum, campaign.rig.plant, fit);
  }
  for (calib::FittedParameter& parameter : fit.parameters) parameter.reason = reason_of(parameter);
  if (cancelled) {
    fit.status = calib::FitStatus::stopped;
    fit.message = "stopped on request";
  } else if (!optimum.failure.empty() || !descent.failure.empty()) {
    fit.message = optimum.failure.empty() ? descent.failure : optimum.failure;
    fit.cost.reset();
    fit.rms.reset();
    for (calib::FittedParameter& parameter : fit.parameters) parameter.value = std::nan("");
  } else if (descent.converged) {
    fit.status = calib::FitStatus::converged;
    fit.message = fmt::format("converged after {} iterations", fit.iterations);
  } else {
    fit.status = calib::FitStatus::stopped;
    fit.message = fmt::format("stopped after {} iterations before it converged", fit.iterations);
  }
  fit.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return fit;
}

}  // namespace rigcal::diagnosis
