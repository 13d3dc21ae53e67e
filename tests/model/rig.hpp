#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

#include "model/simulate.hpp"
#include "tests/support/paper_rig.hpp"

namespace rigcal::model {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The rig that reproduces the paper's tables, with its internal leak at a medium opening.
inline ParameterValues paper_rig() {
  auto values = ParameterValues::defaults(PlantKind::load_pressure);
  for (const auto& [key, value] : test::kPaperRig) values.set(key, value);
  values.set("output_limit", 10.0);
  return values;
}

/// Returns `count` equally spaced times from `first` to `last`, inclusive.
inline std::vector<double> grid(double first, double last, int count) {
  std::vector<double> times(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    times[static_cast<std::size_t>(i)] = first + (last - first) * i / (count - 1);
  }
  return times;
}

/// All arguments of one call of simulate().
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
  /// Takes a parameter away, as if it had never been given.
  Experiment& unset(std::string_view key) {
    const auto index = static_cast<std::size_t>(parameter_index(values.plant, key));
    values.value.at(index) = parameter_table(values.plant)[index].default_value.value_or(0.0);
    values.given.at(index) = false;
    return *this;
  }
  Simulation operator()() const {
    return simulate(rig, values, free, inputs, times_s, outputs, options);
  }
};

inline double peak(const Eigen::MatrixXd& m) {
  return m.size() == 0 ? 0.0 : m.cwiseAbs().maxCoeff();
}

/// Largest difference between two runs in any output, relative to that output's peak.
inline double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  double worst = 0.0;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    worst = std::max(worst, peak(a.col(k) - b.col(k)) / std::max(peak(a.col(k)), 1e-300));
  }
  return worst;
}

}  // namespace rigcal::model
