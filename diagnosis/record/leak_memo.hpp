#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <mutex>
#include <vector>

#include "diagnosis/record/leak_curve.hpp"
#include "diagnosis/record/steady_leak.hpp"

namespace rigcal::diagnosis {

/// A simulated leak with the slopes of its share by further parameters.
struct SimulatedLeak {
  LeakPoint point;
  Eigen::VectorXd further_slope;  ///< shape (LeakMemo::further()), 1 / SI
  PeriodicEffort effort;
};

/// Whether a memo may interpolate.
enum class Between { simulated, interpolated };

/// Simulated leaks of one condition, which its records share. A simulation may take a second if the
/// rig approaches its periodic state slowly. Thread-safe; what it returns does not depend on the
/// order of requests.
///
/// If it interpolates, it simulates nodes whose coefficients differ by a constant factor (3 %).
/// Between them share and flow are cubic Hermite polynomials, and slopes are linear. All nodes
/// begin with the effort that a typical one needed, so that none repeats its shorter runs.
class LeakMemo {
 public:
  using Simulate = std::function<SimulatedLeak(double coefficient, PeriodicEffort least)>;

  /// @param further  table indices of the parameters for which slopes are kept
  /// @param typical  coefficient of the node whose effort the others begin with; 0 if unknown
  explicit LeakMemo(std::vector<int> further = {}, Between between = Between::simulated,
                    double typical = 0.0)
      : further_(std::move(further)), between_(between), typical_(typical) {}

  const std::vector<int>& further() const { return further_; }

  /// Returns the leak for a coefficient above 0. Each simulation is made once.
  ///
  /// @throws NoResultError  if neither the nodes nor the coefficient itself can be simulated
  SimulatedLeak at(double coefficient, const Simulate& simulate);

 private:
  SimulatedLeak simulated(double coefficient, const Simulate& simulate, PeriodicEffort least);
  PeriodicEffort usual_effort(const Simulate& simulate);

  std::vector<int> further_;
  Between between_;
  double typical_;
  std::mutex mutex_;
  std::map<double, SimulatedLeak> leaks_;
};

}  // namespace rigcal::diagnosis
