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
#include "common/range.hpp"
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
  /// Simulated over measured amplitude of the fundamental; absent without a fundamental.
  std::optional<double> gain_ratio;
  /// Phase of the simulated fundamental minus that of the measured one [degrees]; absent likewise.
  std::optional<double> phase_deg;
  std::optional<double> delay_s;       ///< delay of the simulated fundamental [s]; absent likewise
  std::optional<std::string> problem;  ///< why a value is missing, in words

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
  /// Metrics that a perfect model would reach, by name; absent if the noise is unknown.
  std::optional<metrics::NoiseFloor> noise_floor;
  /// One-sided expanded uncertainty (95 %) of each metric, due to repeats and sensor, used as the
  /// guard band of a limit; absent with fewer than two repeats.
  Later<std::optional<metrics::Agreement>> expanded_uncertainty;
  /// Two-sided expanded uncertainty of each metric, as printed after +-.
  Later<std::optional<metrics::Agreement>> two_sided_uncertainty;
  /// Contributions to the two-sided uncertainty of each metric, in the order of the metrics; absent
  /// if the uncertainty is unknown.
  Omittable<Keyed<Budget95>> score_budgets;
  /// Tests of the residual (measured minus simulated) over the longest window; absent if the window
  /// is too short or the residual is constant.
  std::optional<metrics::ResidualTests> residual_tests;
  std::optional<LackOfFit> lack_of_fit;  ///< test of a prediction; absent if the noise is unknown
  RIGCAL_DESCRIBE(metrics, noise_floor, expanded_uncertainty, two_sided_uncertainty, score_budgets,
                  residual_tests)

  std::string_view key() const { return datasets::info(channel).key; }
  /// Returns the uncertainty that a page prints after "±" and "U"; null if unknown. Files from
  /// earlier versions only have the one-sided uncertainty, which is returned instead.
  const metrics::Agreement* printed_uncertainty() const;
};

enum class Verdict { pass, warn, fail };
RIGCAL_WORDS(Verdict, pass, "PASS", warn, "WARN", fail, "FAIL")

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

/// Score of one condition, with what campaign and record state about it.
struct ConditionResult {
  std::string id;                                                   ///< id of the condition
  Later<std::optional<datasets::Waveform>> waveform;                ///< signal of the drive
  Later<std::optional<double>> frequency_hz, amplitude_m;           ///< frequency and amplitude
  Omittable<std::optional<double>> amplitude_v;                     ///< amplitude of a command
  Omittable<double> amplitude_n, amplitude_pa, amplitude_m_per_s2;  ///< amplitude in other loops
  Omittable<double> amplitude_rad, amplitude_n_m;                   ///< amplitude in other loops
  Later<std::optional<std::string>> leak_level;                     ///< name of the leak level
  datasets::Use use = datasets::Use::fit;                           ///< "fit" or "validate"
  Omittable<double> temperature_k;                ///< stated temperature of the oil
  Omittable<std::string> date;                    ///< stated date of the record
  long samples = 0;                               ///< number of samples inside the windows
  Later<std::vector<std::string>> record_sha256;  ///< files that the record is made from
  Omittable<std::vector<Range>> windows_s;        ///< empty: the whole record
  Omittable<std::vector<std::string>> notes;      ///< changes to the record, in words
  Omittable<std::vector<datasets::AcceptanceLimit>>
      acceptance;                                        ///< limits that replace the campaign's
  Omittable<std::vector<datasets::Channel>> not_judged;  ///< in addition to those of the campaign
  Later<std::vector<std::string>> warnings;              ///< doubts about the recording, in words
  /// Why there is no score although the simulation did not fail.
  Later<std::optional<std::string>> not_scored;
  std::optional<std::string> failure;  ///< why the simulation failed; absent if it did not
  Columns<ChannelScore> channels;
  Later<std::vector<LimitCheck>> limit_checks;  ///< one check per limit
  /// Worst of the checks of each channel that has a limit, in the order of the channels.
  Later<Keyed<Verdict, datasets::Channel>> channel_verdicts;
  std::optional<Verdict> verdict;    ///< worst of the checks; absent without limits
  std::vector<std::string> reasons;  ///< reasons for WARN and FAIL, in words
  RIGCAL_DESCRIBE(id, waveform, frequency_hz, amplitude_m, amplitude_v, amplitude_n, amplitude_pa,
                  amplitude_m_per_s2, amplitude_rad, amplitude_n_m, leak_level, use, temperature_k,
                  date, samples, record_sha256, windows_s, notes, acceptance, not_judged, warnings,
                  not_scored, failure, channels, limit_checks, channel_verdicts, verdict, reasons)

  /// Returns the verdict on a channel: its worst check, or the condition's verdict if the
  /// simulation failed; std::nullopt if no limit applies to the channel.
  std::optional<Verdict> verdict_of(datasets::Channel channel) const;
  std::optional<Verdict> verdict_of(std::string_view key) const;

  /// Returns the score of the channel with this key; null if there is none.
  const ChannelScore* find(std::string_view key) const;
};

/// How far the uncertainty of the estimates alone leaves a prediction open.
struct OpenPrediction {
  /// Expected variance of its error, without that of a constant, divided by the measured variance.
  double variance_fraction = 0.0;
  /// Keys of the parameters that move it most in the direction that is least determined.
  std::vector<std::string> through;
};

/// Score of one condition, and the series it was computed from, which no file of scores has.
struct ConditionScore : ConditionResult {
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
  /// Absent under the same condition, and for signals that are constant.
  std::map<datasets::Channel, OpenPrediction> open;
  ChannelCurves residual_curves;
  std::vector<double> drive;  ///< reference [m] or command [V] at time_s
  /// Simulated flows at time_s [m3/s]; empty if the simulation failed.
  std::vector<double> servo_flow_m3_per_s, leakage_flow_m3_per_s;
  std::vector<bool> in_window;  ///< empty if all samples count
};

}  // namespace rigcal::calib
