#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>
#include <numbers>
#include <string_view>
#include <utility>
#include <vector>

#include "model/simulate.hpp"

namespace rigcal::model {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The rig that reproduces the paper's tables, its internal leak at a medium opening.
inline ParameterValues paper_rig() {
  auto values = ParameterValues::defaults(PlantKind::load_pressure);
  for (const auto& [key, value] : std::initializer_list<std::pair<std::string_view, double>>{
           {"mass", 85.0},
           {"damping", 1000.0},
           {"stiffness", 0.0},
           {"piston_area", 1.62e-3},
           {"total_volume", 2.46888e-4},
           {"supply_pressure", 6.2e6},
           {"density", 847.0},
           {"bulk_modulus", 689e6},
           {"discharge_coefficient", 0.6},
           {"area_gradient", 0.02075},
           {"valve_gain", 0.0406e-3},
           {"leakage_coefficient", 0.35},
           {"leakage_area", 4.456e-6},
           {"kp", 78.74},
           {"output_limit", 10.0},
       }) {
    values.set(key, value);
  }
  return values;
}

/// `count` times from `first` to `last`, both included.
inline std::vector<double> grid(double first, double last, int count) {
  std::vector<double> times(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    times[static_cast<std::size_t>(i)] = first + (last - first) * i / (count - 1);
  }
  return times;
}

/// Everything that one call of simulate() takes.
struct Experiment {
  Rig rig;
  ParameterValues values = paper_rig();
  SimulationInputs inputs{Signal::sine(0.02, 1.0), {}, {}};
  std::vector<double> times_s = grid(0.0, 1.0, 101);
  std::vector<Output> outputs = {Output::position, Output::load_pressure};
  std::vector<int> free{};
  SimulationOptions options{};

  Experiment& set(std::string_view key, double value) {
    values.set(key, value);
    return *this;
  }
  Simulation operator()() const {
    return simulate(rig, values, free, inputs, times_s, outputs, options);
  }
};

inline double peak(const Eigen::MatrixXd& m) {
  return m.size() == 0 ? 0.0 : m.cwiseAbs().maxCoeff();
}

/// Largest difference of two runs in any output, relative to that output's peak.
inline double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    worst = std::max(worst, peak(a.col(k) - b.col(k)) / std::max(peak(a.col(k)), 1e-300));
  }
  return worst;
}

}  // namespace rigcal::model
