#include "report/store/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>

#include "metrics/metric_table.hpp"
#include "report/store/csv_columns.hpp"

namespace rigcal::report {
namespace {

std::string status_line(const calib::Fit& fit) {
  const calib::FitStatus status = status_of(fit);
  if (status == calib::FitStatus::converged) return {};
  return csv_status(to_string(status), {fit.message});
}

struct ScoreRow {
  const calib::ConditionScore* score;
  const datasets::Condition* condition;
  const calib::ChannelScore* channel;  ///< null for a condition without scores
  const datasets::ChannelInfo* about;  ///< null as well
  std::string verdict;
  std::string problem;
};

std::vector<ScoreRow> score_rows(const Result& result) {
  std::vector<ScoreRow> rows;
  for (const calib::ConditionScore& score : result.fit.conditions) {
    const datasets::Condition* condition = result.campaign.find(score.id);
    if (condition == nullptr) continue;
    if (score.channels.empty())
      rows.push_back({&score, condition, nullptr, nullptr, csv_field(score.verdict),
                      score.failure.value_or("")});
    for (const calib::ChannelScore& channel : score.channels) {
      const auto verdict = score.verdict_of(channel.channel);
      rows.push_back({&score, condition, &channel, &info(channel.channel),
                      verdict ? csv_field(verdict) : "not judged",
                      channel.metrics.problem.value_or(score.failure.value_or(""))});
    }
  }
  return rows;
}

struct RepeatabilityRow {
  const datasets::Record* record;
  datasets::Repeatability of_channel;
};

double at(std::span<const double> values, std::size_t i) {
  return i < values.size() ? values[i] : std::nan("");
}

/// Returns the standard deviation of the repeats, shape (samples); empty for a single repeat.
std::span<const double> sd_of(const Result& result, const std::string& condition,
                              datasets::Channel channel) {
  for (const datasets::Record& record : result.records) {
    if (record.condition != condition) continue;
    const auto series = record.channels.find(channel);
    if (series != record.channels.end() && series->second.repeats > 1) return series->second.sd;
  }
  return {};
}

}  // namespace

std::string scorecard_csv(const Result& result) {
  using calib::ChannelMetrics;
  using calib::ChannelScore;
  using calib::ConditionScore;
  using datasets::ChannelInfo;
  using datasets::Condition;
  using metrics::NoiseFloor;
  using R = ScoreRow;
  const ChannelInfo& drive = info(drive_channel(result.campaign));
  const std::string_view suffix = drive.name.substr(drive.key.size());  // "reference_m" gives "_m"
  CsvColumns<R> columns;
  columns.add("condition", &R::score, &ConditionScore::id)
      .add("use", &R::score, &ConditionScore::use)
      .add("waveform", &R::condition, &Condition::waveform)
      .add("frequency_hz", &R::condition, &Condition::frequency_hz)
      .add(fmt::format("amplitude{}", suffix), &R::condition, &Condition::amplitude)
      .add("leak_level", &R::condition, &Condition::leak_level)
      .add("samples", &R::score, &ConditionScore::samples)
      .add("verdict", &R::verdict)
      .add("channel", &R::about, &ChannelInfo::key)
      .add("unit", &R::about, &ChannelInfo::unit);
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    columns.add(std::string(metric.name), &R::channel, &ChannelScore::metrics, metric.value);
  columns.add("noise_floor_rho2", &R::channel, &ChannelScore::noise_floor, &NoiseFloor::rho2)
      .add("noise_floor_ccc", &R::channel, &ChannelScore::noise_floor, &NoiseFloor::ccc)
      .add("noise_floor_absolute_error_percent", &R::channel, &ChannelScore::noise_floor,
           &NoiseFloor::absolute_error_percent)
      .add("gain_ratio", &R::channel, &ChannelScore::metrics, &ChannelMetrics::gain_ratio)
      .add("phase_deg", &R::channel, &ChannelScore::metrics, &ChannelMetrics::phase_deg)
      .add("delay_s", &R::channel, &ChannelScore::metrics, &ChannelMetrics::delay_s)
      .add("problem", &R::problem);
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    columns.add(fmt::format("{}_expanded_uncertainty", metric.name), &R::channel,
                &ChannelScore::expanded_uncertainty, metric.value);
  return status_line(result.fit) + columns.table(score_rows(result));
}

Table residual_table(const Result& result, const calib::ConditionScore& score) {
  Table table;
  const auto add = [&](std::string name, const auto& value) {
    table.add(std::move(name), score.time_s.size(), value);
  };
  const auto add_values = [&](std::string name, std::span<const double> values) {
    add(std::move(name), [&](std::size_t i) { return at(values, i); });
  };
  add_values("time_s", score.time_s);
  for (const auto& [channel, series] : score.series) {
    // Without a simulation there are only measured values.
    const std::vector<double>& measured = series.first;
    const std::vector<double>& simulated = series.second;
    const auto name = [of = info(channel).name](const char* what) {
      return fmt::format("{}_{}", what, of);
    };
    add_values(name("measured"), measured);
    add_values(name("simulated"), simulated);
    add(name("residual"), [&](std::size_t i) { return at(measured, i) - at(simulated, i); });
    add_values(name("sd"), sd_of(result, score.id, channel));
    const auto band = score.prediction_sd.find(channel);
    if (band != score.prediction_sd.end()) add_values(name("prediction_sd"), band->second);
  }
  add("in_window",
      [&](std::size_t i) { return score.in_window.empty() || score.in_window[i] ? 1.0 : 0.0; });
  add_values(std::string(info(drive_channel(result.campaign)).name), score.drive);
  add_values("servo_flow_m3_per_s", score.servo_flow_m3_per_s);
  add_values("leakage_flow_m3_per_s", score.leakage_flow_m3_per_s);
  return table;
}

std::string residuals_csv(const Result& result, const calib::ConditionScore& score) {
  std::string text = status_line(result.fit);
  if (score.failure) text += csv_comment("not simulated: " + *score.failure);
  return text + csv_of(residual_table(result, score));
}

Table averaged_table(const datasets::Record& record) {
  Table table;
  const std::size_t rows = record.time_s.size();
  table.add("time_s", record.time_s);
  for (const auto& [channel, series] : record.channels) {
    const auto add = [&, name = info(channel).name, rows](const char* what, const auto& values) {
      table.add(fmt::format("{}_{}", name, what), rows, [&](std::size_t i) {
        return values.empty() ? std::nan("") : static_cast<double>(values[i]);
      });
    };
    add("mean", series.mean);
    add("sd", series.sd);
    add("count", series.count);
  }
  return table;
}

std::string repeatability_csv(const std::vector<datasets::Record>& records) {
  using datasets::Record;
  using datasets::Repeatability;
  using datasets::RepeatReport;
  using metrics::NoiseFloor;
  using R = RepeatabilityRow;
  std::vector<R> rows;
  for (const Record& record : records)
    for (const Repeatability& each : datasets::repeatability(record))
      rows.push_back({&record, each});
  const auto about = [](auto member) {
    return [member](const Repeatability& each) { return info(each.channel).*member; };
  };
  const auto of_repeats = [](auto member) {
    return [member](const Record& record) {
      std::vector<double> values;
      for (const RepeatReport& each : record.repeat_reports) values.push_back(each.*member);
      return values;
    };
  };
  return CsvColumns<R>()
      .add("condition", &R::record, &Record::condition)
      .add("channel", &R::of_channel, about(&datasets::ChannelInfo::key))
      .add("unit", &R::of_channel, about(&datasets::ChannelInfo::unit))
      .add("repeats", &R::of_channel, &Repeatability::repeats)
      .add("pooled_sd", &R::of_channel, &Repeatability::pooled_sd)
      .add("sd_of_mean", &R::of_channel, &Repeatability::sd_of_mean)
      .add("noise_floor_rho2", &R::of_channel, &Repeatability::noise_floor, &NoiseFloor::rho2)
      .add("noise_floor_ccc", &R::of_channel, &Repeatability::noise_floor, &NoiseFloor::ccc)
      .add("noise_floor_absolute_error_percent", &R::of_channel, &Repeatability::noise_floor,
           &NoiseFloor::absolute_error_percent)
      .add("offset_range_s", &R::record, datasets::offset_range_s)
      .add("repeat_offsets_s", &R::record, of_repeats(&RepeatReport::offset_s))
      .add("repeat_deviations", &R::record, of_repeats(&RepeatReport::deviation))
      .add("outliers", &R::record, datasets::outliers)
      .table(rows);
}

std::string simulation_csv(const calib::SimulationTask& task, const model::Simulation& simulation) {
  std::string text;
  if (!simulation.ok()) {
    const char* status =
        simulation.status == model::SimulationStatus::cancelled ? "stopped" : "failed";
    text += csv_status(status, {fmt::format("{} at {:.6g} s: {}", to_string(simulation.status),
                                            simulation.failed_at_s, simulation.reason)});
  }
  const std::vector<double> reference = calib::reference_of(task);
  const std::size_t rows = simulation.ok() ? task.time_s.size() : 0;
  Table table;
  table.add("time_s", rows, [&](std::size_t i) { return task.time_s[i]; });
  if (!reference.empty())
    table.add(std::string(info(datasets::drive_channel(task.rig)).name), rows,
              [&](std::size_t i) { return reference[i]; });
  for (const model::Output output : model::kAllOutputs) {
    if (!has_output(task.values, output)) continue;
    table.add(std::string(output_name(output)), rows, [&](std::size_t i) {
      return simulation.outputs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(output));
    });
  }
  return text + csv_of(table);
}

}  // namespace rigcal::report
