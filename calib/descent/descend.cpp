#include "calib/descent/descend.hpp"

#include <ceres/cost_function.h>
#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include <exception>

namespace rigcal::calib {
namespace {

/// Reports each iteration of Ceres, and stops Ceres on request. Exceptions must not pass through
/// Ceres. If the callback throws, the exception is stored and Ceres stops; the caller rethrows it.
class CeresWatch final : public ceres::IterationCallback {
 public:
  CeresWatch(const std::function<bool(const DescentStep&)>& enough, std::exception_ptr& error)
      : enough_(enough), error_(error) {}

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    made_ = summary.iteration;
    bool stop = false;
    try {
      stop = enough_ && enough_({made_, summary.cost,
                                 summary.cost > 0.0 ? summary.cost_change / summary.cost : 0.0,
                                 summary.cumulative_time_in_seconds});
    } catch (...) {
      error_ = std::current_exception();
    }
    return stop || error_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  int made() const { return made_; }

 private:
  const std::function<bool(const DescentStep&)>& enough_;
  std::exception_ptr& error_;
  int made_ = 0;
};

ceres::Solver::Options quiet_settings() {
  ceres::Solver::Options settings;
  settings.num_threads = 1;  // keeps the order of sums; the simulations themselves run in parallel
  settings.logging_type = ceres::SILENT;
  settings.minimizer_progress_to_stdout = false;
  return settings;
}

/// All residuals as a cost function of Ceres, with one parameter block of size 1 per unknown.
/// Borrows everything.
class BoxCost final : public ceres::CostFunction {
 public:
  BoxCost(const DescentOptions& options, Eigen::Index residuals, std::size_t unknowns,
          std::exception_ptr& error)
      : options_(options), error_(error) {
    set_num_residuals(static_cast<int>(residuals));
    mutable_parameter_block_sizes()->assign(unknowns, 1);
  }

  /// Returns false if the point cannot be evaluated; Ceres then shortens its step.
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    if (error_) return false;
    try {
      std::vector<double> z(parameter_block_sizes().size());
      for (std::size_t j = 0; j < z.size(); ++j) z[j] = *blocks[j];
      const auto found = options_.linearise(z, jacobians != nullptr);
      if (!found) return false;
      Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()) = found->residual;
      for (std::size_t j = 0; jacobians != nullptr && j < z.size(); ++j) {
        if (jacobians[j] != nullptr)
          Eigen::Map<Eigen::VectorXd>(jacobians[j], num_residuals()) =
              found->jacobian.col(static_cast<Eigen::Index>(j));
      }
      return true;
    } catch (...) {
      error_ = std::current_exception();
      return false;
    }
  }

 private:
  const DescentOptions& options_;
  std::exception_ptr& error_;
};

}  // namespace

Descent descend(const DescentOptions& options, Eigen::Index residuals,
                const std::vector<bool>& active_bound, std::vector<double>& z) {
  ceres::Problem system;
  std::exception_ptr error;
  std::vector<double*> blocks;
  for (double& each : z) blocks.push_back(&each);
  system.AddResidualBlock(new BoxCost(options, residuals, z.size(), error), nullptr, blocks);
  for (std::size_t j = 0; j < z.size(); ++j) {
    system.SetParameterLowerBound(&z[j], 0, 0.0);
    system.SetParameterUpperBound(&z[j], 0, 1.0);
    if (active_bound[j]) system.SetParameterBlockConstant(&z[j]);
  }
  CeresWatch watch(options.enough, error);
  ceres::Solver::Options settings = quiet_settings();
  settings.linear_solver_type = ceres::DENSE_QR;
  settings.max_num_iterations = options.most_iterations;
  settings.initial_trust_region_radius = options.trust_radius;
  settings.function_tolerance = options.function_tolerance;
  settings.parameter_tolerance = options.parameter_tolerance;
  settings.callbacks.push_back(&watch);
  ceres::Solver::Summary summary;
  ceres::Solve(settings, &system, &summary);
  if (error) std::rethrow_exception(error);
  const bool gave_up = summary.termination_type == ceres::FAILURE;
  return {summary.termination_type == ceres::CONVERGENCE, watch.made(),
          gave_up ? "the optimiser gave up: " + summary.message : std::string()};
}

}  // namespace rigcal::calib
