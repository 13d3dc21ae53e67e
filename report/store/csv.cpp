#include "report/store/csv.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "metrics/metric_table.hpp"
#include "report/store/csv_fields.hpp"

namespace rigcal::report {
namespace {

std::string status_line(const calib::Fit& fit) {
  const calib::FitStatus status = status_of(fit);
  if (status == calib::FitStatus::converged) return {};
  return csv_comment(fmt::format("status: {}: {}", to_string(status), fit.message));
}

void add_agreement(const std::optional<metrics::Agreement>& agreement,
                   std::vector<std::string>& fields) {
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    fields.push_back(agreement ? csv_number((*agreement).*metric.value) : std::string());
}

std::vector<std::string> score_fields(const calib::ChannelScore& score) {
  std::vector<std::string> fields;
  add_agreement(score.agreement, fields);
  const auto& floor = score.noise_floor;
  fields.push_back(floor ? csv_number(floor->rho2) : std::string());
  fields.push_back(floor ? csv_number(floor->ccc) : std::string());
  fields.push_back(floor ? csv_number(floor->absolute_error_percent) : std::string());
  fields.push_back(csv_number(score.gain_ratio));
  fields.push_back(csv_number(score.phase_deg));
  fields.push_back(csv_number(score.delay_s));
  return fields;
}

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
  const datasets::ChannelInfo& drive = info(drive_channel(result.campaign));
  const std::string_view suffix = drive.name.substr(drive.key.size());  // "reference_m" gives "_m"
  std::vector<std::string> titles{
      "condition",  "use",     "waveform", "frequency_hz", fmt::format("amplitude{}", suffix),
      "leak_level", "samples", "verdict",  "channel",      "unit"};
  for (const metrics::MetricSpec& metric : metrics::kMetrics) titles.emplace_back(metric.name);
  for (const char* title :
       {"noise_floor_rho2", "noise_floor_ccc", "noise_floor_absolute_error_percent", "gain_ratio",
        "phase_deg", "delay_s", "problem"}) {
    titles.emplace_back(title);
  }
  for (const metrics::MetricSpec& metric : metrics::kMetrics)
    titles.push_back(fmt::format("{}_expanded_uncertainty", metric.name));
  std::string text = status_line(result.fit) + csv_row(titles);
  for (const calib::ConditionScore& score : result.fit.conditions) {
    const datasets::Condition* condition = result.campaign.find(score.id);
    if (condition == nullptr) continue;
    const std::vector<std::string> of_condition{score.id,
                                                std::string(to_string(score.use)),
                                                std::string(to_string(condition->waveform)),
                                                csv_number(condition->frequency_hz),
                                                csv_number(condition->amplitude),
                                                csv_text(condition->leak_level.value_or("")),
                                                fmt::format("{}", score.samples)};
    const auto add = [&](const std::string& verdict, const std::string& channel,
                         const std::string& unit, const calib::ChannelScore& values,
                         const std::string& problem) {
      std::vector<std::string> fields = of_condition;
      fields.push_back(verdict);
      fields.push_back(channel);
      fields.push_back(unit);
      for (std::string& field : score_fields(values)) fields.push_back(std::move(field));
      fields.push_back(csv_text(problem));
      add_agreement(values.expanded_uncertainty, fields);
      text += csv_row(fields);
    };
    if (score.channels.empty())
      add(score.verdict ? std::string(to_string(*score.verdict)) : "", "", "", {}, score.failure);
    for (const calib::ChannelScore& channel : score.channels) {
      const datasets::ChannelInfo& about = info(channel.channel);
      const auto verdict = score.verdict_of(channel.channel);
      add(verdict ? std::string(to_string(*verdict)) : "not judged", std::string(about.key),
          std::string(about.unit), channel,
          channel.problem.empty() ? score.failure : channel.problem);
    }
  }
  return text;
}

Table residual_table(const Result& result, const calib::ConditionScore& score) {
  Table table;
  const auto add = [&](std::string name, const auto& value) {
    table.add(std::move(name), score.time_s.size(), [&](std::size_t i) {
      const double x = value(i);
      return std::isfinite(x) ? x : std::nan("");
    });
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
  if (!score.failure.empty()) text += csv_comment("not simulated: " + score.failure);
  return text + csv_of(residual_table(result, score));
}

std::string averaged_csv(const datasets::Record& record) {
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
  return csv_of(table);
}

std::string repeatability_csv(const std::vector<datasets::Record>& records) {
  std::string text =
      csv_row({"condition", "channel", "unit", "repeats", "pooled_sd", "sd_of_mean",
               "noise_floor_rho2", "noise_floor_ccc", "noise_floor_absolute_error_percent",
               "offset_range_s", "repeat_offsets_s", "repeat_deviations", "outliers"});
  for (const datasets::Record& record : records) {
    std::vector<std::string> offsets;
    std::vector<std::string> deviations;
    for (const datasets::RepeatReport& report : record.repeat_reports) {
      offsets.push_back(csv_number(report.offset_s));
      deviations.push_back(csv_number(report.deviation));
    }
    for (const datasets::Repeatability& r : datasets::repeatability(record)) {
      const datasets::ChannelInfo& about = info(r.channel);
      const auto& floor = r.noise_floor;
      text += csv_row(
          {record.condition, std::string(about.key), std::string(about.unit),
           fmt::format("{}", r.repeats), csv_number(r.pooled_sd), csv_number(r.sd_of_mean),
           floor ? csv_number(floor->rho2) : "", floor ? csv_number(floor->ccc) : "",
           floor ? csv_number(floor->absolute_error_percent) : "",
           csv_number(datasets::offset_range_s(record)), fmt::format("{}", fmt::join(offsets, " ")),
           fmt::format("{}", fmt::join(deviations, " ")),
           csv_text(fmt::format("{}", fmt::join(datasets::outliers(record), "; ")))});
    }
  }
  return text;
}

std::string simulation_csv(std::span<const double> time_s, std::string_view reference_name,
                           std::span<const double> reference,
                           std::span<const model::Output> outputs,
                           const model::Simulation& simulation) {
  std::string text;
  if (!simulation.ok()) {
    const char* status =
        simulation.status == model::SimulationStatus::cancelled ? "stopped" : "failed";
    text += csv_comment(fmt::format("status: {}: {} at {:.6g} s: {}", status,
                                    to_string(simulation.status), simulation.failed_at_s,
                                    simulation.reason));
  }
  const std::size_t rows = simulation.ok() ? time_s.size() : 0;
  Table table;
  table.add("time_s", rows, [&](std::size_t i) { return time_s[i]; });
  if (!reference.empty())
    table.add(std::string(reference_name), rows, [&](std::size_t i) { return reference[i]; });
  for (const model::Output output : outputs)
    table.add(std::string(output_name(output)), rows, [&](std::size_t i) {
      return simulation.outputs(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(output));
    });
  return text + csv_of(table);
}

}  // namespace rigcal::report
