#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnosis/table/leak_table.hpp"

namespace rigcal::diagnosis {

/// The published numbers of a leak table as weighted residuals that depend on its assumptions.
class TableResiduals {
 public:
  /// @param free  indices of the free assumptions; may include kResidualScale
  TableResiduals(const datasets::Campaign& campaign, const datasets::LeakTableSettings& settings,
                 std::vector<int> free, LeakTableOptions options);

  struct Evaluation {
    std::string failure;        ///< why there are no residuals; empty if there are residuals
    Eigen::VectorXd residuals;  ///< shape (size())
    Eigen::MatrixXd jacobian;   ///< shape (size(), free), SI; empty if not requested
  };
  /// @param values  values of the free assumptions, SI
  Evaluation evaluate(const std::vector<double>& values, bool with_jacobian);

  std::size_t size() const { return rows_.size(); }
  /// The quantity that a residual compares, and the weight of the residual.
  const std::string& name(std::size_t row) const { return rows_[row].what; }
  double weight(std::size_t row) const { return rows_[row].weight; }

 private:
  struct Row {
    std::string what;
    double weight = 1.0;
    std::size_t run = 0;     ///< index of the run that provides the computed value
    double published = 0.0;  ///< SI, except that features are in their printed unit
    bool is_share = false;   ///< true if the row is a leak share, false if it is `feature`
    datasets::Feature feature = datasets::Feature::servo_flow;
  };
  /// A run with one coefficient under one drive. The first run with a feature signal is that of the
  /// healthy rig.
  struct Run {
    PeriodicDrive drive;
    double coefficient = 0.0;
    bool with_series = false;
    PeriodicOptions options;  ///< begin with the numbers of periods and intervals that the last
                              ///< evaluation needed
  };
  struct Outcome {
    PeriodicFlow flow;
    PeriodicSeries series;
  };

  Outcome simulate(Run& run, const model::ParameterValues& values,
                   const std::vector<int>& free) const;
  void add_shares();
  void add_features();

  const datasets::Campaign& campaign_;
  datasets::LeakTableSettings settings_;
  std::vector<int> free_;
  LeakTableOptions options_;
  std::vector<Run> runs_;
  std::vector<Row> rows_;
  std::optional<std::size_t> healthy_;
};

}  // namespace rigcal::diagnosis
