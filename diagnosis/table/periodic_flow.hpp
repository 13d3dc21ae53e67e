#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "datasets/campaign/leak_table_settings.hpp"
#include "model/simulate.hpp"

namespace rigcal::diagnosis {

/// A rig under one periodic drive.
struct PeriodicDrive {
  model::Rig rig;
  datasets::LeakSignal signal;
};

struct PeriodicOptions {
  model::SimulationOptions simulation{.tolerance = 1e-5};
  int periods = 4;          ///< initial number of periods; a power of two, at least 4
  int most_periods = 1024;  ///< if more are needed, the flow is considered not periodic
  int intervals = 512;      ///< initial number of intervals per piece of a period
  double tolerance = 1e-4;  ///< allowed error in the mean flows due to transient and sampling
};

/// Mean flows of a rig that has become periodic.
struct PeriodicFlow {
  double servo_flow_m3_per_s = 0.0;  ///< mean |Q_servo| over the last period
  double leak_flow_m3_per_s = 0.0;   ///< mean |Q_leak| over the last period
  Eigen::VectorXd servo_slope;       ///< d servo flow / d parameter, shape (free), SI
  Eigen::VectorXd leak_slope;
  double saturated = 0.0;  ///< fraction of the period during which the command is at its limit
  int periods = 0;         ///< number of periods simulated from rest
  int intervals = 0;       ///< number of intervals per piece
  std::string failure;     ///< why there is no result; empty if there is one

  bool ok() const { return failure.empty(); }
  double share() const { return leak_flow_m3_per_s / servo_flow_m3_per_s; }
};

/// Simulates from rest until the mean flows are periodic, and refines the sampling until they are
/// accurate enough.
///
/// Whether a run of n periods has become periodic follows from the means f of its periods n/4, n/2
/// and n. If the transient is a y^k after k quarters of the run, f(n/2) - f(n/4) = a y (y - 1) and
/// f(n) - f(n/2) = a y^2 (y^2 - 1). Their quotient gives y, and y gives the remaining transient at
/// n. If this exceeds the tolerance, the run is doubled in length, as long as that helps: a loop
/// that oscillates by itself never settles. The sampling error is estimated by leaving out every
/// second sample.
///
/// @param values  SI; includes the leakage coefficient
/// @param free    table indices of the parameters for which slopes are needed
PeriodicFlow periodic_flow(const PeriodicDrive& drive, const model::ParameterValues& values,
                           std::span<const int> free, const PeriodicOptions& options);

/// One period of a periodic run at equidistant times.
struct PeriodicSeries {
  std::vector<double> time_s;  ///< from the start of the period; shape (samples)
  model::Simulation run;       ///< outputs and their sensitivities
};

/// @param periods  number of periods after which the run is periodic; the last of them is returned
PeriodicSeries periodic_series(const PeriodicDrive& drive, const model::ParameterValues& values,
                               std::span<const int> free, std::span<const model::Output> outputs,
                               int periods, int samples, const model::SimulationOptions& options);

}  // namespace rigcal::diagnosis
