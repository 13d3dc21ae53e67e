#pragma once

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calib/result/model_error.hpp"
#include "calib/result/uncertainty_budget.hpp"
#include "common/describe.hpp"
#include "datasets/campaign/campaign.hpp"
#include "datasets/record.hpp"
#include "metrics/metric_table.hpp"
#include "metrics/noise_floor.hpp"
#include "metrics/residual_tests.hpp"

// Agreement of the model with the record of a condition.

namespace rigcal::calib {

/// Metrics of one channel in one condition, and its response at the fundamental frequency. A metric
/// that does not exist is NaN; `problem` says why.
struct ChannelMetrics : metrics::Agreement {
  std::optional<double> gain_ratio, phase_deg, delay_s;  ///< simulated to measured; sine and square
  std::optional<std::string> problem;                    ///< why a value is missing, in words

  ChannelMetrics() {
    for (const metrics::MetricSpec& metric : metrics::kMetrics) this->*metric.value = std::nan("");
  }
  using metrics::Agreement::operator=;

  template <typename Self, typename Visit>
  static void describe(Self& self, const Visit& visit) {
    metrics::Agreement::describe(self, visit);
    visit("gain_ratio", self.gain_ratio);
    visit("phase_deg", self.phase_deg);
    visit("delay_s", self.delay_s);
    visit("problem", self.problem);
  }
};

/// Agreement of one channel in one condition.
struct ChannelScore {
  datasets::Channel channel = datasets::Channel::position;
  ChannelMetrics metrics;
  std::optional<metrics::NoiseFloor> noise_floor;  ///< absent if the noise is unknown
  /// One-sided uncertainty due to repeats and sensor; absent with fewer than two repeats.
  std::optional<metrics::Agreement> expanded_uncertainty;
  /// Two-sided uncertainty, as printed after +-.
  std::optional<metrics::Agreement> two_sided_uncertainty;
  /// Contributions to the two-sided uncertainty of each metric, in the order of the metrics; empty
  /// if the uncertainty is unknown.
  Keyed<Budget95> budgets;
  /// Tests of the residual (measured minus simulated) over the longest window; absent if the window
  /// is too short or the residual is constant.
  std::optional<metrics::ResidualTests> residual_tests;
  std::optional<LackOfFit> lack_of_fit;  ///< test of a prediction; absent if the noise is unknown
};

enum class Verdict { pass, warn, fail };
std::string_view to_string(Verdict verdict);

/// Comparison of one metric of one channel with its limit.
struct LimitCheck {
  datasets::Channel channel = datasets::Channel::position;  ///< key of the channel
  std::string metric;                                       ///< name of the metric
  std::optional<double> value;        ///< absent if the metric does not exist; `words` says why
  std::optional<double> limit, warn;  ///< beyond `limit` FAIL, between `warn` and `limit` WARN
  /// Distance of the value from the ideal, divided by the distance of the limit from the ideal.
  /// Absent if there is no value.
  std::optional<double> tolerance_used;
  Omittable<double> expanded_uncertainty;  ///< uncertainty of the value; absent if unknown
  Verdict verdict = Verdict::pass;         ///< "PASS", "WARN" or "FAIL"
  /// True if WARN was given because the margin to the limit is below the uncertainty.
  bool in_guard_band = false;
  std::string words;  ///< reason for WARN or FAIL; empty for PASS
  RIGCAL_DESCRIBE(channel, metric, value, limit, warn, tolerance_used, expanded_uncertainty,
                  verdict)
};

/// Curves behind the residual tests of each channel; absent if the residual was not tested.
using ChannelCurves = Keyed<std::optional<metrics::ResidualCurves>, datasets::Channel>;

/// Score of one condition, and the series it was computed from.
struct ConditionScore {
  std::string id;
  datasets::Use use = datasets::Use::fit;
  std::vector<ChannelScore> channels;
  std::vector<LimitCheck> checks;          ///< one for each limit on its channels
  std::optional<Verdict> verdict;          ///< worst of the checks; absent without limits
  std::vector<std::string> reasons;        ///< reasons for WARN and FAIL, in words
  std::vector<std::string> data_warnings;  ///< doubts about the recording, in words
  std::string failure;                     ///< why the simulation failed; empty if it did not
  std::string not_scored;  ///< why there is no score although the simulation succeeded; else empty
  long samples = 0;        ///< number of samples inside the windows
  std::vector<double> time_s;
  /// Measured mean and simulated value for each output channel, over the whole record.
  std::map<datasets::Channel, std::pair<std::vector<double>, std::vector<double>>> series;
  /// Standard deviation of a measurement about the simulated value, over the whole record, SI. It
  /// combines the uncertainty of the estimates with the noise of the record. Absent if the former
  /// is unknown.
  std::map<datasets::Channel, std::vector<double>> prediction_sd;
  /// The component of a prediction's residual that the uncertainty of the estimates explains, at
  /// the samples that count. The tests exclude it. Absent if that uncertainty is unknown.
  std::map<datasets::Channel, std::vector<double>> explained;
  ChannelCurves residual_curves;
  std::vector<double> drive;  ///< reference [m] or command [V] at time_s
  /// Simulated flows at time_s [m3/s]; empty if the simulation failed.
  std::vector<double> servo_flow_m3_per_s, leakage_flow_m3_per_s;
  std::vector<bool> in_window;  ///< empty if all samples count

  /// Verdict on a channel: its worst check, or the condition's verdict if the simulation failed.
  /// Absent if no limit applies to the channel.
  std::optional<Verdict> verdict_of(datasets::Channel of) const;
};

}  // namespace rigcal::calib
