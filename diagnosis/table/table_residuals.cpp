#include "diagnosis/table/table_residuals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/parallel.hpp"
#include "diagnosis/table/fit_tables.hpp"

namespace rigcal::diagnosis {
namespace {

using datasets::Feature;

constexpr std::array kPosition{model::Output::position};
constexpr int kSettlingPeriods = 2;  ///< for the position, which settles more slowly than the flows

/// A positive quantity, with its derivatives with respect to the free parameters of the rig.
struct Quantity {
  double value = 0.0;
  Eigen::VectorXd slope;
};

Quantity feature_of(Feature feature, const PeriodicSeries& leaking, const PeriodicSeries& healthy) {
  const Eigen::VectorXd r = leaking.run.outputs.col(0) - healthy.run.outputs.col(0);
  const Eigen::MatrixXd dr = leaking.run.sensitivities[0] - healthy.run.sensitivities[0];
  const auto f = metrics::residual_features({r.data(), static_cast<std::size_t>(r.size())});
  const auto n = static_cast<double>(r.size());
  const Eigen::VectorXd sign = r.array().sign();
  const Eigen::VectorXd d_mean = dr.transpose() * sign / n;
  const Eigen::VectorXd d_rms = dr.transpose() * r / (n * f.rms);
  if (feature == Feature::mean) return {f.mean, d_mean};
  if (feature == Feature::rms) return {f.rms, d_rms};
  return {f.std, (f.rms * d_rms - f.mean * d_mean) / f.std};
}

}  // namespace

TableResiduals::TableResiduals(const datasets::Campaign& campaign,
                               const datasets::LeakTableSettings& settings, std::vector<int> free,
                               LeakTableOptions options)
    : campaign_(campaign),
      settings_(settings),
      free_(std::move(free)),
      options_(std::move(options)) {
  add_shares();
  add_features();
}

void TableResiduals::add_shares() {
  for (const datasets::LeakSignal& signal : settings_.signals) {
    for (const double target : settings_.targets_percent) {
      const auto printed = signal.printed.find(target);
      if (printed == signal.printed.end()) continue;
      Row row;
      row.what = fmt::format("share, {}, {:g} %", signal.name(), target);
      row.weight = kShareWeight;
      row.run = runs_.size();
      row.published = target / 100.0;
      row.is_share = true;
      rows_.push_back(std::move(row));
      runs_.push_back({{campaign_.rig, signal}, printed->second.value, false, options_.periodic});
    }
  }
}

void TableResiduals::add_features() {
  if (!settings_.feature_signal) return;
  const PeriodicDrive drive{campaign_.rig, *settings_.feature_signal};
  healthy_ = runs_.size();
  runs_.push_back({drive, 0.0, true, options_.periodic});
  for (const datasets::PrintedFeatures& printed : settings_.features) {
    bool with_series = false;
    for (const auto& [feature, published] : printed.printed) {
      const auto& left_out = printed.left_out;
      if (std::find(left_out.begin(), left_out.end(), feature) != left_out.end()) continue;
      Row row;
      row.what = fmt::format("{}, {}", to_string(feature), printed.level);
      row.run = runs_.size();
      row.published = published;
      row.feature = feature;
      with_series =
          with_series || (feature != Feature::servo_flow && feature != Feature::leak_flow);
      rows_.push_back(std::move(row));
    }
    runs_.push_back({drive, printed.coefficient, with_series, options_.periodic});
  }
}

TableResiduals::Outcome TableResiduals::simulate(Run& run, const model::ParameterValues& values,
                                                 const std::vector<int>& free) const {
  model::ParameterValues at = values;
  at.set("leakage_coefficient", run.coefficient);
  Outcome outcome;
  outcome.flow = periodic_flow(run.drive, at, free, run.options);
  if (!outcome.flow.ok()) return outcome;
  // Later evaluations never use fewer periods or intervals, because the residuals must be smooth
  // close to the optimum.
  run.options.periods = outcome.flow.periods;
  run.options.intervals = outcome.flow.intervals;
  if (!run.with_series) return outcome;
  outcome.series =
      periodic_series(run.drive, at, free, kPosition, kSettlingPeriods * outcome.flow.periods,
                      options_.series_samples, options_.periodic.simulation);
  if (!outcome.series.run.ok()) outcome.flow.failure = outcome.series.run.reason;
  return outcome;
}

TableResiduals::Evaluation TableResiduals::evaluate(const std::vector<double>& values,
                                                    bool with_jacobian) {
  datasets::LeakTableSettings settings = settings_;
  double scale = 1.0;
  std::vector<int> of_rig;                  // table indices of the free parameters of the rig
  std::vector<Eigen::Index> column_of_rig;  // columns of these parameters in the Jacobian
  Eigen::Index column_of_scale = -1;
  for (std::size_t j = 0; j < free_.size(); ++j) {
    for (datasets::Assumption& assumption : settings.assumptions) {
      if (assumption.index == free_[j]) assumption.value = values[j];
    }
    if (free_[j] == datasets::kResidualScale) {
      column_of_scale = static_cast<Eigen::Index>(j);
    } else if (with_jacobian) {
      of_rig.push_back(free_[j]);
      column_of_rig.push_back(static_cast<Eigen::Index>(j));
    }
  }
  if (const auto* assumed = settings.assumption(datasets::kResidualScale)) scale = assumed->value;
  const model::ParameterValues rig = datasets::leak_table_values(campaign_, settings);

  std::vector<Outcome> outcomes(runs_.size());
  parallel_for(runs_.size(), options_.threads,
               [&](std::size_t i) { outcomes[i] = simulate(runs_[i], rig, of_rig); });
  Evaluation evaluation;
  for (std::size_t i = 0; i < runs_.size(); ++i) {
    if (outcomes[i].flow.ok()) continue;
    evaluation.failure =
        fmt::format("{} at leakage_coefficient = {:.6g}: {}", runs_[i].drive.signal.name(),
                    runs_[i].coefficient, outcomes[i].flow.failure);
    return evaluation;
  }
  const auto count = static_cast<Eigen::Index>(rows_.size());
  evaluation.residuals.resize(count);
  if (with_jacobian) {
    evaluation.jacobian.setZero(count, static_cast<Eigen::Index>(free_.size()));
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const PeriodicFlow& flow = outcomes[row.run].flow;
    const bool is_flow =
        row.is_share || row.feature == Feature::servo_flow || row.feature == Feature::leak_flow;
    Eigen::VectorXd log_slope = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(of_rig.size()));
    double value = 0.0;
    if (is_flow) {
      const bool with_leak = row.is_share || row.feature == Feature::leak_flow;
      const bool with_servo = row.is_share || row.feature == Feature::servo_flow;
      value = row.is_share ? flow.share()
              : with_leak  ? flow.leak_flow_m3_per_s
                           : flow.servo_flow_m3_per_s;
      if (!of_rig.empty()) {
        if (with_leak) log_slope += flow.leak_slope / flow.leak_flow_m3_per_s;
        if (with_servo) {
          log_slope += (row.is_share ? -1.0 : 1.0) * flow.servo_slope / flow.servo_flow_m3_per_s;
        }
      }
    } else {
      const Quantity quantity =
          feature_of(row.feature, outcomes[row.run].series, outcomes[*healthy_].series);
      value = scale * quantity.value;
      if (!of_rig.empty()) log_slope = quantity.slope / quantity.value;
    }
    const auto r = static_cast<Eigen::Index>(i);
    evaluation.residuals(r) = row.weight * std::log(value / row.published);
    if (!with_jacobian) continue;
    for (std::size_t j = 0; j < of_rig.size(); ++j) {
      evaluation.jacobian(r, column_of_rig[j]) =
          row.weight * log_slope(static_cast<Eigen::Index>(j));
    }
    if (!is_flow && column_of_scale >= 0) {
      evaluation.jacobian(r, column_of_scale) = row.weight / scale;
    }
  }
  return evaluation;
}

}  // namespace rigcal::diagnosis
