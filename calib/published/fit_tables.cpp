#include "calib/published/fit_tables.hpp"

#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>

#include "calib/problem/svd.hpp"
#include "calib/published/table_residuals.hpp"
#include "calib/search/optimum.hpp"
#include "common/error.hpp"
#include "metrics/distributions.hpp"

namespace rigcal::calib {
namespace {

constexpr int kMostIterations = 100;
constexpr int kMostCalls = 10;
/// All but a full Gauss-Newton step would leave the box at once from a far start.
constexpr double kTablesTrustRadius = 10.0;
constexpr double kRankThreshold = 1e-6;  ///< of the singular values, columns scaled to length 1

/// One unknown between its bounds, as z in [0, 1]: by its logarithm where that exists.
struct Axis {
  double lower = 0.0;
  double upper = 1.0;
  bool logarithmic() const { return lower > 0.0; }
  double value(double z) const {
    return logarithmic() ? lower * std::pow(upper / lower, z) : lower + z * (upper - lower);
  }
  double place(double value) const {
    const double z = logarithmic() ? std::log(value / lower) / std::log(upper / lower)
                                   : (value - lower) / (upper - lower);
    return std::clamp(z, 0.0, 1.0);
  }
  /// d value / d z
  double slope(double z) const {
    return logarithmic() ? value(z) * std::log(upper / lower) : upper - lower;
  }
};

std::vector<double> values_at(const std::vector<Axis>& axes, const std::vector<double>& z) {
  std::vector<double> values;
  for (std::size_t j = 0; j < axes.size(); ++j) values.push_back(axes[j].value(z[j]));
  return values;
}

/// The residuals as Ceres wants them; an exception must not cross it.
class TablesCost final : public ceres::CostFunction {
 public:
  TablesCost(TableResiduals& residuals, const std::vector<Axis>& axes)
      : residuals_(residuals), axes_(axes) {
    set_num_residuals(static_cast<int>(residuals.size()));
    mutable_parameter_block_sizes()->assign(axes.size(), 1);
  }

  bool Evaluate(double const* const* z, double* values, double** jacobians) const override {
    try {
      ++evaluations_;
      std::vector<double> place;
      for (std::size_t j = 0; j < axes_.size(); ++j) place.push_back(*z[j]);
      const auto found = residuals_.evaluate(values_at(axes_, place), jacobians != nullptr);
      failure_ = found.failure;
      if (!failure_.empty()) return false;
      std::copy(found.residuals.begin(), found.residuals.end(), values);
      for (std::size_t j = 0; jacobians != nullptr && j < axes_.size(); ++j) {
        if (jacobians[j] == nullptr) continue;
        Eigen::Map<Eigen::VectorXd>(jacobians[j], found.residuals.size()) =
            found.jacobian.col(static_cast<Eigen::Index>(j)) * axes_[j].slope(place[j]);
      }
      return true;
    } catch (...) {
      error_ = std::current_exception();
      return false;
    }
  }

  int evaluations() const { return evaluations_; }
  const std::string& failure() const { return failure_; }
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  TableResiduals& residuals_;
  const std::vector<Axis>& axes_;
  mutable int evaluations_ = 0;
  mutable std::string failure_;
  mutable std::exception_ptr error_;
};

/// Which unknowns are at a bound, with the cost falling only towards the outside.
std::vector<bool> outward(const TableResiduals::Evaluation& at, const std::vector<Axis>& axes,
                          const std::vector<double>& z) {
  std::vector<bool> held;
  for (std::size_t j = 0; j < z.size(); ++j) {
    const double gradient =
        at.jacobian.col(static_cast<Eigen::Index>(j)).dot(at.residuals) * axes[j].slope(z[j]);
    const BoundSide side = bound_side(z[j]);
    held.push_back((side == BoundSide::lower && gradient >= 0.0) ||
                   (side == BoundSide::upper && gradient <= 0.0));
  }
  return held;
}

struct Descent {
  bool converged = false;
  int iterations = 0;
  std::string failure;
};

/// Least squares by Ceres from z, which ends at the optimum. An unknown at a bound that the cost
/// pushes outwards is held there for one call, because a step that is projected onto the bound is
/// none for the others; it is let go as soon as the cost pushes inwards.
Descent minimise(TableResiduals& residuals, const std::vector<Axis>& axes, TablesCost& cost,
                 std::vector<double>& z) {
  Descent descent;
  std::vector<bool> held;
  for (int call = 0; call < kMostCalls; ++call) {
    const auto start = residuals.evaluate(values_at(axes, z), true);
    descent.failure = start.failure;
    if (!start.failure.empty()) return descent;
    const std::vector<bool> now = outward(start, axes, z);
    descent.converged = descent.converged && now == held;
    if (descent.converged) return descent;
    held = now;
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    std::vector<double*> blocks;
    for (double& place : z) blocks.push_back(&place);
    problem.AddResidualBlock(&cost, nullptr, blocks);
    for (std::size_t j = 0; j < z.size(); ++j) {
      problem.SetParameterLowerBound(&z[j], 0, 0.0);
      problem.SetParameterUpperBound(&z[j], 0, 1.0);
      if (held[j]) problem.SetParameterBlockConstant(&z[j]);
    }
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    solver.logging_type = ceres::SILENT;
    solver.max_num_iterations = kMostIterations - descent.iterations;
    solver.initial_trust_region_radius = kTablesTrustRadius;
    // The flows themselves are good to 2e-4 only.
    solver.function_tolerance = 1e-6;
    solver.parameter_tolerance = 1e-6;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    cost.rethrow();
    descent.iterations += static_cast<int>(summary.iterations.size());
    descent.converged = summary.termination_type == ceres::CONVERGENCE;
    if (summary.termination_type == ceres::FAILURE) {
      descent.failure =
          cost.failure().empty() ? "the optimiser gave up: " + summary.message : cost.failure();
    }
    if (!descent.converged) return descent;
  }
  descent.converged = false;  // it keeps going from bound to bound
  return descent;
}

/// Standard errors, intervals and correlation from the Jacobian at the optimum [SI].
void add_uncertainty(const TableResiduals::Evaluation& optimum, TablesFit& fit) {
  const Eigen::VectorXd length = optimum.jacobian.colwise().norm();
  const auto n = length.size();
  const Eigen::VectorXd inverse_length =
      length.unaryExpr([](double l) { return l > 0.0 ? 1.0 / l : 0.0; });
  const Eigen::MatrixXd scaled = optimum.jacobian * inverse_length.asDiagonal();
  const Svd svd(scaled, Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  const auto rank = (s.array() > kRankThreshold * s(0)).count();
  const auto freedom = static_cast<double>(optimum.residuals.size() - rank);
  if (freedom < 1.0) return;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd open = Eigen::VectorXd::Zero(n);  // share in what the tables do not determine
  for (Eigen::Index k = 0; k < n; ++k) {
    const Eigen::VectorXd v = svd.matrixV().col(k);
    if (k < rank) {
      covariance += v * v.transpose() / (s(k) * s(k));
    } else {
      open += v.cwiseAbs2();
    }
  }
  covariance *= optimum.residuals.squaredNorm() / freedom;
  covariance = inverse_length.asDiagonal() * covariance * inverse_length.asDiagonal();
  const double t = metrics::student_t_quantile(0.975, freedom);
  fit.correlation.setIdentity(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    FittedAssumption& parameter = fit.parameters[static_cast<std::size_t>(j)];
    if (open(j) > kRankThreshold || !(covariance(j, j) > 0.0)) continue;
    parameter.standard_error = std::sqrt(covariance(j, j));
    parameter.ci95 = {parameter.value - t * *parameter.standard_error,
                      parameter.value + t * *parameter.standard_error};
    for (Eigen::Index k = 0; k < n; ++k) {
      if (covariance(k, k) > 0.0) {
        fit.correlation(j, k) = covariance(j, k) / std::sqrt(covariance(j, j) * covariance(k, k));
      }
    }
  }
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
  std::vector<Axis> axes;
  std::vector<double> z;
  for (const datasets::Assumption& assumption : settings.assumptions) {
    if (!assumption.fit) continue;
    free.push_back(assumption.index);
    axes.push_back({assumption.lower, assumption.upper});
    z.push_back(axes.back().place(assumption.start));
    FittedAssumption parameter;
    parameter.index = assumption.index;
    parameter.start = assumption.start;
    parameter.lower = assumption.lower;
    parameter.upper = assumption.upper;
    fit.parameters.push_back(parameter);
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
        fmt::format("{} published numbers cannot tell {} values: expected printed coefficients in "
                    "[[leak_table.signal]] or rows in [leak_table.features]",
                    residuals.size(), free.size()));
  }

  TablesCost cost(residuals, axes);
  const Descent descent = minimise(residuals, axes, cost, z);

  fit.iterations = descent.iterations;
  fit.evaluations = cost.evaluations();
  const std::vector<double> values = values_at(axes, z);
  for (std::size_t j = 0; j < free.size(); ++j) {
    FittedAssumption& parameter = fit.parameters[j];
    parameter.value = values[j];
    parameter.at_bound = bound_side(z[j]) != BoundSide::inside;
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
    fit.rms = std::sqrt(2.0 * fit.cost / static_cast<double>(residuals.size()));
    for (std::size_t i = 0; i < residuals.size(); ++i) {
      const double weight = residuals.weight(i);
      fit.residuals.push_back(
          {residuals.name(i), weight, optimum.residuals(static_cast<Eigen::Index>(i)) / weight});
    }
    add_uncertainty(optimum, fit);
  }
  if (cancelled) {
    fit.status = FitStatus::stopped;
    fit.message = "stopped on request";
  } else if (!optimum.failure.empty() || !descent.failure.empty()) {
    fit.message = optimum.failure.empty() ? descent.failure : optimum.failure;
  } else if (descent.converged) {
    fit.status = FitStatus::converged;
    fit.message = fmt::format("converged after {} iterations", fit.iterations);
  } else {
    fit.status = FitStatus::stopped;
    fit.message = fmt::format("stopped after {} iterations before it converged", fit.iterations);
  }
  fit.wall_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return fit;
}

}  // namespace rigcal::calib
